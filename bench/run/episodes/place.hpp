// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/protocol/world/world.hpp"
#include "bench/run/episodes/episode.hpp"
#include "bench/suite/runs.hpp"

namespace mh {

/// Every n-th frame of a sequence.
class EveryNth : public Sequence {
 public:
  EveryNth(std::shared_ptr<const Sequence> all, std::size_t n);
  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return (all_->size() + n_ - 1) / n_; }
  Stamp stamp_ns(std::size_t i) const override { return all_->stamp_ns(i * n_); }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    return all_->frame(i * n_, noise);
  }
  const Trajectory* truth() const override { return all_->truth() != nullptr ? &truth_ : nullptr; }

 private:
  std::shared_ptr<const Sequence> all_;
  std::size_t n_;
  Camera camera_;  ///< at the lower rate
  Trajectory truth_;
};

/// One variant of the episodes in an environment: what differs from the mapping, and the starts.
struct VariantPlace {
  EpisodeVariant variant;
  SimulatedScene scene;
  SensorConfig level;
  std::vector<EpisodeStart> starts;
};

/// An environment at a level, with everything that all systems share.
struct EpisodeWorld {
  World world;  ///< labeled: systems that see no labels receive frames without
  LabelMode labels = LabelMode::kExact;
  int ticks_per_frame = 1;
  std::shared_ptr<const Sequence> mapping;  ///< at the rate of the episodes
  std::vector<VariantPlace> variants;
  std::vector<InputDigest> inputs_of_variants;  ///< as read_variants() notes them
};

/// Notes what the variants of episodes read beside their place. @throws InputError
std::vector<InputDigest> read_variants(const EpisodesSpec& episodes);

/// Checks, before anything is mapped, that there is something to find in an environment.
/// @throws InputError as draw_starts(), in any variant; if a scene's floor is not z = 0, or the
/// robot cannot drive on its own.
void require_goals(const RunSpec& spec, const EpisodesSpec& episodes);

/// @param spec  a run of this environment, level and labels
/// @throws InputError as build_world(), and as draw_starts(); if a scene's floor is not z = 0, or
/// the robot cannot drive on its own.
EpisodeWorld build_episode_world(const RunSpec& spec, const EpisodesSpec& episodes, int threads,
                                 const Cache& cache, const Say& say);

/// A system that has mapped the tour, and its robot's map.
struct MappedSystem {
  std::unique_ptr<System> system;  ///< frozen
  RobotMap map;
  SE3 truth_from_estimate;
  std::size_t offered = 0, tracked = 0;  ///< frames of the tour
};

struct MapTools {
  std::filesystem::path folder;                    ///< for an outside program's log; exists
  Cache maps = Cache();                            ///< finished maps of systems that can save them
  std::string key;                                 ///< of the map
  std::vector<std::filesystem::path> hidden = {};  ///< as RunTools
  std::function<void(std::string_view)> say = [](std::string_view) {};  ///< as EpisodeOptions
  std::function<void(double)> progress = [](double) {};
};

/// Maps the tour with the system of a run, or takes its map from the cache, and makes the robot's
/// map of it; that is empty if nothing was mapped. @throws OutsideError.
/// @pre the system answers queries: see episode_runs()
MappedSystem map_tour(const RunSpec& spec, const EpisodeWorld& place, const MapTools& tools);

}  // namespace mh
