// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/plan/runs.hpp"
#include "bench/provenance/input_digest.hpp"
#include "scenes/scene.hpp"
#include "slam/core/read_record.hpp"

namespace mh {

/// What a source of a run is, by all that was read when it was loaded.
/// @param source  as the run names it: a file, a folder or something that code makes
InputDigest input_of(std::string name, const std::filesystem::path& source,
                     const ReadRecord& record);

/// Loads something and notes as an input what was read for it.
template <class Load>
auto noted(std::vector<InputDigest>& inputs, std::string name, const std::filesystem::path& source,
           Load&& load) {
  const ReadScope scope;
  auto loaded = load();
  inputs.push_back(input_of(std::move(name), source, scope.record()));
  return loaded;
}

/// What an outside program is made of or reads, as far as the suite names it; none of our systems.
std::vector<InputDigest> inputs_of_program(const RunSpec& spec);

/// Reads what runs read, each source once, before they are made: what build_world() will note.
class InputReader {
 public:
  /// @param say  told which scene is being read
  explicit InputReader(std::function<void(std::string_view)> say = [](std::string_view) {})
      : say_(std::move(say)) {}

  /// All inputs of a run, by name. @throws InputError if one of them cannot be loaded.
  std::vector<InputDigest> inputs_of(const RunSpec& spec);
  /// Those of its place alone: neither level nor vocabulary nor program.
  std::vector<InputDigest> inputs_of(const Environment& environment);

  /// A scene by its file, not lit; the one that was asked for last is kept. What had to be mended
  /// in it is said, a line each, once.
  std::shared_ptr<const Scene> scene(const std::filesystem::path& file, const SceneFrame& frame);

 private:
  void warn(const std::string& warning);  ///< once
  InputDigest read(const char* name, const std::string& kind, const std::filesystem::path& source,
                   const std::function<void(const std::filesystem::path&)>& load);

  std::map<std::pair<std::string, std::filesystem::path>, InputDigest> known_;  // by kind, source
  std::map<std::string, std::vector<InputDigest>> of_program_;  // by the system's name
  std::function<void(std::string_view)> say_;
  std::pair<std::filesystem::path, SceneFrame> scene_source_;
  std::set<std::string> warned_;
  std::shared_ptr<const Scene> scene_;
};

}  // namespace mh
