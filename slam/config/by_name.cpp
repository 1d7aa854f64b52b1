// SPDX-License-Identifier: Apache-2.0
#include "slam/config/by_name.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "slam/io/settings_io.hpp"

namespace mh {
namespace {

template <class T>
inline constexpr bool kIsNumber = !std::is_enum_v<T> && !std::is_same_v<T, bool>;

/// Calls visit(name, value, range) for every setting.
template <class Visit>
class EachByName {
 public:
  explicit EachByName(Visit visit) : visit_(visit) {}
  void section(const char* name) { section_ = std::string(name) + "."; }
  template <class T>
  void operator()(const char* key, T& value, const SettingRange& range, const char*) {
    visit_(section_ + key, value, range);
  }

 private:
  Visit visit_;
  std::string section_;
};

/// Calls use(value, range) for the setting with that name.
template <class Config, class Use>
void at_setting(Config&& config, std::string_view name, Use use) {
  bool found = false;
  for_each_setting(config,
                   EachByName([&](const std::string& its, auto& value, const SettingRange& range) {
                     if (its != name) return;
                     found = true;
                     use(value, range);
                   }));
  if (!found) throw std::logic_error("no setting is called " + std::string(name));
}

}  // namespace

std::vector<std::string> setting_names() {
  std::vector<std::string> names;
  const SlamConfig config;
  for_each_setting(config, EachByName([&](const std::string& name, const auto&,
                                          const SettingRange&) { names.push_back(name); }));
  return names;
}

bool is_setting(std::string_view name) {
  static const std::vector<std::string> kNames = setting_names();
  return std::ranges::find(kNames, name) != kNames.end();
}

std::string setting_text(const SlamConfig& config, std::string_view name) {
  std::string text;
  at_setting(config, name, [&](const auto& value, const SettingRange&) {
    text = SettingsWriter::word_of(value);
  });
  return text;
}

double setting_value(const SlamConfig& config, std::string_view name) {
  double number = 0;
  at_setting(config, name,
             [&](const auto& value, const SettingRange&) { number = static_cast<double>(value); });
  return number;
}

void read_setting(SlamConfig& config, std::string_view name, const YamlReader& value) {
  at_setting(config, name, [&](auto& setting, const SettingRange& range) {
    MappingReader::read(value, setting, range);
  });
}

bool is_number(std::string_view name) {
  bool number = false;
  at_setting(SlamConfig(), name,
             [&]<class T>(const T&, const SettingRange&) { number = kIsNumber<T>; });
  return number;
}

void set_between(SlamConfig& config, std::string_view name, double low, double high, double share) {
  at_setting(config, name, [&]<class T>(T& setting, const SettingRange&) {
    if constexpr (kIsNumber<T>) {
      const double value = low + share * (high - low);
      setting = std::is_integral_v<T> ? static_cast<T>(std::lround(value)) : static_cast<T>(value);
    }
  });
}

}  // namespace mh
