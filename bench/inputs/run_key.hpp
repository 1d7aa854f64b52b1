// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/plan/runs.hpp"
#include "bench/provenance/input_digest.hpp"

namespace mh {

/// xxh3-128, 32 hexadecimal digits, of everything that determines a run's result: its resolved
/// settings without names and paths, the digests of its inputs, the code, the compiler and the
/// libraries that compute.
/// @param inputs  what was read for it (bench/inputs/inputs.hpp)
std::string run_key(const RunSpec& spec, std::span<const InputDigest> inputs);

/// The same of a run's finished map: what only its queries depend on is left out, so that runs
/// which differ in nothing else share it.
std::string map_key(const RunSpec& spec, std::span<const InputDigest> inputs);

/// The spec as it is kept beside a result: names instead of paths, so that it is the same wherever
/// the files lie.
std::string stored_spec(const RunSpec& spec);

}  // namespace mh
