// SPDX-License-Identifier: Apache-2.0
#include "slam/core/trajectory_io.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "slam/core/pose_collector.hpp"
#include "slam/core/pose_columns.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/number_in.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

using Words = std::vector<std::string_view>;

double parse_number(std::string_view word, const char* field, const LinePlace& place) {
  const auto value = number_in(without_plus(word));
  // In tables, NaN is written as an empty value between commas.
  if (!value)
    place.fail(fmt::format("{}: '{}' is not a number", field, word),
               word.empty() ? PoseFault::kNotFinite : PoseFault::kNoPose);
  if (!std::isfinite(*value))
    place.fail(fmt::format("{}: '{}' is not finite", field, word), PoseFault::kNotFinite);
  return *value;
}

/// Calls `use` with each line and its number until it returns false.
void for_each_line(std::string_view text,
                   const std::function<bool(std::string_view line, int number)>& use) {
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (!use(text.substr(begin, end - begin), ++number)) return;
    begin = end + 1;
  }
}

/// The line without its comment: what follows a '#', or the whole line if it begins with '%'.
std::string_view without_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first != std::string_view::npos && line[first] == '%') return {};
  return line.substr(0, line.find('#'));
}

/// The words of a line; none if they are all empty.
Words words_of_data(std::string_view line, char separator) {
  Words words = words_of_line(without_comment(line), separator);
  if (std::ranges::all_of(words, &std::string_view::empty)) words.clear();
  return words;
}

/// Whether a line holds names: no word is a number, and the first is empty or begins with a letter,
/// or with _ or / as in PlotJuggler's files.
bool is_of_names(const Words& words) {
  const auto is_number = [](std::string_view word) {
    return number_in(without_plus(word)).has_value();
  };
  const char first = words[0].empty() ? '_' : words[0][0];
  return std::ranges::none_of(words, is_number) &&
         (std::isalpha(static_cast<unsigned char>(first)) != 0 || first == '_' || first == '/');
}

/// How a file writes its poses.
struct Layout {
  char separator = ' ';
  PoseColumns columns;
  int first_line = std::numeric_limits<int>::max();  ///< of data
  bool is_table = false;  ///< values are separated by commas or semicolons
};

/// Data begin at the first line that is neither a comment nor a line of names. The columns are
/// those that an earlier line names, if any.
Layout layout_of(const std::string& text, const std::string& name) {
  Layout layout;
  Words first;
  std::vector<std::pair<std::string_view, int>> before;
  for_each_line(text, [&](std::string_view line, int number) {
    const std::string_view data = without_comment(line);
    const char separator = data.find(';') != std::string_view::npos   ? ';'
                           : data.find(',') != std::string_view::npos ? ','
                                                                      : ' ';
    Words words = words_of_data(line, separator);
    if (words.empty() || is_of_names(words)) {
      before.emplace_back(line, number);
      return true;
    }
    layout.separator = separator;
    layout.first_line = number;
    first = std::move(words);
    return false;
  });
  layout.is_table = layout.separator != ' ';
  if (layout.is_table) {  // as in EuRoC's files
    layout.columns.pose = {1, 2, 3, 5, 6, 7, 4};
    layout.columns.most = std::numeric_limits<std::size_t>::max();
  }
  for (const auto& [line, number] : before) {
    try {
      if (const auto columns =
              columns_named_by(line, layout.separator, layout.columns, first.size())) {
        layout.columns = *columns;
        return layout;
      }
    } catch (const InputError& error) {
      LinePlace{name, number}.fail(error.what());
    }
  }
  return layout;
}

Words words_of_pose(std::string_view line, const Layout& layout, const LinePlace& place) {
  Words words = words_of_data(line, layout.separator);
  const auto& [least, most] = std::pair(layout.columns.least, layout.columns.most);
  constexpr std::size_t kMatrix = 12;
  if (!words.empty() && (words.size() < least || words.size() > most))
    place.fail(fmt::format("pose: {}, expected {}{}{}{}", counted(words.size(), "value"),
                           least == most ? "" : "at least ", least,
                           least != 8        ? ""
                           : layout.is_table ? " (timestamp p_x p_y p_z q_w q_x q_y q_z)"
                                             : " (stamp tx ty tz qx qy qz qw)",
                           words.size() == kMatrix && !layout.is_table
                               ? "; matrices without stamps are KITTI's: `evaluate --format kitti`"
                               : ""));
  return words;
}

