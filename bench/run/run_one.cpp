// SPDX-License-Identifier: Apache-2.0
#include "bench/run/run_one.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "bench/protocol/placed.hpp"
#include "bench/run/hidden.hpp"
#include "bench/suite/find_program.hpp"
#include "bench/suite/run_key.hpp"
#include "bench/systems/builtin.hpp"
#include "bench/systems/conversation.hpp"
#include "bench/systems/finished_map.hpp"
#include "bench/systems/program_folder.hpp"
#include "bench/systems/recorded_run.hpp"
#include "bench/systems/tampered.hpp"
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

enum StreamName : std::uint64_t {
  kMapping = 1,
  kHeldOut = 2,
  kSecondTour = 3,
  kGraded = 4,
  kTourOfEpisodes = 0x746f7572
};

constexpr std::size_t kFramesOfEpisode = 80;  // that are mapped in the time that it takes

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

/// Forwards another sequence's frames, so that they can be observed.
class SequenceView : public Sequence {
 public:
  explicit SequenceView(const Sequence& inner) : inner_(inner) {}
  const Camera& camera() const override { return inner_.camera(); }
  std::size_t size() const override { return inner_.size(); }
  Stamp stamp_ns(std::size_t i) const override { return inner_.stamp_ns(i); }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    return inner_.frame(i, noise);
  }
  const Trajectory* truth() const override { return inner_.truth(); }

 private:
  const Sequence& inner_;
};

/// The state of a world's files when its key was made.
class FilesAsKeyed {
 public:
  explicit FilesAsKeyed(const ReadRecord& held) {
    for (const FileObservation& o : held.observations)
      if (o.state.inode != 0) of_.emplace(o.path, o);
  }
  /// @throws InputChanged if any file that was just read differs, even if it was restored since
  void require(const ReadRecord& now) const {
    for (const FileObservation& o : now.observations) {
      const auto was = of_.find(o.path);
      using enum FileObservation::Kind;
      if (was == of_.end() || (o.kind != kRead && o.kind != kHeld && o.kind != kAbsent)) continue;
      const bool same = o.kind == kRead && was->second.kind == kRead
                            ? o.digest == was->second.digest
                            : o.state == was->second.state;
      if (!same)
        throw InputChanged(fmt::format(
            "{}: was changed while it was in use: start the command again", o.path.string()));
    }
  }

 private:
  std::map<fs::path, FileObservation> of_;
};

/// The frames as a run sees them: their files match its key, the CPU time spent on making them is
/// counted, and tests may change them.
class WatchedFrames : public SequenceView {
 public:
  /// @param recording  where they come from; empty: they are simulated
  /// @param spent_s  grows by the time spent
  /// @param labeled  false: they are shown without labels
  WatchedFrames(const Sequence& inner, std::string recording, bool labeled,
                const FilesAsKeyed& files, const RunTamper& tamper, double& spent_s)
      : SequenceView(inner),
        recording_(std::move(recording)),
        labeled_(labeled),
        files_(files),
        tamper_(tamper),
        spent_s_(spent_s) {}
  RgbdFrame frame(std::size_t i, RandomStream noise) const override try {
    const ProcessorTimer timer(spent_s_);
    RgbdFrame frame = checked(i, noise);
    if (!labeled_) frame.semantics = {};
    if (tamper_.frame) tamper_.frame(i, frame);
    return frame;
  } catch (const InputChanged&) {
    throw;
  } catch (const InputError& error) {
    throw InputError(without_place(error.what(), recording_));
  }

 private:
  RgbdFrame checked(std::size_t i, RandomStream noise) const {
    const ReadScope reading;
    try {
      RgbdFrame frame = SequenceView::frame(i, noise);
      files_.require(reading.record());
      return frame;
    } catch (const InputError&) {
      files_.require(reading.record());  // it cannot be read because it was missing
      throw;
    }
  }

  const std::string recording_;
  const bool labeled_;
  const FilesAsKeyed& files_;
  const RunTamper& tamper_;
  double& spent_s_;
};

/// Whether the system is shown the labels that the frames have.
bool shows_labels(const RunSpec& spec) {
  return !spec.episodes || spec.labels != Labels();
}

/// The recording that answers a set of queries; empty: they are simulated.
std::string recording_of(const Environment& environment, QuerySet set) {
  return set == QuerySet::kSecondTour ? environment.queries.value_or("") : environment.sequence;
}

