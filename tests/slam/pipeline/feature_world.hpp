// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/features.hpp"

namespace mh::testing_support {

/// Rooms in an endless row along x, connected by doors; points on their walls have their own
/// descriptors. A camera's view of them is made directly as features, without an image, so that
/// maps of any size are cheap. Points are hidden by walls, are not always found, and are seen at
/// the octave that fits their distance, with the position noise of a corner and some bits of the
/// descriptor flipped.
class FeatureWorld {
 public:
  static constexpr double kLength_m = 5, kWidth_m = 4, kHeight_m = 2.6;  // of a room
  static constexpr double kDoor_m =
      1.0;  // width of the doors, in the middle of the walls perpendicular to x

  explicit FeatureWorld(int points_per_room, int features_per_frame)
      : points_per_room_(points_per_room), features_(features_per_frame) {}

  static Camera camera() { return {}; }

  /// A camera in the middle of the row at x, 1.3 m high, level, looking along the heading (rad, 0 =
  /// +x).
  static SE3 pose(double x_m, double heading_rad) {
    Eigen::Matrix3d optical;  // columns: camera x (right), y (down), z (forward) in the world
    optical.col(0) = Eigen::Vector3d(std::sin(heading_rad), -std::cos(heading_rad), 0);
    optical.col(1) = Eigen::Vector3d(0, 0, -1);
    optical.col(2) = Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0);
    return {optical, {x_m, kWidth_m / 2, 1.3}};
  }

  /// A walk through the rooms [first, first + rooms) with a full turn in each, and back to where it
  /// began. If `rooms` is negative, the walk leads toward -x.
  static std::vector<SE3> there_and_back(int first, int rooms) {
    constexpr int kSteps = 150, kTurn = 150;  // frames per room and per full turn
    const double side = rooms < 0 ? -1 : 1;
    const double heading = rooms < 0 ? std::numbers::pi : 0;
    const double start = kLength_m * (first + 0.5);
    std::vector<SE3> path;
    const auto turn = [&](double x, double from, double by, int frames) {
      for (int i = 0; i < frames; ++i) path.push_back(pose(x, from + by * i / frames));
    };
    const auto walk = [&](double from, double to, double facing) {
      for (int i = 0; i < kSteps; ++i)
        path.push_back(pose(from + (to - from) * i / kSteps, facing));
    };
    const int count = std::abs(rooms);
    for (int r = 0; r < count; ++r) {
      const double x = start + side * kLength_m * r;
      turn(x, heading, 2 * std::numbers::pi, kTurn);
      if (r + 1 < count) walk(x, x + side * kLength_m, heading);
    }
    turn(start + side * kLength_m * (count - 1), heading, std::numbers::pi, kTurn / 2);
    for (int r = count - 1; r > 0; --r) {
      const double x = start + side * kLength_m * r;
      walk(x, x - side * kLength_m, heading + std::numbers::pi);
    }
    turn(start, heading + std::numbers::pi, std::numbers::pi, kTurn / 2);
    return path;
  }

  /// The features that a camera sees; equal noise gives equal features.
  Features see(const SE3& world_from_camera, RandomStream noise) const {
    const SE3 camera_from_world = world_from_camera.inverse();
    const int room = room_of(world_from_camera.translation().x());
    std::vector<Candidate> seen;
    for (int r = room - 2; r <= room + 2; ++r)
      for (int i = 0; i < points_per_room_; ++i)
        if (auto candidate = look(r, i, world_from_camera, camera_from_world, noise))
          seen.push_back(*candidate);
    const auto stronger = [](const Candidate& a, const Candidate& b) {
      return a.strength != b.strength ? a.strength > b.strength : a.name < b.name;
    };
    std::sort(seen.begin(), seen.end(), stronger);
    if (seen.size() > static_cast<std::size_t>(features_))
      seen.resize(static_cast<std::size_t>(features_));
    std::stable_sort(seen.begin(), seen.end(), [](const Candidate& a, const Candidate& b) {
      return a.keypoint.octave < b.keypoint.octave;
    });
    Features features;
    for (const Candidate& c : seen) {
      features.keypoints.push_back(c.keypoint);
      features.descriptors.push_back(c.descriptor);
    }
    return features;
  }

