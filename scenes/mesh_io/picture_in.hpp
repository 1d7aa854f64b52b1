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

/// A material's picture as a file holds it.
struct PictureIn {
  SharedGrid<Rgb8> color{};
  SharedGrid<std::uint8_t> opacity{};   ///< empty if the file has none
  std::string fault = "is no picture";  ///< why color is empty, where it is
};

/// The pictures of a scene's materials, each decoded once, however many files hold it and however
/// many materials show it.
class PictureStore {
 public:
  /// The picture in these bytes.
  PictureIn decode(std::string_view bytes);
  PictureIn read(const std::filesystem::path& file);

 private:
  using Digest = std::pair<std::uint64_t, std::uint64_t>;
  std::map<Digest, PictureIn> decoded_;  // by the bytes' xxh3-128
};

}  // namespace mh
