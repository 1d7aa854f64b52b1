// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "slam/io/error.hpp"

namespace mh {

/// The disk is full: finished work is intact, and the run can resume once there is room.
struct DiskFullError : MachineError {
  using MachineError::MachineError;
};

/// Reports a file that could not be written.
/// @param error  errno of the failed call; 0 if unknown
/// @throws DiskFullError if that is the cause, otherwise InputError; both name the file.
[[noreturn]] void throw_unwritable(const std::filesystem::path& file, int error);

/// Why a file cannot be read: "no such file", "it is a folder", "it is not a file" (a pipe or a
/// device, which could block a reader forever), "no permission"; null if it looks readable.
const char* why_unreadable(const std::filesystem::path& file);

/// Size limit for files that are read whole; recordings, read piece by piece, may be larger. Every
/// byte is hashed and most are parsed, so a larger file is a mistake or meant to exhaust memory.
inline constexpr std::uintmax_t kMostReadAtOnce_bytes = std::uintmax_t{4} << 30;

/// @throws InputError naming the file if it is larger than kMostReadAtOnce_bytes.
void require_readable_at_once(const std::filesystem::path& file, std::uintmax_t bytes);

/// @throws InputError naming the file if why_unreadable() returns a reason.
void require_readable(const std::filesystem::path& file);

/// @throws InputError naming the folder if it exists but may not be read.
void require_open(const std::filesystem::path& folder);

}  // namespace mh
