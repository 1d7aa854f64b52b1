// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bench/suite/shipped.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/io/error.hpp"
#include "slam/io/suggest.hpp"

namespace mh::cli {

/// How the camera moves (see sim/simulation/travel.hpp), given as TOUR or as --motion.
struct MotionOption {
  std::string tour, motion;

  void add_to(CLI::App& command) {
    command.add_option("tour", tour, "Tour (YAML); or --motion");
    command.add_option("--motion", motion,
                       "TOUR.yaml, the name of a shipped tour, auto[:SEED], survey[:SEED], "
                       "handheld[:SEED[:FRAMES]], replay:FILE.tum or "
                       "commands:FILE.yaml");
  }
  /// Returns the motion, with a shipped tour's name replaced by its file.
  /// @throws InputError unless exactly one of the two was given, or if a bare word names neither a
  /// kind of motion nor a tour
  std::string given() const {
    if (motion.empty() == tour.empty())
      throw InputError("give the motion once: as TOUR or as --motion");
    const std::string& word = motion.empty() ? tour : motion;
    std::vector<std::string> kinds(kMadeMotions.begin(), kMadeMotions.end());
    kinds.insert(kinds.end(), {"replay", "commands"});
    const std::string kind = word.substr(0, word.find(':'));
    if (std::ranges::find(kinds, kind) != kinds.end()) return word;
    if (is_bare_name(kind) && !shipped_or_there(word)) {
      std::vector<std::string> valid = kinds;
      for (const std::string& name : shipped_names(Shipped::kTour)) valid.push_back(name);
      throw InputError(fmt::format("'{}' is not a motion{}", word, hint(kind, valid)));
    }
    return find_shipped(word, Shipped::kTour).string();
  }

 private:
  static bool shipped_or_there(const std::string& word) {
    return std::filesystem::exists(word) || !shipped_file(word, Shipped::kTour).empty();
  }
};

}  // namespace mh::cli
