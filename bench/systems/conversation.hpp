// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "bench/plan/outside_program.hpp"
#include "bench/protocol/system.hpp"
#include "slam/core/camera.hpp"

namespace mh {

/// An outside program as a system under test: each call becomes a line of JSON on the program's
/// standard input, answered by one on its standard output (docs/outside_systems.md). Starts the
/// program and greets it; the program ends with the system. Of a frame's stream the program gets 31
/// bits as its seed.
///
/// One program stands before one map, so the session opened last is the only one that may be fed.
/// @param log   file for what the program writes to its standard error
/// @throws InputError if validate(program) does; OutsideError, here and in every call, if the
///         program fails: it ends, hangs, uses too much memory, or answers with anything but what
///         was asked.
std::unique_ptr<System> make_conversation_system(const OutsideProgram& program,
                                                 const Camera& camera, std::uint64_t seed,
                                                 const std::filesystem::path& log);

}  // namespace mh
