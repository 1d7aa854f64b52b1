// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bench/cache/cache.hpp"
#include "slam/core/error.hpp"
#include "slam/detect/detector.hpp"

namespace mh::cli {

/// The command line's options for a real detector.
struct DetectorOption {
  std::string file, settings, cache;

  void add_to(CLI::App& command, const char* what = "--detector") {
    command.add_option(
        what, file,
        "Real detector whose labels replace the frames': a network (.onnx, Darknet's .weights) or "
        "boxes (COCO .json, MOT .csv, a folder of YOLO .txt)");
    command.add_option("--detector-settings", settings, "Its settings (YAML), which may name it");
    command.add_option("--detector-cache", cache,
                       "Cache folder for what it finds; none: every image is run");
  }
  /// The cache of --detector-cache. @param say  receives a warning if it can keep nothing
  Cache opened_cache(const std::function<void(const std::string&)>& say) const {
    Cache opened(cache);
    if (!cache.empty())
      if (const std::string why = opened.why_unwritable(); !why.empty())
        say("warning: the cache keeps nothing: " + why);
    return opened;
  }
  bool is_given() const { return !file.empty() || !settings.empty(); }
  std::optional<DetectorSpec> spec() const {
    if (!is_given()) return std::nullopt;
    DetectorSpec spec;
    if (!file.empty()) spec = detector_from_file(file);
    if (!settings.empty()) load_detector_settings(settings, spec);
    return spec;
  }
};

}  // namespace mh::cli
