// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/sensors/dose.hpp"
#include "slam/io/fields.hpp"

namespace mh {

/// The level name of recordings, whose noise is already in the data; no level file has this name.
inline constexpr const char* kRecordedLevel = "recorded";

/// A sensor level with what a suite changes in it.
struct Level {
  std::filesystem::path file;  ///< or kRecordedLevel
  bool of_recordings = false;  ///< its faults are added to finished images
  std::vector<Dose> doses = {};
  bool is_file() const { return file != kRecordedLevel; }
  friend bool operator==(const Level&, const Level&) = default;
};

template <MaybeConst<Level> L, class Visit>
void fields(L& level, Visit& v) {
  auto& [file, of_recordings, doses] = level;
  v("file", file);
  v("of_recordings", of_recordings);
  v("doses", doses);
}

/// "pepper", "pepper+motion_blur.exposure_ms=40": unique in a suite, valid as a file name
std::string level_name(const Level& level);

/// The sensors at this level: those of its file, or without faults for a recording, with the doses.
/// @throws InputError if the file or a dose is bad
SensorConfig sensors_at(const Level& level);

}  // namespace mh
