// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "slam/core/error.hpp"

namespace mh {

/// The disk is full: the work is good and goes on once there is room.
struct DiskFullError : MachineError {
  using MachineError::MachineError;
};

/// A writer's last word on a file that it could not write.
/// @param error  errno of the call that failed; 0 if unknown
/// @throws DiskFullError where that is why, else InputError; both name the file.
[[noreturn]] void throw_unwritable(const std::filesystem::path& file, int error);

/// Why a file cannot be read: "no such file", "it is a folder", "it is no file" (a pipe or a
/// device, at which a reader might wait for ever), "no permission"; null if nothing speaks against
/// it.
const char* why_unreadable(const std::filesystem::path& file);

/// What is read as a whole may be so large; recordings, which are read piece by piece, more. Every
/// byte is hashed and most are parsed: a larger file is a mistake, or made to fill the memory.
inline constexpr std::uintmax_t kMostReadAtOnce_bytes = std::uintmax_t{4} << 30;

/// @throws InputError naming the file if it has more bytes than that.
void require_readable_at_once(const std::filesystem::path& file, std::uintmax_t bytes);

/// @throws InputError naming the file if why_unreadable() tells something.
void require_readable(const std::filesystem::path& file);

}  // namespace mh
