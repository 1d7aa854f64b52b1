// SPDX-License-Identifier: Apache-2.0
#include "bench/run/merge_parts.hpp"

#include <string>

#include <fmt/format.h>

#include "bench/store/store.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Copies the parts of a file or folder that the output lacks. Each file appears complete or not at
/// all, so that a copy interrupted by a full disk can be resumed.
void copy_missing(const fs::path& from, const fs::path& to) {
  if (fs::is_directory(from)) {
    make_output_folder(to);
    for (const auto& entry : fs::directory_iterator(from))
      copy_missing(entry.path(), to / entry.path().filename());
  } else if (fs::is_regular_file(from) && !fs::exists(to)) {
    write_atomically(to, read_file(from));
  }
}

/// Copies the run folders and the images that the output lacks.
void copy_files(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const std::string name = entry.path().filename().string();
    const bool run = entry.is_directory() && fs::exists(entry.path() / "estimate.tum");
    const bool views = name.starts_with("views") && name.ends_with(".png");
    if (run || views) copy_missing(entry.path(), to / name);
  }
}

}  // namespace

std::vector<fs::path> mergeable_results(const fs::path& out, const std::vector<fs::path>& parts) {
  std::vector<fs::path> all;
  if (fs::exists(out / "results.sqlite")) all.push_back(out / "results.sqlite");
  for (const fs::path& part : parts) {
    all.push_back(part / "results.sqlite");
    if (!fs::is_regular_file(all.back()))
      throw InputError(fmt::format("{}: holds no results.sqlite", part.string()));
  }
  Store::check_mergeable(all);
  return all;
}

void merge_parts(const fs::path& out, const std::vector<fs::path>& parts,
                 const std::function<void(std::string_view)>& say) {
  Store store(out / "results.sqlite");
  for (const fs::path& part : parts) {
    const bool itself = fs::equivalent(part, out);
    if (itself || store.merge(part / "results.sqlite") == 0)
      say(fmt::format("{}: holds no new results: all of them are here already", part.string()));
    if (!itself) copy_files(part, out);
  }
}

}  // namespace mh
