// SPDX-License-Identifier: Apache-2.0
#include "bench/run/one/run_one.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "bench/protocol/streams.hpp"
#include "bench/run/one/ask_queries.hpp"
#include "bench/run/one/hidden_folders.hpp"
#include "bench/run/one/watched_frames.hpp"
#include "bench/suite/find_program.hpp"
#include "bench/suite/run_key.hpp"
#include "bench/systems/builtin.hpp"
#include "bench/systems/conversation.hpp"
#include "bench/systems/finished_map.hpp"
#include "bench/systems/program_folder.hpp"
#include "bench/systems/recorded_run.hpp"
#include "bench/systems/timed.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/path_watch.hpp"
#include "slam/occupancy/obstacle_grid.hpp"
#include "slam/occupancy/occupancy_mapper.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFramesOfEpisode = 80;  // mapped frames that cost as much as an episode

/// Counts units of work and reports their share.
class WorkDone {
 public:
  WorkDone(std::size_t all, const std::function<void(double)>& report)
      : all_(std::max<std::size_t>(1, all)), report_(report) {}
  void reached(std::size_t position) {
    if (position <= furthest_) return;
    furthest_ = position;
    report_(static_cast<double>(furthest_) / static_cast<double>(all_));
  }
  void more(std::size_t count) { reached(furthest_ + count); }

 private:
  std::size_t all_, furthest_ = 0;
  const std::function<void(double)>& report_;
};

std::string status_of(const MappedFrame& call, std::size_t frames) {
  return fmt::format("frame {} of {}{}{}", call.index + 1, frames,
                     call.restart > 0 ? ", " + counted(call.restart, "restart") : "",
                     call.status == TrackStatus::kLost ? ", lost" : "");
}

std::size_t pieces_of_work(const RunSpec& spec, const World& world) {
  // For a program that returns a trajectory, each frame is first written and then read.
  if (!spec.system.is_asked())
    return 2 * offered_frames(world.mapping->size(), spec.protocol).size();
  const std::size_t episodes = spec.episodes ? spec.episodes->count() : 0;
  return world.mapping->size() + spec.points.size() * count_queries(spec, world) +
         kFramesOfEpisode * episodes;
}

/// Writes the mapping frames as a folder and returns an outside program's trajectory for them.
/// @param skipped  receives the frames that could not be written
Trajectory run_recorded(const RunSpec& spec, const World& world, const Sequence& mapping,
                        const RunTools& tools, WorkDone& work, SkippedFrames& skipped) {
  const RandomStream stream = mapping_stream(spec);
  const std::vector<std::size_t> offered = offered_frames(mapping.size(), spec.protocol);
  UsableFrames frames(mapping);
  ProgramFolder given(tools.folder);
  const std::vector<Stamp> stamps =
      write_dataset(given.path() / "dataset", mapping.camera(), offered.size(), [&](std::size_t i) {
        tools.status(fmt::format("writing frame {} of {}", i + 1, offered.size()));
        work.reached(i + 1);
        return frames.frame(offered[i], mapping_noise(stream, 0));
      });
  frames.require_any();
  skipped = frames.skipped();
  Trajectory trajectory = run_on_dataset(
      program_of(spec, world, tools.hidden), given.path(), stamps, spec.seed,
      tools.folder / kOutsideLog, [&](std::size_t read) {
        tools.status(fmt::format("has read {} of {}", read, counted(stamps.size(), "frame")));
        work.reached(offered.size() + std::min(read, stamps.size()));
      });
  given.move_to_run();
  return trajectory;
}

}  // namespace

std::unique_ptr<System> make_system(const RunSpec& spec, const World& world, const fs::path& folder,
                                    const std::vector<fs::path>& hidden) {
  if (spec.system.is_outside()) {
    if (spec.system.outside->mode == OutsideMode::kTrajectory) return nullptr;
    return make_conversation_system(program_of(spec, world, hidden), world.mapping->camera(),
                                    spec.seed, folder / kOutsideLog);
  }
  SlamConfig settings = spec.slam;
  if (world.readout_s) settings.track.readout_s = *world.readout_s;
  return make_builtin_system(world.mapping->camera(), settings, world.vocabulary, spec.points);
}

