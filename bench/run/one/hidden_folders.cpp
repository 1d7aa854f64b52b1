// SPDX-License-Identifier: Apache-2.0
#include "bench/run/one/hidden_folders.hpp"

#include <unistd.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "bench/suite/cache.hpp"
#include "bench/systems/program_folder.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A folder and its parent folders, except the root.
std::set<fs::path> ancestors_of(const fs::path& folder) {
  std::set<fs::path> all;
  if (folder.empty()) return all;
  for (fs::path at = fs::absolute(folder).lexically_normal(); at != at.root_path();
       at = at.parent_path())
    all.insert(at);
  return all;
}

/// Adds a folder and the folders in it, but only those that modelhouse wrote.
/// @param depth  how many levels deeper to look
void add_written(const fs::path& folder, int depth, std::vector<fs::path>& written) {
  std::error_code error;
  if (fs::exists(folder / kOutputMark, error)) written.push_back(folder);
  if (depth == 0) return;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (std::error_code gone; it->symlink_status(gone).type() == fs::file_type::directory)
      add_written(it->path(), depth - 1, written);
}

/// Adds the folders that other runs made for their programs.
void add_of_other_runs(std::vector<fs::path>& hidden) {
  std::error_code error;
  const std::string own = fmt::format(".{}.", getpid());
  for (const auto& entry : fs::directory_iterator(ProgramFolder::place(), error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(".work.") && name.find(own) == std::string::npos)
      hidden.push_back(entry.path());
  }
}

/// Adds what was read through links that lead out of a recording's folder.
void add_linked(const ReadRecord& read, const fs::path& recording, std::vector<fs::path>& hidden) {
  std::error_code error;
  const fs::path inside = fs::canonical(recording, error);
  for (const FileObservation& file : read.observations) {
    const fs::path real = fs::canonical(file.path, error);
    if (!error && file.path.lexically_relative(recording).native().substr(0, 2) != ".." &&
        real.lexically_relative(inside).native().substr(0, 2) == "..")
      hidden.push_back(real);
  }
}

/// The paths of a run's inputs, by the inputs' names; generated inputs have none.
std::map<std::string, fs::path> sources_of(const RunSpec& spec) {
  const Environment& e = spec.environment;
  std::map<std::string, fs::path> all;
  if (e.is_recorded()) {
    all["sequence"] = split_sequence(e.sequence).second;
    if (e.queries) all["queries"] = split_sequence(*e.queries).second;
    return all;
  }
  sources(e, [&](const WorldSource& source, const std::optional<fs::path>& path) {
    if (path && source.reveals_truth) all[source.key] = *path;
  });
  if (!spec.episodes) return all;
  for (const EpisodeVariant& variant : spec.episodes->variants)
    sources(variant, [&](const WorldSource& source, const std::optional<fs::path>& path) {
      if (path && source.reveals_truth) all[input_name(variant, source)] = *path;
    });
  return all;
}

}  // namespace

OutsideProgram program_of(const RunSpec& spec, const World& world,
                          const std::vector<fs::path>& of_bench) {
  OutsideProgram program = *spec.system.outside;
  program.hidden = of_bench;
  program.hidden.push_back(Cache::default_folder());
  add_of_other_runs(program.hidden);
  std::set<fs::path> around = ancestors_of(program.folder);
  for (const fs::path& folder : of_bench) around.merge(ancestors_of(folder));
  for (const fs::path& folder : around) add_written(folder, 2, program.hidden);
  const auto sources = sources_of(spec);
  for (const InputDigest& input : world.inputs) {
    const auto source = sources.find(input.name);
    if (source == sources.end() || source->second.empty() || is_generated(source->second)) continue;
    if (is_folder(source->second)) {
      program.hidden.push_back(source->second);
      add_linked(world.held, source->second, program.hidden);
      continue;
    }
    const fs::path folder = fs::absolute(source->second).parent_path();
    for (const FileDigest& file : input.files) program.hidden.push_back(folder / file.file);
  }
  return program;
}

}  // namespace mh
