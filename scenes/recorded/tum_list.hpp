// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// One line of rgb.txt, depth.txt, label.txt: a picture and its moment.
struct TumListEntry {
  Stamp stamp_ns = 0;
  std::filesystem::path file;  ///< as the list names it
};

/// Parses "stamp file" lines, after so many words to skip; '#' begins a comment.
/// Entries keep the list's order; their stamps need not increase.
/// @param name  stands for the list in messages
/// @throws InputError naming list and line: no file, no stamp.
std::vector<TumListEntry> parse_tum_list(const std::string& text, const std::string& name,
                                         int skip = 0);

}  // namespace mh
