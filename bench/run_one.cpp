// SPDX-License-Identifier: Apache-2.0
#include "bench/run_one.hpp"

#include <algorithm>
#include <chrono>

#include "bench/protocol/digest.hpp"
#include "bench/results/occupancy.hpp"
#include "bench/results/trajectory_score.hpp"
#include "bench/systems/conversation.hpp"
#include "bench/systems/ours.hpp"
#include "bench/systems/recorded_run.hpp"
#include "bench/systems/tampered.hpp"
#include "sim/world/sequence.hpp"

namespace mh {
namespace {

enum StreamName : std::uint64_t { kMapping = 1, kHeldOut = 2, kSecondTour = 3 };

/// Counts pieces of work and tells their share.
class WorkDone {
 public:
  WorkDone(std::size_t all, const std::function<void(double)>& tell)
      : all_(std::max<std::size_t>(1, all)), tell_(tell) {}
  void reached(std::size_t position) {
    if (position <= furthest_) return;
    furthest_ = position;
    tell_(static_cast<double>(furthest_) / static_cast<double>(all_));
  }
  void one_more() { reached(furthest_ + 1); }

 private:
  std::size_t all_, furthest_ = 0;
  const std::function<void(double)>& tell_;
};

FrameSource frames_of(const SimulatedSequence& sequence, const RunTamper& tamper) {
  return [&sequence, &tamper](std::size_t index, RandomStream noise) {
    RgbdFrame frame = sequence.at(index, noise).frame;
    if (tamper.frame) tamper.frame(index, frame);
    return frame;
  };
}

/// One set of queries, under each parameter point in turn.
class QueryRound {
 public:
  QueryRound(const RunSpec& spec, const SimulatedSequence& sequence, NearestBy by,
             const RunTamper& tamper, const RunResult& run, RandomStream stream)
      : spec_(spec),
        sequence_(sequence),
        by_(by),
        frames_(frames_of(sequence, tamper)),
        run_(run),
        stream_(stream) {}

  std::vector<QueryScore> put(const System& frozen, WorkDone& work) const {
    std::vector<QueryScore> scores;
    for (const std::size_t index : test_frames(sequence_.size(), spec_.protocol)) {
      const QueryAnswer answer = query(frozen, index, frames_, spec_.protocol, stream_);
      const TimedPose& truth = sequence_.path()[index];
      scores.push_back(score(answer, truth,
                             find_anchor(run_.estimate, run_.truth, truth, by_, spec_.protocol),
                             run_.trajectory.truth_from_estimate, spec_.protocol));
      work.one_more();
    }
    return scores;
  }

 private:
  const RunSpec& spec_;
  const SimulatedSequence& sequence_;
  NearestBy by_;
  FrameSource frames_;
  const RunResult& run_;
  RandomStream stream_;
};

std::size_t pieces_of_work(const RunSpec& spec, const World& world) {
  std::size_t queries = test_frames(world.mapping.camera.size(), spec.protocol).size();
  if (world.second) queries += test_frames(world.second->camera.size(), spec.protocol).size();
  return world.mapping.camera.size() + spec.points.size() * queries;
}

/// The mapping frames as a folder, and what an outside program made of them.
Trajectory run_recorded(const RunSpec& spec, const SimulatedSequence& mapping,
                        const RunTamper& tamper, RandomStream stream,
                        const std::filesystem::path& folder) {
  std::vector<std::size_t> offered;
  for (std::size_t i = 0; i < mapping.size(); ++i)
    if (!is_test_frame(i, spec.protocol)) offered.push_back(i);
  const FrameSource frames = frames_of(mapping, tamper);
  const std::filesystem::path dataset = folder / "dataset";
  const std::vector<Stamp> stamps =
      write_dataset(dataset, mapping.camera(), offered.size(),
                    [&](std::size_t i) { return frames(offered[i], mapping_noise(stream, 0)); });
  return run_on_dataset(spec.system.outside, dataset, stamps, spec.seed, folder);
}

}  // namespace

std::unique_ptr<System> make_system(const RunSpec& spec, const World& world,
                                    const std::filesystem::path& folder) {
  if (spec.system.kind == SystemKind::kOutside) {
    if (spec.system.outside.mode == OutsideMode::kTrajectory) return nullptr;
    return make_conversation_system(spec.system.outside, world.robot.camera, spec.seed,
                                    folder / "outside.log");
  }
  SlamConfig config;
  config.semantics = spec.mapping;
  return make_our_system(world.robot.camera, config, world.vocabulary);
}

RunResult run_one(const RunSpec& spec, const World& world, const RunTools& tools) {
  const auto start = std::chrono::steady_clock::now();
  const RandomStream stream(spec.seed);
  const RunTamper& tamper = tools.tamper;
  const Camera& camera = world.robot.camera;
  const SimulatedSequence mapping(world.renderer, camera, world.mapping.camera, world.sensors,
                                  spec.labels, world.walked);
  WorkDone work(pieces_of_work(spec, world), tools.progress);
  RunResult run;
  run.spec = spec;
  run.place = facts(world);
  run.truth = world.mapping.camera;
  KeyframeDepths depths;

  std::unique_ptr<System> inner =
      tools.system ? tools.system(spec, world) : make_system(spec, world, tools.folder);
  if (inner == nullptr) {  // a program that answers with a trajectory: nothing to ask it
    for (std::size_t i = 0; i < mapping.size(); ++i)
      run.mapping.offered += is_test_frame(i, spec.protocol) ? 0 : 1;
    run.estimate = run_recorded(spec, mapping, tamper, stream.fork(kMapping), tools.folder);
    run.trajectory = score_trajectory(run.estimate, run.truth, run.mapping.offered);
    run.points.resize(spec.points.size());
  } else {
    if (tamper.report) inner = make_tampered(std::move(inner), tamper.report);
    TimedSystem system(std::move(inner));
    run.mapping = map_sequence(
        system, mapping.size(), frames_of(mapping, tamper), spec.protocol, stream.fork(kMapping),
        [&](const MappedFrame& call, const RgbdFrame& frame, const StepReport&) {
          if (call.keyframe_added) depths.keep(frame);
          work.reached(call.index + 1);
        });
    system.freeze();
    work.reached(mapping.size());
    run.estimate = system.trajectory();
    run.trajectory = score_trajectory(run.estimate, run.truth, run.mapping.offered);

    const QueryRound held_out(spec, mapping, NearestBy::kTime, tamper, run, stream.fork(kHeldOut));
    std::optional<SimulatedSequence> second;
    if (world.second)
      second.emplace(world.second_renderer ? world.second_renderer : world.renderer, camera,
                     world.second->camera, world.sensors, spec.labels);
    for (const SemanticConfig& settings : spec.points) {
      system.set_query_settings(settings);
      PointResult point;
      point.held_out = held_out.put(system, work);
      if (second)
        point.second_tour =
            QueryRound(spec, *second, NearestBy::kPlace, tamper, run, stream.fork(kSecondTour))
                .put(system, work);
      run.points.push_back(std::move(point));
    }
    run.times = system.times();
  }

  const Robot& robot = world.robot;
  run.volume = depths.integrate(robot.camera, run.estimate, run.trajectory.dock_from_estimate);
  // From just over the floor (noise of the depth at 4 m lies below) to the top of the head.
  run.grid = run.volume->project(0.10, robot.height_m);
  run.map_digest = digest_bytes(run.grid.cells.data(), run.grid.cells.size(), digest(run.estimate));
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

}  // namespace mh
