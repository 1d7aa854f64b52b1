// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/by_hand.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "robots/navigation/plan.hpp"
#include "slam/core/error.hpp"
#include "slam/core/random.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Room that a person takes, narrower where a place has none.
constexpr std::array kBody_m = {0.26, 0.20, 0.15, 0.11};
constexpr double kHead_m = 1.9;            // what hangs higher is in nobody's way
constexpr double kSmallestWalk_m2 = 0.25;  // of free floor
constexpr double kEyeBand_m = 0.12;  // what stands this near the camera's height ends its view
constexpr double kDeg = M_PI / 180.0;
constexpr double kAhead_s = 1.5;  // one looks from where one will be when the turn is done
constexpr double kFastTurn_rad = 60 * kDeg;  // who looks round fast looks elsewhere

enum Stream : std::uint64_t { kPlaces, kBouts, kGaze, kRoll, kHeight, kBody, kHands, kTremor };

/// A signal of given root mean square whose power lies evenly in a band: 16 sines of seeded
/// frequency and phase.
class BandNoise {
 public:
  BandNoise(RandomStream stream, double rms, double low_hz, double high_hz) {
    for (std::size_t i = 0; i < sines_.size(); ++i) {
      const double share = (static_cast<double>(i) + stream.uniform(2 * i)) / sines_.size();
      sines_[i] = {2 * M_PI * (low_hz + share * (high_hz - low_hz)),
                   2 * M_PI * stream.uniform(2 * i + 1)};
    }
    amplitude_ = rms * std::sqrt(2.0 / sines_.size());
  }
  double at(double t_s) const {
    double sum = 0;
    for (const auto& [rate, phase] : sines_) sum += std::sin(rate * t_s + phase);
    return amplitude_ * sum;
  }

 private:
  std::array<std::pair<double, double>, 16> sines_;
  double amplitude_ = 0;
};

/// Mean over a Gaussian window; the ends are held.
std::vector<double> smoothed(const std::vector<double>& values, double sigma_frames) {
  const auto n = static_cast<int>(values.size());
  const int reach = static_cast<int>(std::ceil(3 * sigma_frames));
  std::vector<double> weight;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    weight.push_back(std::exp(-0.5 * k * k / (sigma_frames * sigma_frames)));
    sum += weight.back();
  }
  std::vector<double> result(values.size());
  for (int i = 0; i < n; ++i) {
    double mean = 0;
    for (int k = -reach; k <= reach; ++k)
      mean += weight[static_cast<std::size_t>(k + reach)] *
              values[static_cast<std::size_t>(std::clamp(i + k, 0, n - 1))];
    result[static_cast<std::size_t>(i)] = mean / sum;
  }
  return result;
}

/// Where a person can walk, with as much room as the place allows.
struct Ground {
  FloorGrid floor;  ///< between foot and head
  FloorGrid eyes;   ///< at the camera's height: what ends the view
  Grid2d<std::uint8_t> region;
  double clearance_m = 0;
  double area_m2 = 0;
};

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
    if (ground.area_m2 >= kSmallestWalk_m2) return ground;
  }
  throw InputError(
      fmt::format("{}: has no free floor that a person with a camera could walk on", scene.name));
}

/// The way of the feet: a closed round through places all over the floor, walked again and again.
class Way {
 public:
  /// @param enough_m  the round need not be longer than this
  Way(const Ground& ground, double enough_m, std::uint64_t seed) {
    // Places as far apart as can be come first, so that a shorter way takes fewer of them.
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
    // Round and back again the other way, so that everything is passed in both directions.
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

/// How fast the feet go in each frame: bouts of walking, pauses between them.
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

/// A view that ends nearer than this shows little, by the square of what is left.
double room_before(double d_m) {
  return std::min(1.0, d_m * d_m / (1.5 * 1.5));
}

/// How well something can be scanned from that far: guides for scanning rooms by hand say 1.5 to
/// 3 m (CubiCasa, "Best scanning practices").
double from_here(double d_m) {
  return room_before(d_m) * std::clamp((6.0 - d_m) / 3.0, 0.15, 1.0);
}

/// Chooses where to look next as somebody does who scans a room: at furniture rather than at bare
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
    double yaw_rad, pitch_rad;  ///< counted on over whole rounds; pitch positive downwards
  };
  /// @param least_rad  turns by this at least
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
    // Beside the best there is: however much was seen, one looks at the rest.
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
  static constexpr double kTurnCost = 0.1;   // per radian
  static constexpr double kBareWorth = 0.3;  // of a wall beside furniture
  static constexpr double kFarthest_m = 8.0;
  using Bin = std::pair<long, long>;  ///< a square of 0.3 m of what is seen
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

