// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// One line of rgb.txt, depth.txt, label.txt: an image and its stamp.
struct TumListEntry {
  Stamp stamp_ns = 0;
  std::filesystem::path file;  ///< as written in the list
};

/// Parses "stamp file" lines, skipping the given number of words in each; '#' starts a comment.
/// Stamps are seconds, or nanoseconds since 1970. Entries keep the list's order; their stamps need
/// not increase.
/// @param name  names the list in messages
/// @throws InputError naming list and line: a missing file or stamp.
std::vector<TumListEntry> parse_tum_list(const std::string& text, const std::string& name,
                                         int skip = 0);

}  // namespace mh
