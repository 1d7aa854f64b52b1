// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/episodes/episode.hpp"

#include <memory>
#include <numbers>
#include <utility>

#include "bench/protocol/episodes/judge.hpp"
#include "bench/protocol/query.hpp"
#include "bench/protocol/system_report.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr double kStep_s = 0.1;      // between commands
constexpr double kMapError_m = 0.1;  // it drives this much closer, by its map, than required
constexpr double kSettle_s = 1.0;    // time to come to rest after reporting that it stops

constexpr std::uint64_t kNoiseStream = 0x6570, kDrawStream = 0x6571;

/// Interpolates between two poses.
Pose2 between(const Pose2& a, const Pose2& b, double share) {
  return {a.place_m + share * (b.place_m - a.place_m),
          a.heading_rad + share * turn_to(a.heading_rad, b.heading_rad)};
}

std::uint64_t digest_of(const Twist2d& command, std::uint64_t sum) {
  return digest_bytes(command.data(), sizeof(double) * 3, sum);
}

/// Seed of the sensor noise: the same for every system, different for every variant and start.
std::uint64_t noise_seed(const EpisodesSpec& spec, const std::string& variant, std::size_t start) {
  const std::uint64_t of_variant = digest_bytes(variant.data(), variant.size());
  return RandomStream(spec.seed).fork(kNoiseStream).fork(of_variant).fork(start).key();
}

class Episode {
 public:
  Episode(const EpisodePlace& place, const EpisodesSpec& spec, const EpisodeStart& start,
          const EpisodeObserver& observe)
      : place_(place),
        spec_(spec),
        start_(start),
        observe_(observe),
        score_(score_at_start(place.variant, start)),
        draws_(RandomStream(place.system_seed).fork(kDrawStream).fork(start.index)),
        world_from_map_(
            from_above(place.truth_from_estimate * place.map.map_from_estimate.inverse())) {}

  EpisodeScore run() {
    if (place_.map.empty()) return failed("no_map", "has no map");
    std::vector<NavigatorGoal> goals;
    try {
      goals = goals_named(place_.map, start_.goal);
    } catch (const InputError& error) {
      return failed("object_not_in_map", error.what());
    }
    NavigatorConfig config;
    config.reach_m = spec_.arrival_m - kMapError_m;
    std::optional<Navigator> navigator;
    try {
      navigator.emplace(place_.map.known, place_.robot, std::move(goals), config);
    } catch (const InputError& error) {
      return failed("no_path", error.what());
    }
    Simulation simulation(place_.scene, place_.robot, place_.level,
                          {.start_m = start_.place_m,
                           .start_heading_rad = start_.heading_rad,
                           .ticks_per_frame = spec_.ticks_per_frame,
                           .labels = place_.labels,
                           .seed = noise_seed(spec_, place_.variant, start_.index)});
    session_ = place_.frozen.open_session();
    in_the_dark(simulation);
    drive(simulation, *navigator);
    const CommandedBase& truth = simulation.truth();
    judge({.state = navigator->state(),
           .truth = true_pose(simulation),
           .belief = believed(*navigator),
           .length_m = truth.length_m(),
           .bumps = truth.bumps()},
          start_, spec_.arrival_m, score_);
    return std::move(score_);
  }

 private:
  /// Ends an episode before it begins.
  EpisodeScore failed(const char* reason, const std::string& why) {
    score_.reason = reason;
    if (observe_)
      observe_({.world_from_base = {start_.place_m, start_.heading_rad},
                .believed = {},
                .world_from_map = world_from_map_,
                .said = {why}});
    return std::move(score_);
  }

  void in_the_dark(Simulation& simulation) {
    simulation.switch_light(false);
    while (simulation.time_s() < spec_.dark_s) {
      const RobotObservation seen = simulation.step(Twist2d::Zero(), kStep_s);
      if (seen.frame) answer(*seen.frame);
      odometry_ = from_above(seen.odom_from_base);
    }
    simulation.switch_light(true);
  }

  /// Shows a frame to the system.
  SystemReport answer(const RgbdFrame& frame) {
    ++score_.frames;
    SystemReport report;
    if (place_.system_sees_labels) {
      report = session_->feed(frame, draws_.fork(static_cast<std::uint64_t>(score_.frames)));
    } else {
      RgbdFrame unlabeled = frame;
      unlabeled.semantics = {};
      report = session_->feed(unlabeled, draws_.fork(static_cast<std::uint64_t>(score_.frames)));
    }
    std::uint64_t& sum = score_.digest;
    sum = chained(sum, digest(frame));
    sum = chained(sum, digest_of_matching(report));
    sum = chained(sum, digest(report.world_from_camera));
    return report;
  }

