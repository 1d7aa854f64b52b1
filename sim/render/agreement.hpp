// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sim/render/renderer.hpp"

namespace mh {

/// Agreement of two renderers' images of the same scene, in counts over all compared pixels.
struct Agreement {
  std::int64_t pixels = 0;
  std::int64_t same_class = 0, same_instance = 0;
  /// Pixels that show different instances at the same depth (relative difference up to 1e-5): two
  /// coplanar objects, where either answer is right.
  std::int64_t ties = 0;
  std::int64_t same_color = 0;   ///< every channel within two gray levels
  std::int64_t smooth = 0;       ///< pixels outside silhouettes, see add()
  double square_depth_m2 = 0.0;  ///< summed squared depth differences of those `smooth` pixels

  double class_share() const { return share(same_class); }
  double instance_share() const { return share(same_instance); }
  double tie_share() const { return share(ties); }
  double color_share() const { return share(same_color); }
  /// Root mean square of the depth differences outside silhouettes, m.
  double depth_rmse_m() const;

  /// Adds the comparison of two images of the same size. A pixel is part of a silhouette if in
  /// either image the instance or, by more than 2 cm and 2 %, the depth differs from a neighbor's.
  void add(const RenderedFrame& a, const RenderedFrame& b);

 private:
  double share(std::int64_t count) const {
    return static_cast<double>(count) / static_cast<double>(pixels);
  }
};

}  // namespace mh
