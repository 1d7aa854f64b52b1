// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/path.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Geometry>

namespace mh {
namespace {

Eigen::Vector2d unit(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

double heading_rad(const Eigen::Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

/// Share of the turn that is completed after a share u of the length of an eased bend: rises
/// smoothly from 0 to 1, flat at both ends.
double eased(double u) {
  return u * u * u * (10 + u * (6 * u - 15));
}

/// The integral of the tangent over the first `share` of an eased bend of unit length that begins
/// along x. Computed by Simpson's rule; with 32 intervals, the error is 2e-6 for bends of up to 120
/// degrees.
Eigen::Vector2d along_bend(double bend_rad, double share) {
  constexpr int kIntervals = 32;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i <= kIntervals; ++i) {
    const double weight = i == 0 || i == kIntervals ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * unit(bend_rad * eased(share * i / kIntervals));
  }
  return share * sum / (3 * kIntervals);
}

}  // namespace

RoundedPath::RoundedPath(std::span<const Eigen::Vector2d> corners_m, const PathConfig& config) {
  assert(corners_m.size() >= 2);
  const auto add = [this](const Eigen::Vector2d& start, double heading, double curvature,
                          double length, double bend = 0) {
    if (length <= 0) return;
    pieces_.push_back({length_m_, start, heading, curvature, bend, bend != 0 ? length : 0});
    length_m_ += length;
  };

  corner_s_m_.push_back(0);
  Eigen::Vector2d from = corners_m[0];
  for (std::size_t i = 1; i + 1 < corners_m.size(); ++i) {
    const Eigen::Vector2d in = corners_m[i] - corners_m[i - 1];
    const Eigen::Vector2d out = corners_m[i + 1] - corners_m[i];
    const double turn_rad = std::remainder(heading_rad(out) - heading_rad(in), 2 * M_PI);
    const double cut_m = std::min({config.cut_m, 0.5 * in.norm(), 0.5 * out.norm()});
    // An arc that leaves a corner's legs at distance `cut` has radius cut / tan(turn / 2).
    const double curvature = std::tan(0.5 * turn_rad) / cut_m;
    const bool straight = std::abs(turn_rad) < 1e-6;
    const double arc_m = straight ? 0.0 : turn_rad / curvature;
    const Eigen::Vector2d bow_start =
        straight ? corners_m[i] : corners_m[i] - cut_m * in.normalized();
    add(from, heading_rad(in), 0, (bow_start - from).norm());
    if (config.eased && !straight) {
      // By symmetry, the chord of the bend, from leg to leg, bisects the turn.
      const double chord_m = 2 * cut_m * std::cos(0.5 * turn_rad);
      const double bend_m = chord_m / along_bend(turn_rad, 1).norm();
      corner_s_m_.push_back(length_m_ + 0.5 * bend_m);
      add(bow_start, heading_rad(in), 0, bend_m, turn_rad);
    } else {
      corner_s_m_.push_back(length_m_ + 0.5 * arc_m);
      add(bow_start, heading_rad(in), curvature, arc_m);
    }
    from = straight ? corners_m[i] : corners_m[i] + cut_m * out.normalized();
  }
  const Eigen::Vector2d last = corners_m.back() - corners_m[corners_m.size() - 2];
  add(from, heading_rad(last), 0, (corners_m.back() - from).norm());
  corner_s_m_.push_back(length_m_);
  assert(!pieces_.empty());
}

PathPoint RoundedPath::on_bend(const Piece& piece, double ds_m) {
  const double length_m = piece.bend_length_m, u = ds_m / length_m;
  const Eigen::Vector2d moved =
      length_m * (Eigen::Rotation2Dd(piece.heading_rad) * along_bend(piece.bend_rad, u));
  const double per_m = piece.bend_rad / length_m;
  return {piece.start_m + moved, unit(piece.heading_rad + piece.bend_rad * eased(u)),
          per_m * 30 * u * u * (1 - u) * (1 - u)};
}

const RoundedPath::Piece& RoundedPath::piece_at(double s_m) const {
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), s_m,
                                      [](double s, const Piece& p) { return s < p.start_s_m; });
  return *(after - 1);
}