  /// What stands in a direction, up to what ends the view at eye level, which comes last.
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
  /// Nothing if the view ends at once, whatever stands below.
  double worth(const std::vector<Sight>& ray) const {
    double sum = 0;
    for (const Sight& sight : ray) sum += worth(sight);
    return std::min(1.0, sum) * room_before(ray.back().d_m);
  }
  /// Down at the thing most worth it near the middle of the view.
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
    return std::clamp(std::atan2(height_m_ - z_m, std::max(0.8, best->d_m)), -5 * kDeg, 40 * kDeg);
  }

  const Ground& ground_;
  int half_view_rays_;
  double height_m_;
  RandomStream stream_;
  std::uint64_t count_ = 0;
  std::vector<Look> looks_;  ///< by instance id
  std::map<Bin, int> seen_;
};

/// Share of a minimum-jerk movement that is done (Flash and Hogan, J. Neurosci. 5, 1985); its speed
/// peaks at 15/8 of the mean.
double minimum_jerk(double t) {
  return t * t * t * (10 + t * (6 * t - 15));
}
constexpr double kPeakOverMean = 15.0 / 8;

/// Where the camera looks in each frame.
struct Looks {
  std::vector<double> yaw_rad, pitch_rad;
};

Looks looks_along(const Scene& scene, const std::vector<Vector2d>& feet_m, const Ground& ground,
                  const Camera& camera, const HandheldConfig& config, RandomStream stream) {
  Gaze gaze(scene, ground, camera, config.height_m, stream.fork(0));
  const auto ahead = static_cast<std::size_t>(std::lround(kAhead_s * camera.rate_hz));
  const RandomStream draw = stream.fork(1);
  Looks looks;
  double yaw_rad = draw.uniform(0, -M_PI, M_PI), pitch_rad = 15 * kDeg;
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
  // A turn begins and ends softly also where the next one follows at once.
  looks.yaw_rad = smoothed(looks.yaw_rad, 0.06 * camera.rate_hz);
  looks.pitch_rad = smoothed(looks.pitch_rad, 0.06 * camera.rate_hz);
  return looks;
}

/// The optical frame (z forward, x right, y down) of a camera that looks along yaw (from world x),
/// pitched down, rolled clockwise.
Eigen::Matrix3d looking(double yaw_rad, double pitch_rad, double roll_rad) {
  Eigen::Matrix3d body_from_optical;
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return (Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) *
          Eigen::AngleAxisd(pitch_rad, Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_rad, Vector3d::UnitX()))
             .toRotationMatrix() *
         body_from_optical;
}

std::size_t frames_for(double area_m2, double rate_hz) {
  const double s = std::clamp(10.0 + 1.3 * area_m2, 10.0, 50.0);  // 300 to 1,500 at 30 Hz
  return static_cast<std::size_t>(std::lround(s * rate_hz));
}

}  // namespace

void validate(const HandheldConfig& config) {
  const auto check = [](const char* field, double value, double low, double high) {
    if (!(value >= low && value <= high))
      throw InputError(
          fmt::format("hand-held motion: {}: {} is outside {} to {}", field, value, low, high));
  };
  if (config.frames) check("frames", static_cast<double>(*config.frames), 30, 1e5);
  check("height_m", config.height_m, 0.3, kHead_m);
  check("walking_m_per_s", config.walking_m_per_s, 0, 2);
  check("turning_rad_per_s", config.turning_rad_per_s, 0.05, 4);
  check("fast_turn_every", config.fast_turn_every, 0, 1e6);
  check("gait", config.gait, 0, 3);
  check("sway_rms_m", config.sway_rms_m, 0, 0.05);
  check("wander_rms_rad", config.wander_rms_rad, 0, 0.2);
  check("tremor_rms_m", config.tremor_rms_m, 0, 0.01);
  check("tremor_rms_rad", config.tremor_rms_rad, 0, 0.05);
}

