// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/sensors/config.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// One setting of a level that a suite changes, by its full name: "motion_blur.exposure_ms".
struct Dose {
  std::string dial;
  double value = 0;  ///< a switch is 0 or 1
  friend bool operator==(const Dose&, const Dose&) = default;
};

template <MaybeConst<Dose> D, class Visit>
void fields(D& dose, Visit& v) {
  auto& [dial, value] = dose;
  v("dial", dial);
  v("value", value);
}

/// The full names of all settings of a level that are numbers or switches.
std::vector<std::string> dial_names();
bool is_dial(std::string_view name);
/// Why a name is refused: "is no dial of a level; did you mean ...".
std::string no_dial(std::string_view name);
/// What the dial means, and the values that it may have. @pre is_dial()
struct DialFacts {
  std::string meaning;
  SettingRange range;
  bool whole = false;  ///< takes whole numbers only
};
DialFacts facts_of_dial(std::string_view name);

/// Reads a value of a dial. @pre is_dial() @throws InputError at its place if it is out of range.
double read_dose(std::string_view dial, const YamlReader& value);

/// Returns the level with the doses set. A section of which a field is set is on.
/// @throws InputError if a dose is unknown, out of range, or a fraction where whole numbers are
///                    needed, or if two settings contradict each other
SensorConfig with_doses(SensorConfig level, std::span<const Dose> doses);

/// The level with every section off that has no effect: two levels with equal results for any frame
/// are equal in this form, if they differ only in settings that do nothing.
SensorConfig effective(SensorConfig level);

}  // namespace mh