 private:
  struct Candidate {
    std::uint64_t strength, name;
    Keypoint keypoint;
    Descriptor descriptor;
  };

  static int room_of(double x_m) { return static_cast<int>(std::floor(x_m / kLength_m)); }

  /// Whether the line to a point in a different room passes through every door in between.
  static bool in_sight(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int room, int of) {
    for (int r = std::min(room, of) + 1; r <= std::max(room, of); ++r) {
      const double share = (kLength_m * r - from.x()) / (to.x() - from.x());
      const Eigen::Vector3d crossing = from + share * (to - from);
      if (std::abs(crossing.y() - kWidth_m / 2) > kDoor_m / 2 || crossing.z() > 2.1) return false;
    }
    return true;
  }

  std::optional<Candidate> look(int room, int index, const SE3& world_from_camera,
                                const SE3& camera_from_world, RandomStream noise) const {
    const Camera c = camera();
    const RandomStream point = RandomStream(1)
                                   .fork(static_cast<std::uint64_t>(room + 1000000))
                                   .fork(static_cast<std::uint64_t>(index));
    // On one of four walls; 10 cm from those perpendicular to x, so that it belongs to one room.
    const auto wall = point.below(0, 4);
    const double along = point.uniform(1), z = point.uniform(2, 0, kHeight_m);
    Eigen::Vector3d p(0, 0, z);
    if (wall < 2) {
      p.x() = kLength_m * room + (wall == 0 ? 0.1 : kLength_m - 0.1);
      p.y() = kWidth_m * along;
      if (std::abs(p.y() - kWidth_m / 2) < kDoor_m / 2 && z < 2.1) return std::nullopt;  // a door
    } else {
      p.x() = kLength_m * room + 0.1 + (kLength_m - 0.2) * along;
      p.y() = wall == 2 ? 0 : kWidth_m;
    }
    const Eigen::Vector3d in_camera = camera_from_world * p;
    if (in_camera.z() < 0.4 || in_camera.z() > 8) return std::nullopt;
    const Eigen::Vector2d pixel = c.project(in_camera);
    if (!c.in_image(pixel.x(), pixel.y())) return std::nullopt;
    const double distance = in_camera.norm();
    const auto octave =
        static_cast<int>(std::lround(std::log(point.uniform(3, 2, 10) / distance) / std::log(1.2)));
    if (octave < 0 || octave > 7) return std::nullopt;
    const Eigen::Vector3d& eye = world_from_camera.translation();
    if (!in_sight(eye, p, room_of(eye.x()), room)) return std::nullopt;
    const std::uint64_t name = point.key();
    const RandomStream now = noise.fork(name);
    if (now.uniform(0) < 0.15) return std::nullopt;  // not found in this frame

    Candidate candidate{point.bits(4), name, {}, {}};
    const double sigma_px = 0.3 * std::pow(1.2, octave);
    const double z_m = in_camera.z();
    candidate.keypoint = {.u_px = static_cast<float>(pixel.x() + sigma_px * now.normal(1)),
                          .v_px = static_cast<float>(pixel.y() + sigma_px * now.normal(2)),
                          .depth_m = static_cast<float>(z_m + 0.0019 * z_m * z_m * now.normal(3)),
                          .angle_rad = static_cast<float>(point.uniform(5, 0, 6.28)),
                          .octave = octave,
                          .label = static_cast<ClassId>(1 + point.below(6, 12))};
    for (std::uint64_t k = 0; k < 4; ++k) {
      // Each bit is wrong with a probability of 1/16.
      const std::uint64_t wrong =
          now.bits(10 + 4 * k) & now.bits(11 + 4 * k) & now.bits(12 + 4 * k) & now.bits(13 + 4 * k);
      candidate.descriptor[k] = point.bits(10 + k) ^ wrong;
    }
    return candidate;
  }

  int points_per_room_, features_;
};

}  // namespace mh::testing_support
