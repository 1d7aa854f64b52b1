// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mh {

/// Where the files of a ScanNet scene lie; those that may be missing are not checked.
struct ScannetFiles {
  std::string scene_id;
  std::filesystem::path mesh, labels, segments, aggregation, info;

  ScannetFiles(const std::filesystem::path& folder, const std::string& id);
};

/// Whether a path is a folder that holds a ScanNet mesh, or is such a mesh in a folder with
/// annotations.
bool is_scannet_scene(const std::filesystem::path& path);

/// The files of the scene in that folder, or of that mesh. Where a folder holds several, the one of
/// its own name is meant. @throws InputError if there is none, or no telling which.
ScannetFiles find_scannet_files(const std::filesystem::path& path);

/// The label tables beside a scene, v2's before v1's, or those of the nearest of three folders
/// above it that has any (a release keeps one table for all scenes).
std::vector<std::filesystem::path> find_label_tables(const std::filesystem::path& folder);

inline constexpr const char* kLabelTableV2 = "scannetv2-labels.combined.tsv";
inline constexpr const char* kLabelTableV1 = "scannet-labels.combined.tsv";

}  // namespace mh
