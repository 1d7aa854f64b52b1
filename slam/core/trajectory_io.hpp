// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/trajectory.hpp"

namespace mh {

/// No camera is farther from its origin than this, not even in coordinates of the whole Earth (UTM,
/// ECEF): a number beyond it is a mistake.
inline constexpr double kFarthestPose_m = 1e8;

/// Reads poses, true or estimated, from text in common formats: one pose per line, in TUM's order
/// `stamp tx ty tz qx qy qz qw` separated by whitespace (s, m, camera to world), or in EuRoC's
/// `timestamp, p x y z, q w x y z`, then ignored columns, separated by commas or semicolons (ns,
/// m). A line of names before the poses, a comment or not, gives the order of columns and may state
/// the unit of stamps (columns_named_by()); otherwise, the unit is inferred from their size. '#'
/// starts a comment. Stamps are read exactly, digit by digit, to nanoseconds; quaternions are
/// normalized; poses in EuRoC's format are those of the sensor or body that the file is about.
/// @param notes  receives one line that counts what is left out: poses that are not finite, that
///   have a quaternion of zeros, that repeat a stamp (the first is kept), and lines that are not
///   poses; further lines if stamps were not in order (poses are sorted) or their unit had to be
///   guessed. Null: all of these except a guessed unit are errors.
/// @throws InputError "file:line: place: value" if columns are named that cannot be understood, or
///   most lines are not poses: wrong count of numbers, a malformed number, a position beyond
///   kFarthestPose_m, a negative stamp, a quaternion whose norm is neither 0 nor within 0.1 of 1.
///   Also thrown if there is no pose at all.
Trajectory parse_trajectory(const std::string& text, const std::string& name,
                            std::vector<std::string>* notes = nullptr);
Trajectory read_trajectory(const std::filesystem::path& file,
                           std::vector<std::string>* notes = nullptr);
/// The same, but the result may be empty.
Trajectory parse_valid_poses(const std::string& text, const std::string& name,
                             std::vector<std::string>& notes);
/// Writes the poses in TUM's format, with doubles that read back to the same value. @pre stamps are
/// not negative.
std::string format_tum(const Trajectory& trajectory);
void write_tum(const std::filesystem::path& file, const Trajectory& trajectory);

/// KITTI odometry text: one pose per line, the upper three rows of the camera-to-world matrix, 12
/// numbers. There are no stamps: pose i gets the stamp i * period_ns. KITTI's cameras run at 10 Hz.
/// @throws InputError "file:line: place: value" on anything else, or if a matrix is not a rotation
/// to within 1e-3.
Trajectory read_kitti(const std::filesystem::path& file, Stamp period_ns = 100'000'000);
Trajectory parse_kitti(const std::string& text, const std::string& name,
                       Stamp period_ns = 100'000'000);
std::string format_kitti(const Trajectory& trajectory);

/// Converts decimal seconds to integer nanoseconds without going through floating point; digits
/// beyond the ninth decimal are rounded. Accepts both "1305031229.5287" and
/// "1.403636580013555527e+09". @param unit  of the text, as a power of ten of a second
/// @throws InputError (the text alone, without a place) if it is not a number from 0 to 9.2e9 s.
Stamp parse_stamp(std::string_view text, int unit = 0);
/// "1305031229.528748000": nine decimals. @pre stamp_ns >= 0.
std::string format_stamp(Stamp stamp_ns);

}  // namespace mh
