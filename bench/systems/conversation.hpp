// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "bench/protocol/system.hpp"
#include "bench/suite/outside_program.hpp"
#include "slam/core/camera.hpp"

namespace mh {

/// An outside program as a system under test: each call becomes a line of JSON on the program's
/// standard input, answered by a line on its standard output (docs/outside_systems.md). Starts the
/// program and sends the greeting; the program ends when the system is destroyed. With each frame,
/// the program receives 31 bits of the frame's stream as a seed.
///
/// A program has a single map, so only the most recently opened session may be fed.
/// @param log   file for what the program writes to its standard error
/// @throws InputError if validate(program) does; OutsideError, here and in every call, if the
///         program fails: it exits, hangs, uses too much memory, or sends an invalid reply.
std::unique_ptr<System> make_conversation_system(const OutsideProgram& program,
                                                 const Camera& camera, std::uint64_t seed,
                                                 const std::filesystem::path& log);

}  // namespace mh
