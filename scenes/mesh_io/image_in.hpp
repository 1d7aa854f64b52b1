// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "scenes/shared_grid.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// A material's image as decoded from a file.
struct ImageIn {
  SharedGrid<Rgb8> color{};
  SharedGrid<std::uint8_t> opacity{};     ///< empty if the file has none
  std::string fault = "is not an image";  ///< if color is empty: why
};

/// The images of a scene's materials. Each is decoded only once, no matter how many files contain
/// it and how many materials use it.
class ImageStore {
 public:
  /// Decodes the image in these bytes.
  ImageIn decode(std::string_view bytes);
  ImageIn read(const std::filesystem::path& file);

 private:
  using Digest = std::pair<std::uint64_t, std::uint64_t>;
  std::map<Digest, ImageIn> decoded_;  // by the bytes' xxh3-128
};

}  // namespace mh
