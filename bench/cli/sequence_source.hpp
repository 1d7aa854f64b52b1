// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "bench/cli/scene_option.hpp"
#include "slam/core/sequence.hpp"
#include "slam/files/settings_file.hpp"

namespace mh::cli {

/// The prefix that marks a source as a scene.
inline constexpr std::string_view kSceneSource = "scene:";

/// A recording, or a scene with a tour, as named by a command's options.
struct SourceOptions {
  std::string source, settings, classes, topics;
  SceneFrameOption frame;
  std::string tour, robot, level;
  std::uint64_t seed = 0;
  bool labels = true;  ///< whether to read a recording's own labels

  bool is_scene() const { return source.starts_with(kSceneSource); }
  /// The file of a scene's robot. @throws InputError if there is none.
  std::filesystem::path robot_file() const;
  void add_to(CLI::App& command);
  /// @throws InputError if an option does not fit the kind of source.
  void check() const;
};

struct Source {
  Settings settings;
  std::unique_ptr<Sequence> frames;
};

/// Explains why a sequence gave no map. The depth of its first image is included, since it reveals
/// a wrong unit.
/// @param first, offered  index of the first frame that was given, and number of given frames
std::string nothing_mapped(const std::string& source, const Sequence& frames, std::size_t first,
                           std::size_t offered);

/// @throws InputError naming the file and the problem.
Source open_source(const SourceOptions& options);

}  // namespace mh::cli
