// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "bench/plan/outside_program.hpp"
#include "bench/protocol/system.hpp"
#include "slam/core/camera.hpp"

namespace mh {

/// A system in a shared library of somebody's (include/modelhouse/system.h), loaded into this
/// process, where a crash of it is a crash of ours: a suite gives each run a process of its own.
/// A library is loaded once and stays loaded; each system is made anew.
/// @param log   file for what the library prints
/// @throws OutsideError, here and in every call, if the library cannot be loaded, has another
///         version or reports an error, or if it answers with anything but what was asked.
std::unique_ptr<System> make_library_system(const OutsideProgram& program, const Camera& camera,
                                            std::uint64_t seed, const std::filesystem::path& log);

}  // namespace mh
