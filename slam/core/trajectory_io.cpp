// SPDX-License-Identifier: Apache-2.0
#include "slam/core/trajectory_io.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <charconv>
#include <cmath>
#include <functional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "slam/core/counted.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/legible.hpp"
#include "slam/core/lower_case.hpp"
#include "slam/core/number_in.hpp"
#include "slam/core/text_file.hpp"

namespace mh {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> words;
  std::size_t begin = line.find_first_not_of(kBlanks);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.emplace_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

/// The values between commas, without blanks around them; a comma at the end adds none.
std::vector<std::string> split_at_commas(std::string_view line) {
  std::vector<std::string> words;
  while (!line.empty()) {
    const std::size_t comma = std::min(line.find(','), line.size());
    const std::vector<std::string> word = split(line.substr(0, comma));
    line.remove_prefix(std::min(comma + 1, line.size()));
    if (word.empty() && line.find_first_not_of(kBlanks) == std::string_view::npos) break;
    words.push_back(word.empty() ? "" : word.size() == 1 ? word[0] : word[0] + " " + word[1]);
  }
  return words;
}

/// Position of a line, for messages.
struct Place {
  const std::string& file;
  int line;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file, line, legible(what)));
  }
};

double parse_number(const std::string& word, const char* field, const Place& place) {
  const auto value = number_in(without_plus(word));
  if (!value) place.fail(fmt::format("{}: '{}' is not a number", field, word));
  if (!std::isfinite(*value)) place.fail(fmt::format("{}: '{}' is not finite", field, word));
  return *value;
}

/// Calls `use` with the words of each line that is neither empty nor a comment.
void for_each_line(const std::string& text, const std::string& name,
                   const std::function<void(const std::vector<std::string>&, const Place&)>& use,
                   std::vector<std::string> (*words_of)(std::string_view) = split) {
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    ++number;
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    const std::vector<std::string> words = words_of(line.substr(0, line.find('#')));
    if (!words.empty()) use(words, Place{name, number});
    begin = end + 1;
  }
}

Stamp parse_stamp_at(const std::string& word, const Place& place) {
  try {
    return parse_stamp(word);
  } catch (const InputError& error) {
    place.fail(fmt::format("stamp: {}", error.what()));
  }
}

bool starts_with_letter(const std::string& word) {
  return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0;
}

/// The columns of a pose after its stamp, as files of poses are known to have them.
constexpr std::string_view kScalarFirst = "x y z qw qx qy qz", kScalarLast = "x y z qx qy qz qw";

/// The last letters of seven names of columns, "x y z qw qx qy qz" of "p_x ... q_w ...": without q
/// where all names begin alike. "" if they are no names of a pose.
std::string columns_of(std::span<const std::string> names) {
  const auto stem = [](const std::string& name) { return name.substr(0, name.size() - 1); };
  if (std::ranges::any_of(
          names, [](const std::string& name) { return name.back() < 'w' || name.back() > 'z'; }))
    return "";
  const auto w = std::ranges::find(names, 'w', [](const std::string& name) { return name.back(); });
  if (w == names.end()) return "";
  const auto is_of_w = [&](const std::string& name) { return stem(name) == stem(*w); };
  const char* mark = std::ranges::all_of(names, is_of_w) ? "" : "q";
  std::string text;
  for (const std::string& name : names)
    text += fmt::format("{}{}{}", text.empty() ? "" : " ", is_of_w(name) ? mark : "", name.back());
  return text;
}

bool is_known(std::string_view columns) {
  return columns == kScalarFirst || columns == kScalarLast || columns == "x y z w x y z" ||
         columns == "x y z x y z w";
}

/// What a line of names calls a pose's columns. Names between commas are all of a line, and the
/// seven after the first count; if four of them begin with q, but they are not understood, all are
/// returned. Among the words of a comment, names may stand anywhere. "" if there are none.
std::string named_columns(std::string_view line) {
  if (line.starts_with('#')) line.remove_prefix(1);
  const bool commas = line.find(',') != std::string_view::npos;
  std::vector<std::string> names = commas ? split_at_commas(line) : split(line);
  for (std::string& name : names) {
    name.resize(std::min(name.find('['), name.size()));
    name.resize(name.find_last_not_of(' ') + 1);
    name = lower_case(std::move(name));
  }
  std::erase(names, "");
  for (std::size_t first = 1; first + 7 <= names.size() && (!commas || first == 1); ++first)
    if (const std::string columns = columns_of(std::span(names).subspan(first, 7));
        commas ? !columns.empty() : is_known(columns))
      return columns;
  const auto is_of_quaternion = [](const std::string& name) { return name.starts_with('q'); };
  const bool states =
      commas && names.size() >= 8 && std::ranges::count_if(names, is_of_quaternion) >= 4;
  return states ? fmt::format("{}", fmt::join(names, " ")) : "";
}