RoundedPath::Bend RoundedPath::bend_at(double s_m) const {
  if (!(s_m >= 0 && s_m <= length_m_)) return {};
  const Piece& piece = piece_at(s_m);
  if (piece.bend_rad == 0) return {.curvature_per_m = std::abs(piece.curvature_per_m)};
  // The largest curvature is at u = 1/2, the largest change at u = 1/2 - sqrt(3)/6, the largest
  // second change at the ends.
  const double per_m = std::abs(piece.bend_rad) / piece.bend_length_m;
  return {.curvature_per_m = 1.875 * per_m,
          .change_per_m2 = 10 / std::sqrt(3.0) * per_m / piece.bend_length_m,
          .second_change_per_m3 = 60 * per_m / (piece.bend_length_m * piece.bend_length_m)};
}

PathPoint RoundedPath::at(double s_m) const {
  const double inside_m = std::clamp(s_m, 0.0, length_m_);
  const Piece& piece = piece_at(inside_m);
  const double ds = inside_m - piece.start_s_m, k = piece.curvature_per_m;
  if (piece.bend_rad != 0) return on_bend(piece, ds);
  const double heading = piece.heading_rad + k * ds;
  // The integral of the tangent along a line or an arc.
  const Eigen::Vector2d moved =
      k == 0 ? Eigen::Vector2d(ds * unit(heading))
             : Eigen::Vector2d((unit(heading - M_PI_2) - unit(piece.heading_rad - M_PI_2)) / k);
  return {piece.start_m + moved + (s_m - inside_m) * unit(heading), unit(heading),
          inside_m == s_m ? k : 0.0};
}

SpeedProfile::SpeedProfile(const RoundedPath& path, const SpeedLimits& limits) {
  constexpr double kSpacing_m = 0.01;  // well below the shortest arc
  const auto intervals = static_cast<std::size_t>(std::ceil(path.length_m() / kSpacing_m)) + 1;
  spacing_m_ = path.length_m() / static_cast<double>(intervals);
  squared_.assign(intervals + 1, 0.0);  // at rest at the end
  for (std::size_t i = intervals; i-- > 0;) {
    // An arc that starts or ends within an interval limits the speed at both ends of the interval.
    RoundedPath::Bend most;
    for (const double beside : {-1.0, 0.0, 1.0}) {
      const RoundedPath::Bend bend = path.bend_at(spacing_m_ * (static_cast<double>(i) + beside));
      if (bend.curvature_per_m > most.curvature_per_m) most = bend;
    }
    const double to_brake = squared_[i + 1] + 2 * limits.along_m_per_s2 * spacing_m_;
    double to_turn = limits.across_m_per_s2 / std::max(most.curvature_per_m, 1e-9);
    if (limits.through && most.curvature_per_m > 0)
      to_turn = std::min(to_turn, std::pow(limits.through(most), 2));
    squared_[i] = std::min({limits.velocity_m_per_s * limits.velocity_m_per_s, to_turn, to_brake});
  }
  squared_[0] = 0;
  time_s_.push_back(0);
  for (std::size_t i = 0; i < intervals; ++i) {
    squared_[i + 1] =
        std::min(squared_[i + 1], squared_[i] + 2 * limits.along_m_per_s2 * spacing_m_);
    time_s_.push_back(time_s_.back() +
                      2 * spacing_m_ / (std::sqrt(squared_[i]) + std::sqrt(squared_[i + 1])));
  }
}

double SpeedProfile::s_at(double time_s) const {
  const auto after = std::upper_bound(time_s_.begin() + 1, time_s_.end() - 1, time_s);
  const auto i = static_cast<std::size_t>(after - time_s_.begin()) - 1;
  const double within_s = std::clamp(time_s, time_s_[i], time_s_[i + 1]) - time_s_[i];
  const double acceleration = (squared_[i + 1] - squared_[i]) / (2 * spacing_m_);
  return spacing_m_ * static_cast<double>(i) +
         within_s * (std::sqrt(squared_[i]) + 0.5 * acceleration * within_s);
}

double SpeedProfile::at(double s_m) const {
  const double place = std::clamp(s_m / spacing_m_, 0.0, static_cast<double>(squared_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), squared_.size() - 2);
  const double share = place - static_cast<double>(i);
  return std::sqrt((1 - share) * squared_[i] + share * squared_[i + 1]);
}

}  // namespace mh
