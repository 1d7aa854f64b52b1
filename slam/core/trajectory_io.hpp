// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "slam/core/error.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// No camera is farther from its origin than this: a number beyond it is a slip.
inline constexpr double kFarthestPose_m = 1e6;

/// TUM RGB-D trajectory text: one pose per line, `stamp tx ty tz qx qy qz qw` (s, m, camera to
/// world), '#' starts a comment. Stamps are read exactly, digit by digit, to nanoseconds;
/// quaternions are normalized.
/// @throws InputError "file:line: place: value" on a wrong count of numbers, a malformed or
/// non-finite number, a position beyond kFarthestPose_m, a negative stamp, a quaternion whose norm
/// is more than 0.1 from 1, a stamp that does not increase, or a file without poses.
Trajectory read_tum(const std::filesystem::path& file);
/// Parses the same from text; `name` names the file in messages.
Trajectory parse_tum(const std::string& text, const std::string& name);
/// The same, but a line that holds no valid pose is told to `fault` and left out; maybe none is
/// left.
Trajectory parse_valid_tum(const std::string& text, const std::string& name,
                           const std::function<void(const InputError&)>& fault);
/// EuRoC's ground truth, CSV: `timestamp, p x y z, q w x y z` (ns, m) and columns that are ignored;
/// '#' starts a comment, a first line of words is skipped. The poses are those of the sensor or
/// body that the file is about.
/// @throws InputError as above; also if a stamp is not a whole number of nanoseconds.
Trajectory parse_euroc(const std::string& text, const std::string& name);
/// Reads true poses in either form: EuRoC's if the first line of data contains a comma.
Trajectory read_trajectory(const std::filesystem::path& file);
Trajectory parse_trajectory(const std::string& text, const std::string& name);
/// Writes doubles so that they read back to the same value. @pre stamps are not negative.
std::string format_tum(const Trajectory& trajectory);
void write_tum(const std::filesystem::path& file, const Trajectory& trajectory);

/// KITTI odometry text: one pose per line, the upper three rows of the camera-to-world matrix, 12
/// numbers. There are no stamps: pose i gets i * period. KITTI's cameras run at 10 Hz.
/// @throws InputError as above; also if a matrix is not a rotation to within 1e-3.
Trajectory read_kitti(const std::filesystem::path& file, Stamp period_ns = 100'000'000);
Trajectory parse_kitti(const std::string& text, const std::string& name,
                       Stamp period_ns = 100'000'000);
std::string format_kitti(const Trajectory& trajectory);
void write_kitti(const std::filesystem::path& file, const Trajectory& trajectory);

/// Converts decimal seconds to integer nanoseconds without going through floating point; digits
/// beyond the ninth decimal are rounded. Accepts both "1305031229.5287" and
/// "1.403636580013555527e+09". @throws InputError (the text alone, without a place) if it is not a
/// number from 0 to 9.2e9 s.
Stamp parse_stamp(const std::string& text);
/// "1305031229.528748000": nine decimals. @pre stamp_ns >= 0.
std::string format_stamp(Stamp stamp_ns);

}  // namespace mh
