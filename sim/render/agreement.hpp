// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sim/render/renderer.hpp"

namespace mh {

/// How far two renderers' pictures of the same scene agree, in counts over all pixels compared.
struct Agreement {
  std::int64_t pixels = 0;
  std::int64_t same_class = 0, same_instance = 0;
  /// Pixels of another instance at the same depth (to 1e-5 of it): two objects that share a plane,
  /// where either answer is right.
  std::int64_t ties = 0;
  std::int64_t same_color = 0;   ///< every channel within two gray levels
  std::int64_t smooth = 0;       ///< pixels outside silhouettes, see below
  double square_depth_m2 = 0.0;  ///< summed squares of depth differences over those

  double class_share() const { return share(same_class); }
  double instance_share() const { return share(same_instance); }
  double tie_share() const { return share(ties); }
  double color_share() const { return share(same_color); }
  /// Root mean square of the depth differences outside silhouettes, m.
  double depth_rmse_m() const;

  /// Adds what two pictures of the same size show. A pixel is of a silhouette where in either
  /// picture the instance or, by more than 2 cm and 2 %, the depth differs from a neighbor's.
  void add(const RenderedFrame& a, const RenderedFrame& b);

 private:
  double share(std::int64_t count) const {
    return static_cast<double>(count) / static_cast<double>(pixels);
  }
};

}  // namespace mh
