// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/gaze.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "sim/motion/signal.hpp"
#include "slam/core/angles.hpp"

namespace mh::handheld {
namespace {

using Eigen::Vector2d;

constexpr double kAhead_s = 1.5;  // targets are chosen for the position this much later
constexpr double kFastTurn_rad = 60 * kDegree;  // a fast turn goes at least this far

/// Weight of a view that ends at this distance: a view that ends nearby shows little, so the weight
/// falls with the square of the distance below 1.5 m.
double room_before(double d_m) {
  return std::min(1.0, d_m * d_m / (1.5 * 1.5));
}

/// How well something can be scanned from that distance: guides to handheld scanning of rooms
/// recommend 1.5 to 3 m (CubiCasa, "Best scanning practices").
double from_here(double d_m) {
  return room_before(d_m) * std::clamp((6.0 - d_m) / 3.0, 0.15, 1.0);
}

/// Chooses where to look next as a person scanning a room does: at furniture rather than at bare
/// walls, from a good distance, at what was seen least, sweeping over things on the way there.
class Gaze {
 public:
  Gaze(const Scene& scene, const Ground& ground, const Camera& camera, double height_m,
       RandomStream stream)
      : ground_(ground),
        half_view_rays_(static_cast<int>(
            std::lround(std::atan(0.5 * camera.width_px / camera.fx_px) / kRayStep_rad))),
        height_m_(height_m),
        stream_(stream) {
    for (const Instance& instance : scene.instances) {
      looks_.resize(std::max<std::size_t>(looks_.size(), instance.id + 1U));
      looks_[instance.id] = {instance.max_m.z(), is_bare(instance.class_id)};
    }
  }

  struct Target {
    double yaw_rad, pitch_rad;  ///< unwrapped over full turns; pitch positive downward
  };
  /// @param least_rad  smallest turn
  Target next(const Vector2d& from_m, double yaw_rad, double least_rad = 0) {
    std::array<std::vector<Sight>, kRays> rays;
    std::array<double, kRays> worth_of_ray{};
    for (int i = 0; i < kRays; ++i) {
      rays[index(i)] = sights(from_m, yaw_rad + i * kRayStep_rad);
      worth_of_ray[index(i)] = worth(rays[index(i)]);
    }
    std::array<double, kRays> worth_of_view{};
    for (int i = 0; i < kRays; ++i)
      for (int k = -half_view_rays_; k <= half_view_rays_; ++k)
        worth_of_view[index(i)] += worth_of_ray[index(i + k)];
    // Relative to the best view: even when nearly everything has been seen, the person looks at the
    // rest.
    const double most = std::max(1e-9, std::ranges::max(worth_of_view));

    double best_worth = -1e9;
    int best = 0;
    for (const int side : {1, -1}) {
      double passed = 0;
      for (int i = 0; i <= kRays / 2; ++i) {
        const double here = worth_of_view[index(side * i)] / most;
        passed += here;
        if (i % 2 != 0 || i * kRayStep_rad < least_rad) continue;
        const double worth = 0.5 * here + 0.5 * passed / (i + 1) - kTurnCost * i * kRayStep_rad +
                             0.1 * stream_.normal(count_++);
        if (worth <= best_worth) continue;
        best_worth = worth;
        best = side * i;
      }
    }
    const double pitch_rad = pitch_to(rays, best);
    for (int i = std::min(0, best) - half_view_rays_; i <= std::max(0, best) + half_view_rays_; ++i)
      for (const Sight& sight : rays[index(i)]) ++seen_[sight.bin];
    return {yaw_rad + best * kRayStep_rad, pitch_rad};
  }

 private:
  static constexpr int kRays = 48;
  static constexpr double kRayStep_rad = 2 * M_PI / kRays;
  static constexpr double kTurnCost = 0.1;   // worth that a turn loses per radian
  static constexpr double kBareWorth = 0.3;  // worth of a bare surface relative to furniture
  static constexpr double kFarthest_m = 8.0;
  using Bin = std::pair<long, long>;  ///< a 0.3 m square of the seen area
  struct Look {
    double top_m = 0;
    bool bare = false;
  };
  struct Sight {
    Bin bin;
    double d_m;
    InstanceId id;
  };

  static std::size_t index(int ray) {
    return static_cast<std::size_t>((ray % kRays + kRays) % kRays);
  }
  static bool is_bare(ClassId id) {
    static const std::array bare = {class_by_name("wall"), class_by_name("floor"),
                                    class_by_name("ceiling")};
    return std::ranges::find(bare, id) != bare.end();
  }
  Look look_of(InstanceId id) const { return id < looks_.size() ? looks_[id] : Look{}; }

