// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/dose.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/setting_by_name.hpp"
#include "slam/io/settings_io.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

/// The section of a full name: "motion_blur" of "motion_blur.exposure_ms".
std::string_view section_of(std::string_view name) {
  return name.substr(0, name.find('.'));
}

void set(SensorConfig& level, const Dose& dose) {
  if (!is_dial(dose.dial))
    throw InputError(fmt::format("'{}' is no dial of a level{}", dose.dial,
                                 did_you_mean(dose.dial, dial_names())));
  at_setting(level, dose.dial, [&]<class T>(T& value, const SettingRange& range, const char*) {
    if constexpr (std::is_same_v<T, bool>) {
      value = dose.value != 0;
    } else if constexpr (kIsNumber<T>) {
      if (!allows(range, dose.value))
        throw InputError(
            fmt::format("{} = {} is outside {}", dose.dial, dose.value, interval(range)));
      value = static_cast<T>(dose.value);
    }
  });
  const std::string enabled = fmt::format("{}.enabled", section_of(dose.dial));
  if (enabled != dose.dial && is_dial(enabled))
    at_setting(level, enabled, []<class T>(T& value, const SettingRange&, const char*) {
      if constexpr (std::is_same_v<T, bool>) value = true;
    });
}

}  // namespace

std::vector<std::string> dial_names() {
  std::vector<std::string> names;
  const SensorConfig level;
  for_each_setting(level, EachByName([&]<class T>(const std::string& name, const T&,
                                                  const SettingRange&, const char*) {
                     if constexpr (std::is_arithmetic_v<T>) names.push_back(name);
                   }));
  return names;
}

bool is_dial(std::string_view name) {
  static const std::vector<std::string> kNames = dial_names();
  return std::ranges::find(kNames, name) != kNames.end();
}

DialFacts facts_of_dial(std::string_view name) {
  DialFacts facts;
  at_setting(SensorConfig(), name,
             [&]<class T>(const T&, const SettingRange& range, const char* note) {
               facts = {note, range, std::is_integral_v<T>};
             });
  return facts;
}

double read_dose(std::string_view dial, const YamlReader& value) {
  double dose = 0;
  at_setting(SensorConfig(), dial, [&]<class T>(const T&, const SettingRange& range, const char*) {
    if constexpr (std::is_arithmetic_v<T>) {
      T read{};
      MappingReader::read(value, read, range);
      dose = static_cast<double>(read);
    }
  });
  return dose;
}

SensorConfig with_doses(SensorConfig level, std::span<const Dose> doses) {
  for (const Dose& dose : doses) set(level, dose);
  if (const auto wrong = contradiction_in(level))
    throw InputError(fmt::format("{}: {}", wrong->section, wrong->why));
  return level;
}

}  // namespace mh