DrivenPath scan_by_hand(const Scene& scene, const Camera& camera, const HandheldConfig& config) {
  validate(config);
  const RandomStream stream = RandomStream(config.seed).fork(0x68616e64);  // of this motion alone
  const Ground ground = ground_of(scene, config.height_m);
  const std::size_t frames = config.frames.value_or(frames_for(ground.area_m2, camera.rate_hz));

  const std::vector<double> speed =
      walking_speed(config, frames, camera.rate_hz, stream.fork(kBouts));
  double way_m = 0;
  for (const double v : speed) way_m += v / camera.rate_hz;
  const Way way(ground, way_m, stream.fork(kPlaces).key());
  std::vector<double> x, y;
  double s_m = 0;
  for (const double v : speed) {
    const Vector2d p = way.at(s_m);
    x.push_back(p.x());
    y.push_back(p.y());
    s_m += v / camera.rate_hz;
  }
  x = smoothed(x, 0.35 * camera.rate_hz);
  y = smoothed(y, 0.35 * camera.rate_hz);
  std::vector<Vector2d> feet_m;
  for (std::size_t i = 0; i < frames; ++i) feet_m.emplace_back(x[i], y[i]);
  const Looks looks = looks_along(scene, feet_m, ground, camera, config, stream.fork(kGaze));

  const BandNoise height(stream.fork(kHeight), 0.03, 0.05, 0.2);
  const BandNoise roll(stream.fork(kRoll), 1.5 * kDeg, 0.05, 0.4);
  std::vector<BandNoise> sway, wander, tremor, shake;
  for (std::uint64_t axis = 0; axis < 3; ++axis) {
    sway.emplace_back(stream.fork(kBody).fork(axis), config.sway_rms_m, 0.1, 0.9);
    wander.emplace_back(stream.fork(kHands).fork(axis), config.wander_rms_rad, 0.3, 2.0);
    tremor.emplace_back(stream.fork(kTremor).fork(axis), config.tremor_rms_m, 6.0, 12.0);
    shake.emplace_back(stream.fork(kTremor).fork(3 + axis), config.tremor_rms_rad, 6.0, 12.0);
  }

  DrivenPath path;
  double stride_rad = 0;  // two steps are one stride
  for (std::size_t i = 0; i < frames; ++i) {
    const double t_s = static_cast<double>(i) / camera.rate_hz;
    // 0.7 strides a second at 0.7 m/s, and as the root of the speed (Grieve and Gear, 1966).
    stride_rad += 2 * M_PI * 0.7 * std::sqrt(speed[i] / 0.7) / camera.rate_hz;
    const double share = config.gait * speed[i] / 0.7;
    const Vector2d ahead = feet_m[std::min(i + 1, frames - 1)] - feet_m[i == 0 ? 0 : i - 1];
    const Vector2d way_ahead =
        ahead.norm() > 1e-9 ? Vector2d(ahead.normalized()) : Vector2d(1.0, 0.0);
    const Vector2d aside(-way_ahead.y(), way_ahead.x());
    Vector3d position(feet_m[i].x(), feet_m[i].y(), config.height_m + height.at(t_s));
    position.head<2>() += 0.5 * 0.0699 * share * std::sin(stride_rad) * aside;
    position.z() += 0.5 * 0.0274 * share * std::cos(2 * stride_rad);
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      position[axis] += (axis == 2 ? 0.3 : 1.0) * sway[k].at(t_s) + tremor[k].at(t_s);
    }
    const double yaw = looks.yaw_rad[i] + wander[0].at(t_s) + shake[0].at(t_s);
    const Eigen::Matrix3d rotation =
        looking(yaw, looks.pitch_rad[i] + wander[1].at(t_s) + shake[1].at(t_s),
                roll.at(t_s) + wander[2].at(t_s) + shake[2].at(t_s));
    const Stamp stamp_ns = std::llround(static_cast<double>(i) * 1e9 / camera.rate_hz);
    path.camera.push_back({stamp_ns, SE3(rotation, position)});
    path.base.push_back({stamp_ns, SE3(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix(),
                                       {position.x(), position.y(), 0.0})});
    if (i > 0)
      path.length_m += (path.base[i].world_from_camera.translation() -
                        path.base[i - 1].world_from_camera.translation())
                           .norm();
  }
  return path;
}

}  // namespace mh
