// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/suite/input_digest.hpp"
#include "bench/suite/run_spec.hpp"

namespace mh {

/// Returns the xxh3-128, as 32 hexadecimal digits, of everything that determines a run's result:
/// its resolved settings without names and paths, the digests of its inputs, the code, the compiler
/// and the numerical libraries.
/// @param inputs  what was read for it (bench/suite/inputs.hpp)
std::string run_key(const RunSpec& spec, std::span<const InputDigest> inputs);

/// Checks that what was read for a run matches its key.
/// @throws InputChanged naming the run.
void require_key(const RunSpec& spec, std::span<const InputDigest> read, const std::string& key);
[[noreturn]] void throw_changed(const RunSpec& spec);

/// Like run_key(), but for a run's finished map: omits what affects only the queries, so that runs
/// that differ only in their queries share the map.
std::string map_key(const RunSpec& spec, std::span<const InputDigest> inputs);

/// The spec as stored with a result: names instead of paths, so that it does not depend on where
/// the files are.
std::string stored_spec(const RunSpec& spec);

}  // namespace mh
