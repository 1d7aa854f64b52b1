// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "slam/core/error.hpp"

namespace mh::cli {

/// How the camera moves (see bench/world/travel.hpp): as TOUR or as --motion.
struct MotionOption {
  std::string tour, motion;

  void add_to(CLI::App& command) {
    command.add_option("tour", tour, "Tour (YAML); or --motion");
    command.add_option("--motion", motion,
                       "TOUR.yaml, auto[:SEED], handheld[:SEED[:FRAMES]], replay:FILE.tum or "
                       "commands:FILE.yaml");
  }
  /// @throws InputError unless exactly one of the two was given
  const std::string& given() const {
    if (motion.empty() == tour.empty())
      throw InputError("give the motion once: as TOUR or as --motion");
    return motion.empty() ? tour : motion;
  }
};

}  // namespace mh::cli