  void drive(Simulation& simulation, Navigator& navigator) {
    Twist2d command = Twist2d::Zero();
    std::optional<double> ended_s;
    while (simulation.time_s() < spec_.limit_s &&
           !(ended_s && simulation.time_s() > *ended_s + kSettle_s)) {
      const RobotObservation seen = simulation.step(command, kStep_s);
      const Pose2 before = odometry_;
      odometry_ = from_above(seen.odom_from_base);
      Perception now{.time_s = simulation.time_s(),
                     .odom_from_base = odometry_,
                     .lasers_m = seen.reading.lasers_m,
                     .bumpers = seen.reading.bumpers,
                     .seen = {}};
      SystemReport report;
      if (seen.frame) {
        report = answer(*seen.frame);
        const double age_s = 1e-9 * static_cast<double>(seen.stamp_ns - seen.frame->stamp_ns);
        now.seen =
            Perception::Seen{.depth_m = &seen.frame->depth_m,
                             .odom_from_base = between(before, odometry_, 1 - age_s / kStep_s),
                             .map_from_base = {}};
        if (report.status != TrackStatus::kLost && report.world_from_camera &&
            report.map == place_.map_of_system)
          now.seen->map_from_base =
              from_above(place_.map.map_from_estimate * *report.world_from_camera *
                         place_.robot.base_from_camera.inverse());
      }
      command = navigator.step(now);
      score_.digest = digest_of(command, score_.digest);
      if (is_end(navigator.state()) && !ended_s) ended_s = simulation.time_s();
      note_place(simulation, navigator);
      if (observe_) tell(simulation, navigator, seen, report);
    }
    score_.time_s = ended_s.value_or(simulation.time_s());
  }

  std::optional<Pose2> believed(const Navigator& navigator) const {
    if (!navigator.knows_its_place()) return std::nullopt;
    return world_from_map_ * navigator.map_from_base(odometry_);
  }

  static Pose2 true_pose(const Simulation& simulation) {
    return {simulation.truth().state().position_m, simulation.truth().state().heading_rad};
  }

  void note_place(const Simulation& simulation, const Navigator& navigator) {
    const std::optional<Pose2> belief = believed(navigator);
    if (!belief || score_.located_s) return;
    const PoseError error = error_of(*belief, true_pose(simulation));
    score_.located_s = simulation.time_s();
    score_.located_error_m = error.away_m;
    score_.located_error_deg = error.turned_rad * 180 / std::numbers::pi;
  }

  void tell(const Simulation& simulation, Navigator& navigator, const RobotObservation& seen,
            const SystemReport& report) {
    EpisodeMoment moment;
    moment.time_s = simulation.time_s();
    moment.frame = seen.frame ? &*seen.frame : nullptr;
    moment.report = seen.frame ? &report : nullptr;
    moment.world_from_base = true_pose(simulation);
    moment.believed = believed(navigator);
    moment.world_from_map = world_from_map_;
    moment.navigator = &navigator;
    moment.said = navigator.take_said();
    observe_(moment);
  }

  const EpisodePlace& place_;
  const EpisodesSpec& spec_;
  const EpisodeStart& start_;
  const EpisodeObserver& observe_;
  EpisodeScore score_;
  RandomStream draws_;
  Pose2 world_from_map_;
  std::unique_ptr<RelocalizationSession> session_;
  Pose2 odometry_;
};

}  // namespace

EpisodeScore score_at_start(const std::string& variant, const EpisodeStart& start) {
  EpisodeScore score;
  score.variant = variant;
  score.start = start.index;
  score.goal = start.goal;
  score.start_x_m = start.place_m.x();
  score.start_y_m = start.place_m.y();
  score.start_heading_deg = start.heading_rad * 180 / std::numbers::pi;
  score.shortest_m = start.shortest_m;
  score.end_distance_m = distance_to(start.boxes, start.place_m);
  return score;
}

EpisodeScore run_episode(const EpisodePlace& place, const EpisodesSpec& spec,
                         const EpisodeStart& start, const EpisodeObserver& observe) {
  return Episode(place, spec, start, observe).run();
}

}  // namespace mh
