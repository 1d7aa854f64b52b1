// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "slam/config/slam.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

// Access to SLAM settings by full name, such as "features.count". @pre Every name passed in is one
// of setting_names(); otherwise, std::logic_error is thrown.

/// All full names, in the order of the settings file.
std::vector<std::string> setting_names();
bool is_setting(std::string_view name);

/// The value as written in a settings file.
std::string setting_text(const SlamConfig& config, std::string_view name);
/// The value as a number: a switch is 0 or 1, a word its index among the allowed words.
double setting_value(const SlamConfig& config, std::string_view name);

/// Whether the setting is numeric, that is, neither a switch nor a word.
bool is_number(std::string_view name);

/// Reads the value of a setting. @throws InputError with its place in the file if it is out of
/// range.
void read_setting(SlamConfig& config, std::string_view name, const YamlReader& value);
/// Interpolates a setting: low at share 0, high at share 1; integers are rounded to the nearest. No
/// effect on settings that are not numbers.
void set_between(SlamConfig& config, std::string_view name, double low, double high, double share);

}  // namespace mh
