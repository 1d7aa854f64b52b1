// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/ros/parts.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/yaml.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// A name without the time that ROS 1's recorder writes into it: "2026-01-31-23-59-59".
std::string without_time(std::string name) {
  constexpr std::string_view kTime = "0000-00-00-00-00-00";
  const auto is_time = [&](std::size_t at) {
    for (std::size_t i = 0; i < kTime.size(); ++i)
      if (kTime[i] == '0' ? !is_digit(name[at + i]) : name[at + i] != kTime[i]) return false;
    return true;
  };
  for (std::size_t at = 0; at + kTime.size() <= name.size(); ++at)
    if (is_time(at)) return name.erase(at, kTime.size());
  return name;
}

/// The name and number of a part: "run" and 12 for "run_12.bag".
std::optional<std::pair<std::string, std::uint32_t>> part_of(const fs::path& file) {
  constexpr std::size_t kMostDigits = 6;
  const std::string stem = file.stem().string();
  const std::size_t mark = stem.rfind('_');
  if (mark == std::string::npos || mark + 1 == stem.size()) return std::nullopt;
  const std::string number = stem.substr(mark + 1);
  if (number.size() > kMostDigits || !std::ranges::all_of(number, is_digit)) return std::nullopt;
  return std::pair(without_time(stem.substr(0, mark)),
                   static_cast<std::uint32_t>(std::stoul(number)));
}

/// The files that ROS 2's metadata lists; empty if there is no metadata, or if it lists different
/// files.
std::vector<std::string> listed_in_metadata(const fs::path& folder,
                                            const std::vector<std::string>& names) {
  const fs::path file = folder / "metadata.yaml";
  if (!is_file(file)) return {};
  std::vector<std::string> listed;
  try {
    YamlReader yaml = YamlReader::load(file);
    YamlReader paths = yaml.at("rosbag2_bagfile_information").at("relative_file_paths");
    for (const YamlReader& path : paths.items())
      listed.push_back(fs::path(path.as_string()).filename().string());
  } catch (const InputError&) {  // opening the files gives a better message
    return {};
  }
  std::vector<std::string> sorted = listed;
  std::ranges::sort(sorted);
  return sorted == names ? listed : std::vector<std::string>{};
}

/// The files by their numbers; empty if they are not parts of one recording.
std::map<std::uint32_t, std::string> numbered(const std::vector<std::string>& names) {
  std::map<std::uint32_t, std::string> by_number;
  std::string common;
  for (const std::string& name : names) {
    const auto part = part_of(name);
    if (!part || (!by_number.empty() && part->first != common) ||
        !by_number.emplace(part->second, name).second)
      return {};
    common = part->first;
  }
  return by_number;
}

/// The names of the parts in their order; empty if they are not parts of one recording.
std::vector<std::string> in_order(const fs::path& folder, const std::vector<std::string>& names,
                                  std::vector<std::string>& notes) {
  std::vector<std::string> listed = listed_in_metadata(folder, names);
  if (!listed.empty()) return listed;
  const auto by_number = numbered(names);
  // Recorders count from 0; people who number their recordings mostly count from 1.
  if (by_number.empty() || by_number.begin()->first != 0) return {};
  for (const auto& [number, name] : by_number) listed.push_back(name);
  if (by_number.rbegin()->first + 1 != by_number.size())
    notes.push_back(fmt::format("{}: {} of {} parts are missing between {} and {}", folder.string(),
                                by_number.rbegin()->first + 1 - by_number.size(),
                                by_number.rbegin()->first + 1, listed.front(), listed.back()));
  return listed;
}

}  // namespace

std::vector<fs::path> parts_at(const fs::path& path, const char* pattern,
                               std::vector<std::string>& notes) {
  if (!is_folder(path)) return {path};
  const std::vector<std::string> names = list_folder(path, pattern);
  if (names.size() == 1) return {path / names.front()};
  if (names.empty()) throw InputError(fmt::format("{}: holds no file {}", path.string(), pattern));
  const std::vector<std::string> parts = in_order(path, names, notes);
  if (parts.empty())
    throw InputError(fmt::format("{}: holds {} files {}: name one of them, {} for example",
                                 path.string(), names.size(), pattern, names.front()));
  notes.push_back(fmt::format("{}: {} files are read as one recording: {} to {}", path.string(),
                              parts.size(), parts.front(), parts.back()));
  std::vector<fs::path> files;
  for (const std::string& part : parts) files.push_back(path / part);
  return files;
}

}  // namespace mh
