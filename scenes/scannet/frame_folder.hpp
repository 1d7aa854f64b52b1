// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "scenes/scannet/recording.hpp"

namespace mh {

/// The number in an image's name: "17.png", "label-filt/000017.png"; nullopt if it is not a number.
std::optional<std::uint32_t> number_of_name(const std::filesystem::path& name);

/// Those files of a folder whose names are numbers, in numeric order.
class NumberedFiles {
 public:
  /// @param endings  which files are included, e.g. ".png"
  /// @throws InputError if the folder does not exist.
  NumberedFiles(const std::filesystem::path& folder,
                std::initializer_list<std::string_view> endings);

  std::vector<std::uint32_t> numbers() const;
  bool contains(std::uint32_t number) const { return files_.contains(number); }
  /// @pre contains(number)
  const std::filesystem::path& file(std::uint32_t number) const { return files_.at(number); }

 private:
  std::map<std::uint32_t, std::filesystem::path> files_;
};

/// Writes a recording as ScanNet's SensReader extracts it: color/N.jpg, depth/N.png (16 bit),
/// pose/N.txt and intrinsic/. Stamps are lost. The intrinsics are written last, so that an
/// incomplete folder cannot be read.
/// @throws InputError if it cannot be written.
void save_extracted(const std::filesystem::path& folder, const RecordingInfo& info,
                    std::size_t frames,
                    const std::function<RecordedMoment(std::size_t index)>& frame_at);

}  // namespace mh
