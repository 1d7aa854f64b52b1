// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace mh {

struct PathConfig {
  /// An arc starts and ends at most this far from its corner, m; so the arc of a right angle has
  /// this radius and passes the corner at 0.41 times this distance.
  double cut_m = 0.45;
  /// The curvature grows and shrinks smoothly along a bend instead of jumping at its ends, as
  /// required by a base that turns only along its path. An eased bend lies between the corner and
  /// the arc that it replaces.
  bool eased = false;
};

struct PathPoint {
  Eigen::Vector2d position_m;
  Eigen::Vector2d direction;   ///< unit tangent
  double curvature_per_m = 0;  ///< positive to the left
};

/// A planar curve along given corners: straight lines joined by tangent arcs or eased bends. Starts
/// and ends exactly at the first and last corner.
class RoundedPath {
 public:
  /// @param corners_m  at least two, each distinct from the next; no corner reverses direction.
  RoundedPath(std::span<const Eigen::Vector2d> corners_m, const PathConfig& config = {});

  double length_m() const { return length_m_; }
  /// The point at arc length s; beyond either end the path continues straight.
  PathPoint at(double s_m) const;
  /// The largest curvature of an arc or bend, without its sign; 0 on straight lines and beyond the
  /// ends.
  struct Bend {
    double curvature_per_m = 0;
    double change_per_m2 = 0, second_change_per_m3 = 0;  ///< derivatives of the curvature
  };
  Bend bend_at(double s_m) const;
  /// Arc length of the point that represents corner i (the middle of its arc).
  double corner_s_m(std::size_t i) const { return corner_s_m_[i]; }

 private:
  struct Piece {
    double start_s_m;
    Eigen::Vector2d start_m;
    double heading_rad;
    double curvature_per_m = 0;              // of an arc
    double bend_rad = 0, bend_length_m = 0;  // of an eased bend
  };
  static PathPoint on_bend(const Piece& piece, double ds_m);
  const Piece& piece_at(double s_m) const;
  std::vector<Piece> pieces_;
  std::vector<double> corner_s_m_;
  double length_m_ = 0;
};

struct SpeedLimits {
  double velocity_m_per_s = 0;
  double along_m_per_s2 = 0;   ///< speeding up and slowing down
  double across_m_per_s2 = 0;  ///< v^2 * curvature
  /// Highest speed through an arc or bend, m/s; null: only the limits above apply.
  std::function<double(const RoundedPath::Bend&)> through = {};
};

/// The highest speed at each arc length, from rest at the start of the path to rest at its end,
/// within the limits on every arc.
class SpeedProfile {
 public:
  SpeedProfile(const RoundedPath& path, const SpeedLimits& limits);
  double at(double s_m) const;  ///< m/s
  double duration_s() const { return time_s_.back(); }
  /// Arc length reached at a time; constant once the end is reached.
  double s_at(double time_s) const;

 private:
  double spacing_m_ = 0;
  // At samples spacing_m_ apart: v^2, which changes linearly under constant acceleration, and the
  // time.
  std::vector<double> squared_, time_s_;
};

}  // namespace mh