/// Frames of one query, made once for all parameter points.
class FramesMadeOnce : public SequenceView {
 public:
  using SequenceView::SequenceView;
  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    auto made = made_.find(noise.key());
    if (made == made_.end()) made = made_.emplace(noise.key(), SequenceView::frame(i, noise)).first;
    return made->second;
  }

 private:
  mutable std::map<std::uint64_t, RgbdFrame> made_;
};

/// The frames of a set of queries.
std::vector<std::size_t> asked_frames(QuerySet set, const Sequence& sequence,
                                      const ProtocolConfig& config) {
  if (set != QuerySet::kGraded) return test_frames(sequence.size(), config);
  std::vector<std::size_t> all(sequence.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// One set of queries.
class QueryRound {
 public:
  QueryRound(const RunSpec& spec, QuerySet set, const World& world, const FilesAsKeyed& files,
             const RunTamper& tamper, RunResult& run)
      : spec_(spec),
        set_(set),
        world_(world),
        frames_(*sequence_of(world, set), recording_of(spec.environment, set), shows_labels(spec),
                files, tamper, run.frames_s),
        has_stamp_(increasing_stamps(frames_)),
        run_(run),
        stream_(query_stream(spec, set)) {}
  QuerySet set() const { return set_; }

  /// Makes each query under the points first .. end - 1; `scores[p]` receives the answers under
  /// point p.
  void put(System& frozen, std::size_t first, std::size_t end,
           const std::vector<std::vector<QueryScore>*>& scores, WorkDone& work) const {
    for (const std::size_t index : asked_frames(set_, frames_, spec_.protocol)) {
      if (!has_stamp_[index]) {
        if (first == 0) run_.mapping.skipped.add(stamp_fault(frames_, index));
        continue;
      }
      const Trajectory* truth = run_.truth.empty() ? nullptr : frames_.truth();
      const QueryMoment moment = moment_of(frames_.stamp_ns(index), truth);
      // If there is a truth, skip frames without one: no answer to them could be judged.
      if (truth != nullptr && !moment.true_world_from_camera) continue;
      const auto anchor =
          find_anchor(run_.estimate, run_.truth, moment, nearest_by(set_), spec_.protocol);
      const bool once = end - first == 1;  // nothing to share
      const FramesMadeOnce shared(frames_);
      const Sequence& frames = once ? static_cast<const Sequence&>(frames_) : shared;
      const std::unique_ptr<QueryMemo> memo = once ? nullptr : frozen.make_memo();
      for (std::size_t p = first; p < end; ++p) {
        if (!once) frozen.use_point(p);
        try {
          const QueryAnswer answer =
              query(frozen, index, frames, spec_.protocol, stream_, memo.get());
          scores[p]->push_back(
              score(answer, moment, anchor, run_.frames.truth_from_estimate, spec_.protocol));
          if (set_ == QuerySet::kGraded)
            scores[p]->back().grade = world_.simulated->graded.list[index].grade;
        } catch (const UnusableFrame& error) {
          if (p == 0) run_.mapping.skipped.add(error.what());
        }
        work.more(1);
      }
    }
  }

 private:
  const RunSpec& spec_;
  QuerySet set_;
  const World& world_;
  WatchedFrames frames_;
  std::vector<bool> has_stamp_;
  RunResult& run_;
  RandomStream stream_;
};

/// Returns the end of the points from `first` on that describe keyframes identically (equation 1),
/// so that switching between them costs nothing.
std::size_t end_of_alike(const std::vector<SemanticConfig>& points, std::size_t first) {
  std::size_t end = first + 1;
  while (end < points.size() && points[end].gamma == points[first].gamma &&
         points[end].label_mass == points[first].label_mass &&
         points[end].void_is_a_label == points[first].void_is_a_label)
    ++end;
  return end;
}

std::vector<std::vector<QueryScore>*> lists(RunResult& run, QuerySet set) {
  std::vector<std::vector<QueryScore>*> all;
  for (PointResult& point : run.points) all.push_back(&of_query_set(point, set));
  return all;
}

std::string status_of(const MappedFrame& call, std::size_t frames) {
  return fmt::format("frame {} of {}{}{}", call.index + 1, frames,
                     call.restart > 0 ? ", " + counted(call.restart, "restart") : "",
                     call.status == TrackStatus::kLost ? ", lost" : "");
}

std::size_t pieces_of_work(const RunSpec& spec, const World& world) {
  // A program that returns a trajectory: each frame is written and then read.
  if (!spec.system.is_asked())
    return 2 * offered_frames(world.mapping->size(), spec.protocol).size();
  std::size_t queries = 0;
  for (const QuerySet set : kQuerySets)
    if (const Sequence* sequence = sequence_of(world, set))
      queries += asked_frames(set, *sequence, spec.protocol).size();
  const std::size_t episodes = spec.episodes ? spec.episodes->count() : 0;
  return world.mapping->size() + spec.points.size() * queries + kFramesOfEpisode * episodes;
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

RandomStream mapping_stream(const RunSpec& spec) {
  return RandomStream(spec.seed).fork(spec.episodes ? kTourOfEpisodes : kMapping);
}

std::vector<RandomStream> shared_noises(const RunSpec& spec) {
  constexpr int kRestarts = 64;
  std::vector<RandomStream> noises;
  for (int restart = 0; restart <= kRestarts; ++restart)
    noises.push_back(mapping_noise(mapping_stream(spec), restart));
  return noises;
}

RandomStream query_stream(const RunSpec& spec, QuerySet set) {
  return RandomStream(spec.seed).fork(set == QuerySet::kHeldOut      ? kHeldOut
                                      : set == QuerySet::kSecondTour ? kSecondTour
                                                                     : kGraded);
}

RunResult run_one(const RunSpec& spec, const World& world, const RunTools& tools) {
  const RunTamper& tamper = tools.tamper;
  const Sequence& mapping = *world.mapping;
  const Camera& camera = mapping.camera();
  WorkDone work(pieces_of_work(spec, world), tools.progress);
  RunResult run;
  run.spec = spec;
  run.place = facts(world, spec);
  if (mapping.truth() != nullptr) run.truth = *mapping.truth();
  OccupancyMapper mapper(camera);
  const FilesAsKeyed files(world.held);
  const WatchedFrames frames(mapping, spec.environment.sequence, shows_labels(spec), files, tamper,
                             run.frames_s);
  const auto integrate = [&] {
    const ProcessorTimer timer(run.products_s);
    if (!tools.occupancy) return;
    mapper.update(run.estimate, run.frames.dock_from_estimate);
    mapper.associate_detections();
    run.volume = std::make_shared<const VoxelMap>(std::move(mapper).take_map());
  };

  // From before the program starts: what it reads is not seen here.
  std::vector<fs::path> of_program;
  if (spec.system.is_outside())
    for (const ProgramFile& file : files_of(*spec.system.outside)) of_program.push_back(file.file);
  PathWatch program_paths(of_program);
  require_unchanged(world.held);

  std::unique_ptr<System> inner = tools.system
                                      ? tools.system(spec, world)
                                      : make_system(spec, world, tools.folder, tools.hidden);
  if (inner == nullptr) {  // a program that only returns a trajectory: no queries
    run.mapping.offered = offered_frames(mapping.size(), spec.protocol).size();
    run.estimate = run_recorded(spec, world, frames, tools, work, run.mapping.skipped);
    run.trajectory = score_trajectory(run.estimate, run.truth, run.mapping.offered);
    run.frames = frames_of(run.estimate, run.truth);
    integrate();
    run.points.resize(spec.points.size());
  } else {
    if (tamper.report) inner = make_tampered(std::move(inner), tamper.report);
    TimedSystem system(std::move(inner));
    const auto take_trajectory = [&] {
      system.freeze();
      run.estimate = system.trajectory();
      run.trajectory = score_trajectory(run.estimate, run.truth, run.mapping.offered);
      run.frames = frames_of(run.estimate, run.truth);
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
      take_trajectory();
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
        take_trajectory();
      }
    } else {
      map_now();
    }
    work.reached(mapping.size());
    tools.status("queries");

    run.points.resize(spec.points.size());
    std::vector<QueryRound> rounds;
    for (const QuerySet set : kQuerySets)
      if (sequence_of(world, set) != nullptr)
        rounds.emplace_back(spec, set, world, files, tamper, run);
    for (std::size_t p = 0; p < spec.points.size(); p = end_of_alike(spec.points, p)) {
      const std::size_t end = end_of_alike(spec.points, p);
      system.use_point(p);
      for (const QueryRound& round : rounds)
        round.put(system, p, end, lists(run, round.set()), work);
    }
    if (spec.episodes) {
      EpisodeTools episodes = tools.episodes;
      episodes.require_unchanged = [&] {
        require_unchanged(world.held);
        program_paths.require_unmoved();
      };
      episodes.status = tools.status;
      episodes.done = [&] { work.more(kFramesOfEpisode); };
      run.episodes = ask_episodes(spec, world, system, run.estimate, run.frames.truth_from_estimate,
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
  require_unchanged(world.held);
  program_paths.require_unmoved();
  return run;
}

}  // namespace mh
