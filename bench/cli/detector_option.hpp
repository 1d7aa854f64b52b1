// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bench/suite/cache.hpp"
#include "slam/detect/detector.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {

/// The command line's options for a real detector.
struct DetectorOption {
  std::string file, settings, cache;

  std::vector<CLI::Option*> add_to(CLI::App& command, const char* what = "--detector") {
    return {command.add_option(what, file,
                               "Real detector whose labels replace the frames': a network (.onnx, "
                               "Darknet's .weights) or boxes (COCO .json, MOT .csv, a folder of "
                               "YOLO .txt)"),
            command.add_option("--detector-settings", settings,
                               "The detector's settings (YAML), which may also name the detector"),
            command.add_option(
                "--detector-cache", cache,
                "Cache folder for its detections; without one, the detector runs on every image")};
  }
  /// The cache of --detector-cache; warns on stderr if it cannot be used.
  /// @param command  named in the warning
  Cache opened_cache(const char* command) const {
    Cache opened(cache);
    if (!cache.empty())
      if (const std::string why = opened.why_unwritable(); !why.empty())
        fmt::print(stderr, "{}: warning: the cache keeps nothing: {}\n", command, why);
    return opened;
  }
  bool is_given() const { return !file.empty() || !settings.empty(); }
  std::optional<DetectorSpec> spec() const {
    if (!is_given()) {
      if (!cache.empty())
        throw InputError(fmt::format("--detector-cache {}: no detector is named", cache));
      return std::nullopt;
    }
    DetectorSpec spec;
    if (!file.empty()) spec = detector_from_file(file);
    const DetectorSpec named = spec;
    if (!settings.empty()) load_detector_settings(settings, spec);
    if (!file.empty() && (spec.network != named.network || spec.boxes != named.boxes))
      throw InputError(fmt::format("{} is given, but {} names {}: name only one", file, settings,
                                   (spec.network.empty() ? spec.boxes : spec.network).string()));
    return spec;
  }
};

}  // namespace mh::cli
