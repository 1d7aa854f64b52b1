// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "slam/pipeline/slam.hpp"

namespace mh {

inline constexpr std::uint32_t kMapFileVersion = 12;

/// Serializes all of a SlamState except the vocabulary, which is referenced by its digest: a run
/// that is saved and loaded resumes bit-identically to one that was not. Equal states give equal
/// bytes, and loading changes nothing.
std::string encode_slam(const SlamState& state);
/// @param name  names the file in messages.
/// @throws InputError naming the fault: not a map file, another version, truncated, checksum wrong,
/// made with another vocabulary, or parts that do not fit together.
SlamState decode_slam(const std::string& bytes, const std::string& name,
                      std::shared_ptr<const Vocabulary> vocabulary);

/// Whether a file starts like a map file.
bool is_map_file(const std::filesystem::path& file);

/// Saves a state to a file, atomically, and loads it from one.
void save_slam(const std::filesystem::path& file, const SlamState& state);
SlamState load_slam(const std::filesystem::path& file,
                    std::shared_ptr<const Vocabulary> vocabulary);

}  // namespace mh