/// Properties of a file's stamps from which their unit is inferred.
struct StampRange {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  std::size_t count = 0;
  bool whole = true;
};

StampRange range_of_stamps(const std::string& text, const Layout& layout) {
  StampRange range;
  for_each_line(text, [&](std::string_view line, int number) {
    if (number < layout.first_line) return true;
    const Words words = words_of_data(line, layout.separator);
    if (words.size() < layout.columns.least) return true;
    const std::string_view word = words[layout.columns.stamp];
    const auto stamp = number_in(without_plus(word));
    if (!stamp || !std::isfinite(*stamp) || *stamp < 0) return true;
    range.least = std::min(range.least, *stamp);
    range.most = std::max(range.most, *stamp);
    range.whole = range.whole && word.find_first_of(".eE") == std::string_view::npos;
    ++range.count;
    return true;
  });
  return range;
}

/// The unit of stamps if no name states it, as a power of ten of a second. Times since 1970 reveal
/// it by their size. Smaller stamps are seconds unless they are whole numbers that, as seconds,
/// would be 1e6 s apart, or 1e3 s in a file with commas (such as EuRoC's). Those are nanoseconds,
/// and so is a single whole number in a file with commas.
int likely_unit(const StampRange& range, bool commas) {
  if (range.most >= 1e17) return -9;
  if (range.most >= 1e14) return -6;
  if (range.most >= 1e11) return -3;
  if (!range.whole) return 0;
  if (!(range.most > range.least)) return commas ? -9 : 0;
  const double step = (range.most - range.least) / static_cast<double>(range.count - 1);
  return step >= (commas ? 1e3 : 1e6) ? -9 : 0;
}

const char* unit_name(int unit) {
  return unit == 0    ? "seconds"
         : unit == -3 ? "milliseconds"
         : unit == -6 ? "microseconds"
                      : "nanoseconds";
}

Stamp stamp_in(const Words& words, const PoseColumns& columns, const LinePlace& place) {
  const std::string_view word = words[columns.stamp];
  if (const auto value = number_in(word); value && !std::isfinite(*value))
    place.fail(fmt::format("stamp: '{}' is not finite", word), PoseFault::kNotFinite);
  try {
    const Stamp rest_ns = columns.nanoseconds ? parse_stamp(words[*columns.nanoseconds], -9) : 0;
    return parse_stamp(word, *columns.unit) + rest_ns;
  } catch (const InputError& error) {
    place.fail(fmt::format("stamp: {}", error.what()));
  }
}

TimedPose pose_in(const Words& words, const PoseColumns& columns, const LinePlace& place) {
  static constexpr std::array<const char*, 7> kFields = {"tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  const Stamp stamp_ns = stamp_in(words, columns, place);
  std::array<double, 7> v{};
  for (std::size_t k = 0; k < v.size(); ++k)
    v[k] = parse_number(words[columns.pose[k]], kFields[k], place);
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  const Eigen::Vector3d position_m(v[0], v[1], v[2]);
  if (std::abs(rotation.norm() - 1.0) > 0.1)
    place.fail(fmt::format("quaternion: norm {:g}, expected 1", rotation.norm()),
               rotation.norm() == 0 ? PoseFault::kZero : PoseFault::kNoPose);
  if (const double far_m = position_m.cwiseAbs().maxCoeff(); far_m > kFarthestPose_m)
    place.fail(fmt::format("position: lies {:g} m from the origin", far_m));
  return {stamp_ns, SE3(rotation, position_m)};
}

/// @param notes  null: nothing may be left out
/// @param may_be_empty  whether a file without poses is accepted
Trajectory parse(const std::string& text, const std::string& name, std::vector<std::string>* notes,
                 bool may_be_empty) {
  if (text.find('\0') != std::string::npos)
    throw InputError(name + ": is not text, and a file of poses must be");
  Layout layout = layout_of(text, name);
  if (!layout.columns.unit) {
    const StampRange range = range_of_stamps(text, layout);
    layout.columns.unit = likely_unit(range, layout.is_table);
    const bool usual = *layout.columns.unit == (layout.is_table && range.whole ? -9 : 0);
    if (!usual && notes != nullptr)
      notes->push_back(
          fmt::format("{}: its stamps are taken as {}", name, unit_name(*layout.columns.unit)));
  }
  PoseCollector collector(name, notes == nullptr);
  for_each_line(text, [&](std::string_view line, int number) {
    if (number < layout.first_line) return true;
    const LinePlace place{name, number};
    try {
      const Words words = words_of_pose(line, layout, place);
      if (!words.empty())
        collector.add(pose_in(words, layout.columns, place), words[layout.columns.stamp], place);
    } catch (const BadPose& fault) {
      collector.leave_out(fault);
    }
    return true;
  });
  Trajectory poses = collector.finish(notes);
  if (poses.empty() && !may_be_empty)
    throw InputError(name + ": contains no poses" + collector.first_fault());
  return poses;
}

}  // namespace

