// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bench/cli/arguments.hpp"
#include "scenes/scene_frame.hpp"

namespace mh::cli {

/// The command line's options for a scene's frame: --up and --floor-z.
struct SceneFrameOption {
  std::optional<std::string> up;
  std::optional<double> floor_z_m;

  void add_to(CLI::App& command) {
    command
        .add_option(
            "--up", up,
            "Axis that points up in the scene's files, y or z (default: y for glTF and DAE)")
        ->check(CLI::IsMember({"y", "z"}));
    command
        .add_option("--floor-z", floor_z_m,
                    "Height of the scene's floor in meters (default: found automatically)")
        ->check(number_between(-kFarthestFloor_m, kFarthestFloor_m));
  }
  SceneFrame frame() const {
    return {.up = up ? value_of(*up, words(UpAxis{})) : std::nullopt, .floor_z_m = floor_z_m};
  }
};

inline void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    fmt::print(stderr, "modelhouse: warning: {}\n", warning);
}

}  // namespace mh::cli