/// Where w stands among the seven numbers after a stamp: as the lines of names before the first
/// pose say, or else as `usual` does. @throws InputError naming the line if its order is unknown
std::size_t place_of_w(const std::string& text, const std::string& name, std::string_view usual) {
  const auto place_in = [](std::string_view columns) {
    return static_cast<std::size_t>(std::ranges::count(columns.substr(0, columns.find('w')), ' '));
  };
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::size_t first = line.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) continue;
    const std::string columns = named_columns(line.substr(first));
    if (is_known(columns)) return place_in(columns);
    if (!columns.empty())
      Place{name, number}.fail(fmt::format("its columns are named {}: `{}` and `{}` are read",
                                           columns, kScalarLast, kScalarFirst));
    if (line[first] != '#') break;
  }
  return place_in(usual);
}

using PoseFields = std::array<const char*, 7>;

/// The seven numbers after the stamp.
std::array<double, 7> numbers_of(const std::vector<std::string>& words, const PoseFields& fields,
                                 const Place& place) {
  std::array<double, 7> values{};
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = parse_number(words[k + 1], fields[k], place);
  return values;
}

/// The rotation among the seven numbers.
Eigen::Quaterniond rotation_of(const std::array<double, 7>& v, std::size_t w_at) {
  const std::size_t x_at = w_at == 3 ? 4 : 3;
  return {v[w_at], v[x_at], v[x_at + 1], v[x_at + 2]};
}

void require_later(const Trajectory& trajectory, Stamp stamp_ns, const std::string& word,
                   const Place& place) {
  if (!trajectory.empty() && stamp_ns <= trajectory.back().stamp_ns)
    place.fail(fmt::format("stamp: {} does not come after {}", word,
                           format_stamp(trajectory.back().stamp_ns)));
}

void add_pose(Trajectory& trajectory, Stamp stamp_ns, const Eigen::Vector3d& position_m,
              const Eigen::Quaterniond& rotation, const Place& place) {
  if (std::abs(rotation.norm() - 1.0) > 0.1)
    place.fail(fmt::format("quaternion: norm {:g}, expected 1", rotation.norm()));
  if (const double far_m = position_m.cwiseAbs().maxCoeff(); far_m > kFarthestPose_m)
    place.fail(fmt::format("position: lies {:g} m from the origin", far_m));
  trajectory.push_back({stamp_ns, SE3(rotation, position_m)});
}

}  // namespace

Stamp parse_stamp(const std::string& text) {
  const auto fail = [&] {
    throw InputError(fmt::format("'{}' is no time in seconds from 0 to 9.2e9", text));
  };
  // value = digits * 10^exponent seconds.
  std::string digits;
  int exponent = 0;
  std::size_t at = !text.empty() && text[0] == '+' ? 1 : 0;
  bool point = false;
  bool any = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '.' && !point) {
      point = true;
    } else if (c >= '0' && c <= '9') {
      any = true;
      if (point) --exponent;
      if (!digits.empty() || c != '0') digits += c;
    } else {
      break;
    }
  }
  if (!any) fail();
  if (at < text.size()) {
    if (text[at] != 'e' && text[at] != 'E') fail();
    int power = 0;
    const char* begin = text.data() + at + 1;
    if (begin != text.data() + text.size() && *begin == '+') ++begin;
    const auto [stop, error] = std::from_chars(begin, text.data() + text.size(), power);
    if (error != std::errc() || stop != text.data() + text.size() || std::abs(power) > 1000) fail();
    exponent += power;
  }
  if (digits.empty()) return 0;
  const int shift = exponent + 9;  // digits * 10^shift nanoseconds
  bool round_up = false;
  if (shift >= 0) {
    if (static_cast<int>(digits.size()) + shift > 19) fail();
    digits.append(static_cast<std::size_t>(shift), '0');
  } else {
    const int kept = static_cast<int>(digits.size()) + shift;
    if (kept < 0) return 0;
    round_up = digits[static_cast<std::size_t>(kept)] >= '5';
    if (kept == 0) return round_up;
    digits.resize(static_cast<std::size_t>(kept));
  }
  Stamp stamp = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), stamp);
  if (error != std::errc() || stamp > 9'200'000'000'000'000'000) fail();
  return stamp + round_up;
}

