// SPDX-License-Identifier: Apache-2.0
#pragma once

// How settings are listed. Each settings struct comes with the list of its fields, each with name,
// range and meaning: `fields(config, visit)` calls visit(name, value, range, note) for each. Its
// structured binding names every field of the struct, so a field missing from the list does not
// compile. Everything that checks, reads, writes and documents settings uses these lists
// (settings_io.hpp).

#include "slam/io/fields.hpp"

namespace mh {

/// The values that a setting may take: [min, max], excluding max if open, excluding min if above.
/// Ignored for words and switches.
struct SettingRange {
  double min = 0, max = 1;
  bool open = false, above = false;
  bool required = false;  ///< an error if its section lacks it
};

namespace setting {
inline constexpr double kMany = 1e6;
inline constexpr SettingRange kShare{0, 1}, kOpenShare{0, 1, true}, kCount{1, kMany},
    kLength_m{0, 1000}, kSwitch{0, 1}, kSeed{0, 9e18};

constexpr SettingRange above(double bound, double max) {
  return {.min = bound, .max = max, .above = true};
}
constexpr SettingRange required(SettingRange range) {
  range.required = true;
  return range;
}
}  // namespace setting

/// Adapts a visitor of (name, value) to field lists that also give ranges and meanings.
template <class Visit>
class EachField {
 public:
  explicit EachField(Visit& visit) : visit_(visit) {}
  template <class Name, class T>
  void operator()(const Name& name, T&& value) const {
    visit_(name, value);
  }
  template <class T>
  void operator()(const char* name, T& value, const SettingRange&, const char*) const {
    visit_(name, value);
  }

 private:
  Visit& visit_;
};

/// Calls visit(name, value) for each field of a record or of settings.
template <class Record, class Visit>
void for_each_field(Record& record, Visit&& visit) {
  const EachField each(visit);
  fields(record, each);
}

}  // namespace mh
