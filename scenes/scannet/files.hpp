// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mh {

/// Paths of the files of a ScanNet scene; optional ones are not checked.
struct ScannetFiles {
  std::string scene_id;
  std::filesystem::path mesh, labels, segments, aggregation, info;

  ScannetFiles(const std::filesystem::path& folder, const std::string& id);
};

/// Whether a path is a folder with a ScanNet mesh, or is such a mesh in a folder with annotations.
bool is_scannet_scene(const std::filesystem::path& path);

/// Finds the files of the scene in that folder, or of that mesh. If a folder contains several
/// scenes, the one with the folder's name is used. @throws InputError if there is none, or the
/// choice is ambiguous.
ScannetFiles find_scannet_files(const std::filesystem::path& path);

/// Finds the label tables next to a scene, v2's before v1's, or those in the nearest of three
/// parent folders that has any (a release keeps one table for all scenes).
std::vector<std::filesystem::path> find_label_tables(const std::filesystem::path& folder);

inline constexpr const char* kLabelTableV2 = "scannetv2-labels.combined.tsv";
inline constexpr const char* kLabelTableV1 = "scannet-labels.combined.tsv";

}  // namespace mh