std::string format_stamp(Stamp stamp_ns) {
  return fmt::format("{}{}.{:09}", stamp_ns < 0 ? "-" : "", std::abs(stamp_ns / 1'000'000'000),
                     std::abs(stamp_ns % 1'000'000'000));
}

Trajectory parse_valid_tum(const std::string& text, const std::string& name,
                           const std::function<void(const InputError&)>& fault) {
  static constexpr PoseFields kFields = {"tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  const std::size_t w_at = place_of_w(text, name, kScalarLast);
  Trajectory trajectory;
  const auto add_line = [&](const std::vector<std::string>& words, const Place& place) {
    if (words.size() != 8)
      place.fail(fmt::format("pose: {}, expected 8 (stamp tx ty tz qx qy qz qw)",
                             counted(words.size(), "value")));
    const Stamp stamp_ns = parse_stamp_at(words[0], place);
    require_later(trajectory, stamp_ns, words[0], place);
    const std::array<double, 7> v = numbers_of(words, kFields, place);
    add_pose(trajectory, stamp_ns, {v[0], v[1], v[2]}, rotation_of(v, w_at), place);
  };
  for_each_line(text, name, [&](const std::vector<std::string>& words, const Place& place) {
    try {
      add_line(words, place);
    } catch (const InputError& error) {
      fault(error);
    }
  });
  return trajectory;
}

Trajectory parse_tum(const std::string& text, const std::string& name) {
  const auto refuse = [](const InputError& error) { throw InputError(error); };
  Trajectory trajectory = parse_valid_tum(text, name, refuse);
  if (trajectory.empty()) throw InputError(fmt::format("{}: contains no poses", name));
  return trajectory;
}

Trajectory parse_euroc(const std::string& text, const std::string& name) {
  static constexpr PoseFields kFields = {"p x", "p y", "p z", "q w", "q x", "q y", "q z"};
  const std::size_t w_at = place_of_w(text, name, kScalarFirst);
  Trajectory trajectory;
  bool is_first = true;
  const auto read_line = [&](const std::vector<std::string>& words, const Place& place) {
    const bool may_be_head = std::exchange(is_first, false);
    Stamp stamp_ns = 0;
    const char* end = words[0].data() + words[0].size();
    const auto [stop, error] = std::from_chars(words[0].data(), end, stamp_ns);
    if (error != std::errc() || stop != end || stamp_ns < 0) {
      if (may_be_head && starts_with_letter(words[0])) return;
      place.fail(fmt::format("timestamp: '{}' is not a whole number of nanoseconds", words[0]));
    }
    if (words.size() < 8)
      place.fail(
          fmt::format("pose: {}, expected at least 8 (timestamp p_x p_y p_z q_w q_x q_y q_z)",
                      counted(words.size(), "value")));
    require_later(trajectory, stamp_ns, words[0], place);
    const std::array<double, 7> v = numbers_of(words, kFields, place);
    add_pose(trajectory, stamp_ns, {v[0], v[1], v[2]}, rotation_of(v, w_at), place);
  };
  for_each_line(text, name, read_line, split_at_commas);
  if (trajectory.empty()) throw InputError(fmt::format("{}: contains no poses", name));
  return trajectory;
}

Trajectory parse_trajectory(const std::string& text, const std::string& name) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    const std::string_view data = line.substr(0, line.find('#'));
    if (data.find(',') != std::string_view::npos) return parse_euroc(text, name);
    if (data.find_first_not_of(kBlanks) != std::string_view::npos) break;
    begin = end + 1;
  }
  return parse_tum(text, name);
}

Trajectory read_trajectory(const std::filesystem::path& file) {
  return parse_trajectory(read_text(file), file.string());
}

Trajectory read_tum(const std::filesystem::path& file) {
  return parse_tum(read_text(file), file.string());
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
  for_each_line(text, name, [&](const std::vector<std::string>& words, const Place& place) {
    if (words.size() != 12)
      place.fail(fmt::format("pose: {}, expected 12 (3x4 matrix by rows)",
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

void write_kitti(const std::filesystem::path& file, const Trajectory& trajectory) {
  write_atomically(file, format_kitti(trajectory));
}

}  // namespace mh
