// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <SQLiteCpp/SQLiteCpp.h>

namespace mh {

/// Translates SQLite's error for the user: throws InputError or MachineError with one line that
/// states what to do.
[[noreturn]] void throw_meaning(const std::filesystem::path& file, const SQLite::Exception& error);

/// Calls `work`; translates SQLite's errors into ours.
template <class Work>
auto guarded(const std::filesystem::path& file, const Work& work) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    throw_meaning(file, error);
  }
}

}  // namespace mh
