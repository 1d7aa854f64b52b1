// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "bench/protocol/system.hpp"
#include "bench/suite/outside_program.hpp"
#include "slam/core/camera.hpp"

namespace mh {

/// A system in an outside shared library (include/modelhouse/system.h), loaded into this process.
/// If it crashes, so does this process; a suite therefore gives each run its own. A library is
/// loaded once and stays loaded; each system is created from scratch.
/// @param log       file for what the library prints
/// @param on_call   receives each call before it is made, "track (call 20)": a crash ends this
/// process without any message
/// @throws OutsideError, here and in every call, if the library cannot be loaded, has another
///         version, reports an error or returns an invalid reply.
std::unique_ptr<System> make_library_system(const OutsideProgram& program, const Camera& camera,
                                            std::uint64_t seed, const std::filesystem::path& log,
                                            std::function<void(std::string_view)> on_call = {});

}  // namespace mh
