// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/labels_file.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/ply.hpp"
#include "scenes/mesh_io/seen_colours.hpp"
#include "scenes/mesh_io/subdivide.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace fs = std::filesystem;

void save_scannet_ply(const Scene& scene, const fs::path& file, float max_edge_m) {
  validate(scene);
  if (max_edge_m > 0.0F) {
    save_scannet_ply(subdivide(scene, max_edge_m), file, 0.0F);
    return;
  }
  write_atomically(file, ply_bytes({.positions_m = scene.positions_m,
                                    .colours = seen_colours(scene),
                                    .labels = {},
                                    .triangles = scene.triangles}));
  save_labels(scene, labels_path(file));
}

}  // namespace mh