  /// Returns the things in a direction, nearest first; the last is where the eye-level view ends.
  std::vector<Sight> sights(const Vector2d& from_m, double yaw_rad) const {
    const FloorGrid &low = ground_.floor, &eyes = ground_.eyes;
    const Vector2d step = eyes.resolution_m * Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
    std::vector<Sight> found;
    Vector2d p = from_m + 2 * step;
    InstanceId before = 0;
    for (double d_m = 2 * eyes.resolution_m;; d_m += eyes.resolution_m, p += step) {
      const Bin bin{std::lround(p.x() / 0.3), std::lround(p.y() / 0.3)};
      const auto cell = eyes.cell_of(p);
      const InstanceId end = cell ? eyes.occupant(cell->first, cell->second) : InstanceId{0};
      if (!cell || end != 0 || d_m > kFarthest_m) {
        found.push_back({bin, d_m, end});
        return found;
      }
      const auto under = low.cell_of(p);
      const InstanceId thing = under ? low.occupant(under->first, under->second) : InstanceId{0};
      if (thing == 0 || thing == before) continue;
      found.push_back({bin, d_m, thing});
      before = thing;
    }
  }
  double worth(const Sight& sight) const {
    const auto seen = seen_.find(sight.bin);
    return (look_of(sight.id).bare || sight.id == 0 ? kBareWorth : 1.0) * from_here(sight.d_m) /
           (1.0 + (seen == seen_.end() ? 0 : seen->second));
  }
  /// Worth of a direction: near 0 if the view at eye level ends nearby, whatever is below that.
  double worth(const std::vector<Sight>& ray) const {
    double sum = 0;
    for (const Sight& sight : ray) sum += worth(sight);
    return std::min(1.0, sum) * room_before(ray.back().d_m);
  }
  /// Pitches down at the most valuable thing near the center of the view.
  double pitch_to(const std::array<std::vector<Sight>, kRays>& rays, int middle) {
    const Sight* best = &rays[index(middle)].back();
    double best_worth = 0;
    for (int k = -1; k <= 1; ++k)
      for (const Sight& sight : rays[index(middle + k)])
        if (const double w = worth(sight); w > best_worth) {
          best_worth = w;
          best = &sight;
        }
    const Look look = look_of(best->id);
    const double top_m =
        look.bare || best->id == 0 ? height_m_ : std::min(look.top_m, height_m_ + 0.05);
    const double z_m = stream_.uniform(count_++) * std::max(0.0, top_m);
    return std::clamp(std::atan2(height_m_ - z_m, std::max(0.8, best->d_m)), -5 * kDegree,
                      40 * kDegree);
  }

  const Ground& ground_;
  int half_view_rays_;
  double height_m_;
  RandomStream stream_;
  std::uint64_t count_ = 0;
  std::vector<Look> looks_;  ///< by instance id
  std::map<Bin, int> seen_;
};

/// Completed share of a minimum-jerk movement (Flash and Hogan, J. Neurosci. 5, 1985); its speed
/// peaks at 15/8 of the mean.
double minimum_jerk(double t) {
  return t * t * t * (10 + t * (6 * t - 15));
}
constexpr double kPeakOverMean = 15.0 / 8;

}  // namespace

Looks looks_along(const Scene& scene, const std::vector<Vector2d>& feet_m, const Ground& ground,
                  const Camera& camera, const HandheldConfig& config, RandomStream stream) {
  Gaze gaze(scene, ground, camera, config.height_m, stream.fork(0));
  const auto ahead = static_cast<std::size_t>(std::lround(kAhead_s * camera.rate_hz));
  const RandomStream draw = stream.fork(1);
  Looks looks;
  double yaw_rad = draw.uniform(0, -M_PI, M_PI), pitch_rad = 15 * kDegree;
  yaw_rad = gaze.next(feet_m.front(), yaw_rad).yaw_rad;
  for (std::uint64_t turn = 1; looks.yaw_rad.size() < feet_m.size(); ++turn) {
    const bool fast = config.fast_turn_every > 0 &&
                      turn % static_cast<std::uint64_t>(config.fast_turn_every) == 0;
    const std::size_t then = std::min(looks.yaw_rad.size() + ahead, feet_m.size() - 1);
    const Gaze::Target target = gaze.next(feet_m[then], yaw_rad, fast ? kFastTurn_rad : 0.0);
    const double peak_rad_per_s =
        fast ? draw.uniform(4 * turn, 1.2, 2.1)
             : config.turning_rad_per_s * std::exp(0.3 * draw.normal(4 * turn));
    const double angle_rad = std::hypot(target.yaw_rad - yaw_rad, target.pitch_rad - pitch_rad);
    const double turn_s = std::max(0.5, kPeakOverMean * angle_rad / peak_rad_per_s);
    const double rest_s = draw.uniform(4 * turn + 1, 0.0, 0.5);
    const auto frames = std::max(2L, std::lround(turn_s * camera.rate_hz));
    for (long k = 1; k <= frames; ++k) {
      const double done = minimum_jerk(static_cast<double>(k) / static_cast<double>(frames));
      looks.yaw_rad.push_back(yaw_rad + done * (target.yaw_rad - yaw_rad));
      looks.pitch_rad.push_back(pitch_rad + done * (target.pitch_rad - pitch_rad));
    }
    yaw_rad = target.yaw_rad;
    pitch_rad = target.pitch_rad;
    const auto rest = static_cast<std::size_t>(std::lround(rest_s * camera.rate_hz));
    looks.yaw_rad.insert(looks.yaw_rad.end(), rest, yaw_rad);
    looks.pitch_rad.insert(looks.pitch_rad.end(), rest, pitch_rad);
  }
  looks.yaw_rad.resize(feet_m.size());
  looks.pitch_rad.resize(feet_m.size());
  // A turn starts and ends smoothly even if the next one follows at once.
  looks.yaw_rad = smoothed(looks.yaw_rad, 0.06 * camera.rate_hz);
  looks.pitch_rad = smoothed(looks.pitch_rad, 0.06 * camera.rate_hz);
  return looks;
}

}  // namespace mh::handheld
