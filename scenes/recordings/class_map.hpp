// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/grid2d.hpp"
#include "slam/core/labels.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Meaning of the ids in label images from other sources: element i is the class of id i, void if
/// not listed.
using ClassMap = std::vector<ClassId>;

/// Reads a class map: YAML of lines `id: class`, ids from 0 to 65535, or a ScanNet label table
/// (.tsv). @throws InputError naming file and line.
ClassMap load_class_map(const std::filesystem::path& file);

/// Label images of a recording, by index of the frame.
struct LabelsOfFrames {
  std::size_t frames = 0;
  /// nullopt if the frame has no labels. @throws InputError if they cannot be read
  std::function<std::optional<Grid2d<std::uint16_t>>(std::size_t)> read;
  std::function<std::string(std::size_t)> place;  ///< for messages
};

/// Adds a note if the first label image that can be read and is not empty contains no id that has a
/// class: with the wrong table, a scene would look empty.
void note_foreign_ids(const LabelsOfFrames& labels, const ClassMap& map,
                      const std::filesystem::path& table, std::vector<std::string>& notes);

/// The note about a class map for a recording without labels.
std::string no_labels_note(const std::filesystem::path& table);

/// A label image as class distributions, each with all probability on one class.
/// @param map  meaning of the ids; null: they are our classes
/// @throws InputError "class N is unknown" if `map` is null and an id is not one of our classes.
SemanticImage one_hot(const Grid2d<std::uint16_t>& ids, const ClassMap* map);

}  // namespace mh
