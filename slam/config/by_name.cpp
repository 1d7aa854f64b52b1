// SPDX-License-Identifier: Apache-2.0
#include "slam/config/by_name.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "slam/io/setting_by_name.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {

std::vector<std::string> setting_names() {
  std::vector<std::string> names;
  const SlamConfig config;
  for_each_setting(config, EachByName([&](const std::string& name, const auto&, const SettingRange&,
                                          const char*) { names.push_back(name); }));
  return names;
}

bool is_setting(std::string_view name) {
  static const std::vector<std::string> kNames = setting_names();
  return std::ranges::find(kNames, name) != kNames.end();
}

std::string setting_text(const SlamConfig& config, std::string_view name) {
  std::string text;
  at_setting(config, name, [&](const auto& value, const SettingRange&, const char*) {
    text = SettingsWriter::word_of(value);
  });
  return text;
}

double setting_value(const SlamConfig& config, std::string_view name) {
  double number = 0;
  at_setting(config, name, [&](const auto& value, const SettingRange&, const char*) {
    number = static_cast<double>(value);
  });
  return number;
}

void read_setting(SlamConfig& config, std::string_view name, const YamlReader& value) {
  at_setting(config, name, [&](auto& setting, const SettingRange& range, const char*) {
    MappingReader::read(value, setting, range);
  });
}

bool is_number(std::string_view name) {
  bool number = false;
  at_setting(SlamConfig(), name,
             [&]<class T>(const T&, const SettingRange&, const char*) { number = kIsNumber<T>; });
  return number;
}

void set_between(SlamConfig& config, std::string_view name, double low, double high, double share) {
  at_setting(config, name, [&]<class T>(T& setting, const SettingRange&, const char*) {
    if constexpr (kIsNumber<T>) {
      const double value = low + share * (high - low);
      setting = std::is_integral_v<T> ? static_cast<T>(std::lround(value)) : static_cast<T>(value);
    }
  });
}

}  // namespace mh