Trajectory parse_valid_poses(const std::string& text, const std::string& name,
                             std::vector<std::string>& notes) {
  return parse(text, name, &notes, true);
}

Trajectory parse_trajectory(const std::string& text, const std::string& name,
                            std::vector<std::string>* notes) {
  return parse(text, name, notes, false);
}

Trajectory read_trajectory(const std::filesystem::path& file, std::vector<std::string>* notes) {
  return parse_trajectory(read_text(file), file.string(), notes);
}

std::string format_tum(const Trajectory& trajectory) {
  std::string text = "# stamp tx ty tz qx qy qz qw\n";
  for (const TimedPose& pose : trajectory) {
    const Eigen::Vector3d& t = pose.world_from_camera.translation();
    const Eigen::Quaterniond q = pose.world_from_camera.quaternion();
    text += fmt::format("{} {} {} {} {} {} {} {}\n", format_stamp(pose.stamp_ns), t.x(), t.y(),
                        t.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

void write_tum(const std::filesystem::path& file, const Trajectory& trajectory) {
  write_atomically(file, format_tum(trajectory));
}

Trajectory parse_kitti(const std::string& text, const std::string& name, Stamp period_ns) {
  assert(period_ns > 0);
  Trajectory trajectory;
  for_each_line(text, [&](std::string_view line, int number) {
    const Words words = words_of_data(line, ' ');
    if (words.empty()) return true;
    const LinePlace place{name, number};
    if (words.size() != 12)
      place.fail(fmt::format("pose: {}, expected 12 (3x4 matrix, row by row)",
                             counted(words.size(), "value")));
    Eigen::Matrix<double, 3, 4> matrix;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column)
        matrix(row, column) =
            parse_number(words[static_cast<std::size_t>(4 * row + column)], "matrix", place);
    const Eigen::Matrix3d rotation = matrix.leftCols<3>();
    const double off = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
    if (!(off < 1e-3) || rotation.determinant() < 0)
      place.fail("matrix: its left 3x3 part is not a rotation");
    const auto index = static_cast<Stamp>(trajectory.size());
    trajectory.push_back({index * period_ns, SE3(rotation, matrix.col(3)).normalized()});
    return true;
  });
  if (trajectory.empty()) throw InputError(fmt::format("{}: contains no poses", name));
  return trajectory;
}

Trajectory read_kitti(const std::filesystem::path& file, Stamp period_ns) {
  return parse_kitti(read_text(file), file.string(), period_ns);
}

std::string format_kitti(const Trajectory& trajectory) {
  std::string text;
  for (const TimedPose& pose : trajectory) {
    const Eigen::Matrix3d& r = pose.world_from_camera.rotation();
    const Eigen::Vector3d& t = pose.world_from_camera.translation();
    for (int row = 0; row < 3; ++row)
      text += fmt::format("{}{} {} {} {}", row == 0 ? "" : " ", r(row, 0), r(row, 1), r(row, 2),
                          t[row]);
    text += '\n';
  }
  return text;
}

}  // namespace mh
