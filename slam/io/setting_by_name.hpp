// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "slam/io/setting.hpp"

namespace mh {

/// Whether a setting is numeric, that is, neither a switch nor a word.
template <class T>
inline constexpr bool kIsNumber = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

/// Calls visit(name, value, range, note) for every setting of a list, with its full name:
/// "features.count".
template <class Visit>
class EachByName {
 public:
  explicit EachByName(Visit visit) : visit_(std::move(visit)) {}
  void section(const char* name) { section_ = std::string(name) + "."; }
  template <class T>
  void operator()(const char* key, T& value, const SettingRange& range, const char* note) {
    visit_(section_ + key, value, range, note);
  }

 private:
  Visit visit_;
  std::string section_;
};

/// Calls use(value, range, note) for the setting with that name.
/// @throws std::logic_error if there is none
template <class Config, class Use>
void at_setting(Config&& config, std::string_view name, Use use) {
  bool found = false;
  for_each_setting(config, EachByName([&](const std::string& its, auto& value,
                                          const SettingRange& range, const char* note) {
                     if (its != name) return;
                     found = true;
                     use(value, range, note);
                   }));
  if (!found) throw std::logic_error("no setting is called " + std::string(name));
}

}  // namespace mh
