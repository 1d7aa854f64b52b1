// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/labels_file.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/ply.hpp"
#include "scenes/mesh_io/seen_colors.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace fs = std::filesystem;

void save_scannet_ply(const Scene& scene, const fs::path& file, float max_edge_m) {
  validate(scene);
  const Scene parted = split_for_colors(scene, max_edge_m);
  write_atomically(file, ply_bytes({.positions_m = parted.positions_m,
                                    .colors = seen_colors(parted),
                                    .labels = {},
                                    .triangles = parted.triangles}));
  save_labels(parted, labels_path(file));
}

}  // namespace mh
