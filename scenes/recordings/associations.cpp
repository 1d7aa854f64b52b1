// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/associations.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "scenes/image_file.hpp"
#include "scenes/recordings/tum_list.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

bool is_number(const std::string& word) {
  std::size_t used = 0;
  try {
    std::stod(word, &used);
  } catch (const std::exception&) {
    return false;
  }
  return used == word.size();
}

/// @throws InputError if the first line has more than four words and the second is a number:
/// associate.py made the list, and paired images with poses.
void refuse_poses(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<std::string> all;
    for (std::string word; words >> word;) all.push_back(word);
    if (all.empty()) continue;
    if (all.size() > 4 && is_number(all[1]))
      throw InputError(
          fmt::format("{}:{}: '{}' is not a file: a line is 'stamp file stamp file', but this one "
                      "has {} words, a pose among them; pair only the two lists of images",
                      name, number, all[1], all.size()));
    return;
  }
}

/// Whether a file is a depth image; nullopt if it cannot be read as an image.
std::optional<bool> is_depth(const fs::path& file) {
  try {
    decode_depth16(read_file(file));
    return true;
  } catch (const InputError&) {
  }
  try {
    decode_image(read_file(file));
    return false;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

FirstImage first_image(const std::vector<TumListEntry>& first,
                       const std::vector<TumListEntry>& second, FirstImage otherwise) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (const auto depth = is_depth(first[i].file))
      return *depth ? FirstImage::kDepth : FirstImage::kColor;
    if (const auto depth = is_depth(second[i].file))
      return *depth ? FirstImage::kColor : FirstImage::kDepth;
  }
  return otherwise;
}

}  // namespace

std::vector<RecordedFrame> read_associations(const fs::path& list, FirstImage otherwise) {
  const std::string text = read_text(list);
  refuse_poses(text, list.string());
  std::vector<TumListEntry> color = parse_tum_list(text, list.string()),
                            depth = parse_tum_list(text, list.string(), 2);
  if (color.empty()) throw InputError(fmt::format("{}: lists no image", list.string()));
  for (std::vector<TumListEntry>* column : {&color, &depth})
    for (TumListEntry& entry : *column) entry.file = list.parent_path() / entry.file;
  if (first_image(color, depth, otherwise) == FirstImage::kDepth) std::swap(color, depth);
  std::vector<RecordedFrame> frames;
  for (std::size_t i = 0; i < color.size(); ++i)
    frames.push_back({color[i].stamp_ns, color[i].file, depth[i].file, fs::path()});
  return frames;
}

void sort_frames(std::vector<RecordedFrame>& frames, const fs::path& list,
                 std::vector<std::string>* notes) {
  // For each length, the smallest stamp that ends a non-decreasing subsequence of that length.
  std::vector<Stamp> ends;
  for (const RecordedFrame& frame : frames) {
    const auto place = std::ranges::upper_bound(ends, frame.stamp_ns);
    if (place == ends.end())
      ends.push_back(frame.stamp_ns);
    else
      *place = frame.stamp_ns;
  }
  if (4 * (frames.size() - ends.size()) < frames.size()) return;
  std::ranges::stable_sort(frames, {}, &RecordedFrame::stamp_ns);
  if (notes != nullptr)
    notes->push_back(
        fmt::format("{}: its images are not ordered by timestamp: they are sorted", list.string()));
}

}  // namespace mh
