// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/feet.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "robots/navigation/plan.hpp"
#include "sim/motion/signal.hpp"
#include "slam/io/error.hpp"

namespace mh::handheld {
namespace {

using Eigen::Vector2d;

// Radius of the space that a person takes up, less in narrow places.
constexpr std::array kBody_m = {0.26, 0.20, 0.15, 0.11};
constexpr double kSmallestStanding_m2 = 0.25;
constexpr double kEyeBand_m = 0.12;  // anything this close to the camera's height blocks its view

/// The path of the feet: a closed round trip through places all over the floor, walked repeatedly.
class Way {
 public:
  /// @param enough_m  the round trip need not be longer than this
  Way(const Ground& ground, double enough_m, std::uint64_t seed) {
    // Places that are as far apart as possible come first, so that a shorter path uses fewer of
    // them.
    const std::vector<Vector2d> places = spread_places(ground.floor, ground.region, 0.7, 24, seed);
    const auto lengths_m = lengths_between(ground.floor, places, ground.clearance_m);
    std::size_t count = places.size();
    while (count > 3 && round_trip(lengths_m, count).length_m > enough_m) --count;
    corners_ = joined(ground, places, round_trip(lengths_m, count).order);
    for (std::size_t i = 0; i < corners_.size(); ++i)
      s_m_.push_back(i == 0 ? 0 : s_m_.back() + (corners_[i] - corners_[i - 1]).norm());
  }

  Vector2d at(double s_m) const {
    if (s_m_.back() <= 0) return corners_.front();
    const double around_m = std::fmod(s_m, 2 * s_m_.back());
    // Around and back in the opposite direction, so that everything is passed in both directions.
    const double here_m = around_m <= s_m_.back() ? around_m : 2 * s_m_.back() - around_m;
    const auto after = std::upper_bound(s_m_.begin() + 1, s_m_.end() - 1, here_m);
    const auto i = static_cast<std::size_t>(after - s_m_.begin());
    const double share = (here_m - s_m_[i - 1]) / std::max(1e-9, s_m_[i] - s_m_[i - 1]);
    return corners_[i - 1] + std::clamp(share, 0.0, 1.0) * (corners_[i] - corners_[i - 1]);
  }

 private:
  static std::vector<Vector2d> joined(const Ground& ground, const std::vector<Vector2d>& places,
                                      const std::vector<std::size_t>& order) {
    std::vector<Vector2d> corners{places[order.front()]};
    for (std::size_t i = 0; i < order.size() && order.size() > 1; ++i) {
      const auto way = plan_way(ground.floor, corners.back(), places[order[(i + 1) % order.size()]],
                                ground.clearance_m);
      if (way) corners.insert(corners.end(), way->begin() + 1, way->end());
    }
    return corners;
  }

  std::vector<Vector2d> corners_;
  std::vector<double> s_m_;
};

/// Speed of the feet in each frame: bouts of walking with pauses in between.
std::vector<double> walking_speed(const HandheldConfig& config, std::size_t frames, double rate_hz,
                                  RandomStream stream) {
  std::vector<double> speed;
  for (std::uint64_t bout = 0; speed.size() < frames; ++bout) {
    const bool pause = bout % 2 == 1;
    const double s =
        pause ? stream.uniform(3 * bout, 0.3, 1.2) : stream.uniform(3 * bout, 2.0, 6.0);
    const double v = config.walking_m_per_s * std::exp(0.35 * stream.normal(3 * bout + 1));
    speed.insert(speed.end(), static_cast<std::size_t>(std::lround(s * rate_hz)), pause ? 0.0 : v);
  }
  speed.resize(frames);
  return smoothed(speed, 0.25 * rate_hz);
}

}  // namespace

Ground ground_of(const Scene& scene, double height_m) {
  Ground ground;
  ground.floor = make_floor_grid(scene, {.top_m = kHead_m});
  ground.eyes =
      make_floor_grid(scene, {.bottom_m = height_m - kEyeBand_m, .top_m = height_m + kEyeBand_m});
  const double cell_m2 = ground.floor.resolution_m * ground.floor.resolution_m;
  for (const double clearance_m : kBody_m) {
    ground.region = largest_region(ground.floor, clearance_m);
    ground.area_m2 = static_cast<double>(std::ranges::count(ground.region, 1)) * cell_m2;
    ground.clearance_m = clearance_m;
    if (ground.area_m2 >= kSmallestStanding_m2) return ground;
  }
  throw InputError(
      fmt::format("{}: has no free floor that a person with a camera could walk on", scene.name));
}

Feet feet_on(const Ground& ground, const HandheldConfig& config, std::size_t frames, double rate_hz,
             RandomStream bouts, std::uint64_t places) {
  const std::vector<double> speed = walking_speed(config, frames, rate_hz, bouts);
  double way_m = 0;
  for (const double v : speed) way_m += v / rate_hz;
  const Way way(ground, way_m, places);
  std::vector<double> x, y;
  double s_m = 0;
  for (const double v : speed) {
    const Vector2d p = way.at(s_m);
    x.push_back(p.x());
    y.push_back(p.y());
    s_m += v / rate_hz;
  }
  x = smoothed(x, 0.35 * rate_hz);
  y = smoothed(y, 0.35 * rate_hz);
  Feet feet{.at_m = {}, .speed_m_per_s = speed};
  for (std::size_t i = 0; i < frames; ++i) feet.at_m.emplace_back(x[i], y[i]);
  return feet;
}

}  // namespace mh::handheld
