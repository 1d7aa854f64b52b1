// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// Positions of a pose's values in a line.
struct PoseColumns {
  std::size_t stamp = 0;
  /// A column of nanoseconds to add to the stamp: ROS writes whole seconds and nanoseconds
  /// separately.
  std::optional<std::size_t> nanoseconds = {};
  /// The stamp's unit as a power of ten of a second, -9 for nanoseconds; absent if no name states
  /// it.
  std::optional<int> unit = {};
  std::array<std::size_t, 7> pose = {1, 2, 3, 4, 5, 6, 7};  ///< of x y z qx qy qz qw
  std::size_t least = 8, most = 8;                          ///< numbers of values in a line
};

/// The words of a line, separated by whitespace, commas or semicolons, without the whitespace and
/// quotes around them; a separator at the end adds no word.
/// @param separator  ' ' for whitespace of any kind
std::vector<std::string_view> words_of_line(std::string_view line, char separator);

/// The columns that a line of names declares. If there are as many names as values, not counting
/// words before the names, each name belongs to the column at its position, and there may be
/// columns that are not part of the pose. Otherwise, the seven names of a pose give only the order
/// of the values that follow the stamp. Lines of data may end after the last value that is used.
/// @param line     with or without a leading # or %
/// @param usual defaults for what is not named
/// @param values   number of values in a line of data
/// @returns nullopt if the line names no pose
/// @throws InputError (without a place) if it names columns that cannot be understood
std::optional<PoseColumns> columns_named_by(std::string_view line, char separator,
                                            const PoseColumns& usual, std::size_t values);

}  // namespace mh
