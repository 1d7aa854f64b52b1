// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <fmt/format.h>

#include "sim/sensors/config.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh::cli {

/// A sensor level may replace a sensor level, but no other file. @throws InputError naming it.
inline void require_no_other_than_level(const std::filesystem::path& file) {
  if (!is_file(file)) return;
  try {
    load_sensor_config(file);
  } catch (const InputError&) {
    throw InputError(
        fmt::format("{}: is not a sensor level: name another file to write", file.string()));
  }
}

}  // namespace mh::cli
