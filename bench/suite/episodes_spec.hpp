// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/suite/environment.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// What is different when the robot is kidnapped from when it mapped.
struct EpisodeVariant {
  std::string name = "as_mapped";                        ///< unique, valid as a folder name
  std::optional<std::filesystem::path> scene = {};       ///< furniture moved, evening light
  std::optional<std::filesystem::path> pedestrian = {};  ///< walks about
  std::optional<std::filesystem::path> level = {};       ///< of the robot's camera
  friend bool operator==(const EpisodeVariant&, const EpisodeVariant&) = default;
};

/// Kidnappings of a robot, as data: the same starts for every system (docs/navigation.md).
struct EpisodesSpec {
  std::size_t starts = 10;         ///< of each variant in each environment
  std::uint64_t seed = 0;          ///< of starts and noise
  std::vector<std::string> goals;  ///< names of classes; each start draws one that is there
  double limit_s = 240;            ///< simulated time of one episode
  double arrival_m = 1.0;          ///< success: its center is no farther from the thing
  int ticks_per_frame = 3;         ///< of the camera: 3 of 30 Hz are 10 Hz
  double dark_s = 1.0;             ///< blank frames at the start
  std::vector<EpisodeVariant> variants = {{}};
  friend bool operator==(const EpisodesSpec&, const EpisodesSpec&) = default;
};

/// Reads the section `episodes` of a suite: `goals`, and optionally the other fields.
/// @throws InputError naming file, line, field and value: a goal that is no class (with
/// suggestions), two variants of one name, a missing file.
EpisodesSpec read_episodes(YamlReader node, const SuitePaths& paths);

}  // namespace mh
