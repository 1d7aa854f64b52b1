// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/labels.hpp"

namespace mh {

/// The classes of a network, in the order of its own indices.
struct ClassNames {
  std::vector<std::string> names;
  std::vector<ClassId> ids;  ///< our class for each name; void if there is none
  std::size_t size() const { return names.size(); }
  /// A line for the user if none of the classes is ours; otherwise empty.
  std::string unknown_note(const std::filesystem::path& of) const;
};

/// The 80 detection classes of COCO (Lin et al., ECCV 2014), in the order of its networks.
const ClassNames& coco80();

/// The index among coco80() of a COCO category id; -1 if there is none. Category ids go up to 90,
/// with gaps.
int coco80_of_category(int category_id);

/// Reads class names: one per line, as in darknet's .names files (blank lines at the end do not
/// count), a list in JSON, or `names` in a data set's .yaml for Ultralytics.
/// @throws InputError naming the file, also if it contains no names.
ClassNames load_class_names(const std::filesystem::path& file);

/// Reads names as Python prints them in a network's metadata: {0: 'chair', 1: "driver's seat"} or
/// ['chair', 'table']. nullopt if the text is neither, or does not name each class from 0 once.
std::optional<ClassNames> read_class_names(std::string_view python);

}  // namespace mh