RunResult run_one(const RunSpec& spec, const World& world, const RunTools& tools) {
  const Sequence& mapping = *world.mapping;
  const Camera& camera = mapping.camera();
  WorkDone work(pieces_of_work(spec, world), tools.progress);
  RunResult run;
  run.spec = spec;
  run.place = facts(world, spec);
  if (mapping.truth() != nullptr) run.truth = *mapping.truth();
  OccupancyMapper mapper(camera);
  const FilesAsKeyed files(world.held);
  const WatchedFrames frames(mapping, spec.environment.sequence, shows_labels(spec), files,
                             run.frames_s);
  const auto integrate = [&] {
    const ProcessorTimer timer(run.products_s);
    if (!tools.occupancy) return;
    mapper.update(run.estimate, run.alignment.dock_from_estimate);
    mapper.associate_detections();
    run.volume = std::make_shared<const VoxelMap>(std::move(mapper).take_map());
  };

  // The program's files are watched from before it starts, since its own reads of them are not seen
  // here.
  PathWatch program_paths(spec.system.is_outside() ? places_of(*spec.system.outside)
                                                   : std::vector<fs::path>());
  require_unchanged(world.held);

  std::unique_ptr<System> inner = tools.system
                                      ? tools.system(spec, world)
                                      : make_system(spec, world, tools.folder, tools.hidden);
  if (inner == nullptr) {  // a program that only returns a trajectory: no queries
    run.mapping.offered = offered_frames(mapping.size(), spec.protocol).size();
    take_trajectory(run, run_recorded(spec, world, frames, tools, work, run.mapping.skipped));
    integrate();
    run.points.resize(spec.points.size());
  } else {
    TimedSystem system(std::move(inner));
    const auto end_mapping = [&] {
      system.freeze();
      take_trajectory(run, system.trajectory());
    };
    const auto map_now = [&] {
      run.mapping = map_sequence(
          system, frames, spec.protocol, mapping_stream(spec),
          [&](const MappedFrame& call, const RgbdFrame& frame, const SystemReport& report) {
            const ProcessorTimer timer(run.products_s);
            if (call.keyframe_added && tools.occupancy) mapper.keep(frame);
            if (tools.observe) tools.observe(call, frame, report);
            program_paths.require_unmoved();
            work.reached(call.index + 1);
            tools.status(status_of(call, mapping.size()));
          },
          tools.first);
      end_mapping();
      integrate();
    };
    if (!tools.maps.folder().empty() && tools.occupancy && spec.system.saves_map()) {
      bool mapped = false;
      const std::string kept = tools.maps.get("map", map_key(spec, world.inputs), [&] {
        map_now();
        mapped = true;
        require_unchanged(world.held);
        return encode(FinishedMap{system.save(), run.mapping, run.volume});
      });
      if (!mapped) {
        FinishedMap finished = decode_finished_map(kept, "cached map");
        system.restore(finished.system);
        run.mapping = std::move(finished.outcome);
        run.volume = std::move(finished.volume);
        end_mapping();
      }
    } else {
      map_now();
    }
    work.reached(mapping.size());
    tools.status("queries");

    ask_queries(spec, world, system, files, run, [&] { work.more(1); });
    if (spec.episodes) {
      EpisodeTools episodes = tools.episodes;
      episodes.require_unchanged = [&] {
        require_unchanged(world.held);
        program_paths.require_unmoved();
      };
      episodes.status = tools.status;
      episodes.done = [&] { work.more(kFramesOfEpisode); };
      run.episodes =
          ask_episodes(spec, world, system, run.estimate, run.alignment.truth_from_estimate,
                       mapping_noise(mapping_stream(spec), 0), episodes);
    }
    system.finish();
    run.times = system.times();
  }

  const ProcessorTimer timer(run.products_s);
  if (run.volume && world.simulated)  // the floor of a recording is unknown
    run.grid = obstacle_grid(*run.volume, {.floor_z_m = world.simulated->scene->floor.middle_m.z(),
                                           .robot_height_m = world.simulated->robot.height_m});
  run.map_digest = digest_bytes(run.grid.cells.data(), run.grid.cells.size(), digest(run.estimate));
  if (!run.elsewhere.empty()) run.map_digest = chained(run.map_digest, digest(run.elsewhere));
  require_unchanged(world.held);
  program_paths.require_unmoved();
  return run;
}

}  // namespace mh
