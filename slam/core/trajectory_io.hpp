// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "slam/core/trajectory.hpp"

namespace mh {

/// TUM RGB-D trajectory text: one pose per line, `stamp tx ty tz qx qy qz qw` (s, m, camera to
/// world), '#' begins a comment. Stamps are read exactly, digit by digit, to nanoseconds;
/// quaternions are normalized.
/// @throws InputError "file:line: place: value" on a wrong count of numbers, a number that is none
/// or not finite, a negative stamp, a quaternion whose norm is more than 0.1 from 1, a stamp that
/// does not increase, or a file without poses.
Trajectory read_tum(const std::filesystem::path& file);
/// The same from text; `name` stands for the file in messages.
Trajectory parse_tum(const std::string& text, const std::string& name);
/// Doubles are written so that they read back to the same value. @pre stamps are not negative.
std::string format_tum(const Trajectory& trajectory);
void write_tum(const std::filesystem::path& file, const Trajectory& trajectory);

/// KITTI odometry text: one pose per line, the upper three rows of the matrix camera to world, 12
/// numbers. There are no stamps: pose i gets i * period. KITTI's cameras ran at 10 Hz.
/// @throws InputError as above; also where a matrix is no rotation to within 1e-3.
Trajectory read_kitti(const std::filesystem::path& file, Stamp period_ns = 100'000'000);
Trajectory parse_kitti(const std::string& text, const std::string& name,
                       Stamp period_ns = 100'000'000);
std::string format_kitti(const Trajectory& trajectory);
void write_kitti(const std::filesystem::path& file, const Trajectory& trajectory);

/// Seconds as decimal text, to integer nanoseconds, without a detour over floating point; digits
/// beyond the ninth decimal are rounded. "1305031229.5287" and "1.403636580013555527e+09" are both
/// accepted. @throws InputError (the text alone, without a place) if it is no number from 0 to
/// 9.2e9 s.
Stamp parse_stamp(const std::string& text);
/// "1305031229.528748000": nine decimals. @pre stamp_ns >= 0.
std::string format_stamp(Stamp stamp_ns);

}  // namespace mh
