// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "slam/config/slam.hpp"
#include "slam/core/yaml.hpp"

namespace mh {

// Settings of SLAM by their full names: "features.count". Where a function takes a name, it is one
// of setting_names(); std::logic_error otherwise.

/// In the order of the settings file.
std::vector<std::string> setting_names();
bool is_setting(std::string_view name);

/// As a settings file writes it.
std::string setting_text(const SlamConfig& config, std::string_view name);
/// As a number: a switch is 0 or 1, a word its place among those that are possible.
double setting_value(const SlamConfig& config, std::string_view name);

/// Whether its value is a number: neither a switch nor a word.
bool is_number(std::string_view name);

/// Reads the value of a setting. @throws InputError at its place if it is out of range.
void read_setting(SlamConfig& config, std::string_view name, const YamlReader& value);
/// Puts a setting between two values: low at share 0, high at share 1; a whole number is the
/// nearest. No effect on what is no number.
void set_between(SlamConfig& config, std::string_view name, double low, double high, double share);

}  // namespace mh
