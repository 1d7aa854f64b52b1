// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// Parses an unsigned whole number; nullopt if the text has anything but digits.
std::optional<int> whole_number_of(std::string_view digits);

/// Those files of a folder whose names consist of a number between two given texts, such as
/// "frame-" and ".color.png", by number.
/// @throws InputError if two files have the same number.
std::map<int, std::filesystem::path> numbered_images(const std::filesystem::path& folder,
                                                     std::string_view before,
                                                     std::string_view after);

/// Counts color images that are left out because they have no depth image.
class LeftOut {
 public:
  void add(const std::filesystem::path& color);
  /// Adds a line about the images left out, if there are any. @param offered  number of all color
  /// images
  void note(const std::filesystem::path& recording, std::size_t offered,
            std::vector<std::string>& notes) const;

 private:
  std::size_t count_ = 0;
  std::filesystem::path first_;
};

}  // namespace mh
