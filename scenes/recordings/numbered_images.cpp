// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/numbered_images.hpp"

#include <charconv>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {

namespace fs = std::filesystem;

std::optional<int> whole_number_of(std::string_view digits) {
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number < 0)
    return std::nullopt;
  return number;
}

std::map<int, fs::path> numbered_images(const fs::path& folder, std::string_view before,
                                        std::string_view after) {
  std::map<int, fs::path> images;
  for (const std::string& name : list_folder(folder, fmt::format("{}*{}", before, after))) {
    if (name.size() < before.size() + after.size()) continue;
    std::string_view digits = name;
    digits.remove_prefix(before.size());
    digits.remove_suffix(after.size());
    const auto number = whole_number_of(digits);
    if (!number) continue;
    const auto [entry, is_new] = images.try_emplace(*number, folder / name);
    if (!is_new)
      throw InputError(fmt::format("{}: has the same number as {}: remove one of them",
                                   (folder / name).string(), entry->second.filename().string()));
  }
  return images;
}

void LeftOut::add(const fs::path& color) {
  if (count_++ == 0) first_ = color;
}

void LeftOut::note(const fs::path& recording, std::size_t offered,
                   std::vector<std::string>& notes) const {
  if (count_ == 0) return;
  notes.push_back(
      fmt::format("{}: {} of {} color images have no depth image and are left out (the first is "
                  "{})",
                  recording.string(), count_, offered, first_.string()));
}

}  // namespace mh
