// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <CLI/CLI.hpp>

namespace mh::cli {

/// A finite number from `least` to `greatest`. (CLI::Range takes "nan": it is neither too small nor
/// too large.)
CLI::Validator number_between(double least, double greatest);

/// A seed: a whole number from 0 to 2^64 - 1, where parsing alone would let others wrap round.
CLI::Validator seed_number();

/// Finds out before the work whether a file can be written there; makes its folder.
/// @throws InputError naming file or folder; DiskFullError.
void need_writable(const std::filesystem::path& file);

}  // namespace mh::cli
