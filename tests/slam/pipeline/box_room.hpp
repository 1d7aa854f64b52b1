// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh::testing_support {

/// An empty 6 x 5 x 3 m room whose six sides are covered with random squares, seen by a perfect
/// camera: exact color, depth and labels in closed form, independent of the simulator. Each side
/// has two classes, in a checkerboard of 1 m.
class BoxRoom {
 public:
  static constexpr double kX_m = 6, kY_m = 5, kZ_m = 3;

  static Camera camera() {
    Camera c;
    c.width_px = 320;
    c.height_px = 240;
    c.fx_px = c.fy_px = 288;
    c.cx_px = 159.5;
    c.cy_px = 119.5;
    return c;
  }

  /// A camera at (x, y, 1.2 m) looking along the heading (rad), level.
  static SE3 pose(double x_m, double y_m, double heading_rad) {
    Eigen::Matrix3d optical;  // columns: camera x (right), y (down), z (forward) in the world
    optical.col(0) = Eigen::Vector3d(std::sin(heading_rad), -std::cos(heading_rad), 0);
    optical.col(1) = Eigen::Vector3d(0, 0, -1);
    optical.col(2) = Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0);
    return {optical, {x_m, y_m, 1.2}};
  }

  /// Pose i of a closed drive around the center of the room, looking outward; n frames per turn.
  static SE3 round_trip(int i, int n) {
    const double a = 2 * std::numbers::pi * i / n;
    return pose(3 + 0.8 * std::cos(a), 2.5 + 0.7 * std::sin(a), a);
  }

  static RgbdFrame render(const SE3& world_from_camera, Stamp stamp_ns, bool labels = true) {
    const Camera c = camera();
    RgbdFrame frame{stamp_ns,
                    Grid2d<Rgb8>(c.width_px, c.height_px),
                    Grid2d<float>(c.width_px, c.height_px),
                    {}};
    if (labels) {
      frame.semantics.index = Grid2d<std::uint8_t>(c.width_px, c.height_px);
      for (int i = 0; i < 13; ++i)
        frame.semantics.palette.push_back(ClassDistribution::one_hot(static_cast<ClassId>(i)));
    }
    const Eigen::Vector3d origin = world_from_camera.translation();
    const std::array<double, 3> size{kX_m, kY_m, kZ_m};
    for (int y = 0; y < c.height_px; ++y)
      for (int x = 0; x < c.width_px; ++x) {
        const Eigen::Vector3d ray = world_from_camera.rotation() * c.unproject(x, y, 1.0);
        double depth = 1e9;
        int side = 0;
        for (int axis = 0; axis < 3; ++axis) {
          if (ray[axis] == 0) continue;
          const bool far = ray[axis] > 0;
          const double t =
              ((far ? size[static_cast<std::size_t>(axis)] : 0.0) - origin[axis]) / ray[axis];
          if (t > 0 && t < depth) {
            depth = t;
            side = 2 * axis + far;
          }
        }
        const Eigen::Vector3d p = origin + depth * ray;
        const int axis = side / 2;
        const double u = p[(axis + 1) % 3], v = p[(axis + 2) % 3];
        const auto gray = static_cast<std::uint8_t>(texture(side, u, v));
        frame.color(x, y) = {gray, gray, gray};
        frame.depth_m(x, y) = static_cast<float>(depth);
        if (labels) {
          const int check = (static_cast<int>(std::floor(u)) + static_cast<int>(std::floor(v))) & 1;
          frame.semantics.index(x, y) = static_cast<std::uint8_t>(1 + 2 * side + check);
        }
      }
    return frame;
  }

 private:
  /// Gray value, 0 to 255: overlaid squares of 17 and 5 cm, all different, with edges blurred over
  /// 1 cm (about the size of a pixel).
  static double texture(int side, double u_m, double v_m) {
    return 0.6 * patches(side, u_m / 0.17, v_m / 0.17, 0.06) +
           0.4 * patches(side + 8, u_m / 0.05, v_m / 0.05, 0.2);
  }
  static double patches(int name, double u, double v, double edge) {
    const double fu = std::floor(u), fv = std::floor(v);
    const auto at = [&](double i, double j) {
      return static_cast<double>(mix(mix(static_cast<std::uint64_t>(name) * 7919 +
                                         static_cast<std::uint64_t>(static_cast<std::int64_t>(i))) ^
                                     static_cast<std::uint64_t>(static_cast<std::int64_t>(j))) >>
                                 56);
    };
    const auto blend = [&](double t) { return std::clamp((t - (1.0 - edge)) / edge, 0.0, 1.0); };
    const double a = blend(u - fu), b = blend(v - fv);
    return (1 - b) * ((1 - a) * at(fu, fv) + a * at(fu + 1, fv)) +
           b * ((1 - a) * at(fu, fv + 1) + a * at(fu + 1, fv + 1));
  }
};

}  // namespace mh::testing_support
