// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <SQLiteCpp/SQLiteCpp.h>

namespace mh {

/// Throws what SQLite's error means to the user: InputError or MachineError in one line that says
/// what to do.
[[noreturn]] void throw_meaning(const std::filesystem::path& file, const SQLite::Exception& error);

/// Calls `work`; SQLite's errors leave as ours.
template <class Work>
auto guarded(const std::filesystem::path& file, const Work& work) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    throw_meaning(file, error);
  }
}

}  // namespace mh
