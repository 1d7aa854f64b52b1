// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "bench/report/results_json.hpp"
#include "bench/report/suite_json.hpp"
#include "bench/suite/code_version.hpp"
#include "bench/suite/fingerprint.hpp"
#include "bench/suite/outside_program.hpp"
#include "slam/core/digest.hpp"

namespace mh {

using Json = nlohmann::ordered_json;

Json reproduction_json(const Suite& suite, std::span<const RunResult> runs) {
  const auto from_anywhere = [](const std::filesystem::path& file) {
    return shell_quoted(std::filesystem::absolute(file).lexically_normal().string());
  };
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  std::string command = (error ? std::string("modelhouse") : from_anywhere(program)) + " bench " +
                        from_anywhere(suite.file);
  if (suite.scene_replaced) {
    const std::filesystem::path& scene = suite.environments.front().scene;
    command +=
        " --scene " + (is_generated(scene) ? shell_quoted(scene.string()) : from_anywhere(scene));
  }
  if (suite.environments.size() == 1) {
    const SceneFrame& frame = suite.environments.front().frame;
    if (frame.up) command += fmt::format(" --up {}", name_of(*frame.up, words(*frame.up)));
    if (frame.floor_z_m) command += fmt::format(" --floor-z {}", *frame.floor_z_m);
  }
  command += fmt::format(" --trials {}", suite.trials);
  if (suite.max_frames) command += fmt::format(" --frames {}", *suite.max_frames);
  for (const auto& [name, value] : suite.set)
    command += " --set " + shell_quoted(fmt::format("{}={}", name, value));
  Json seeds = Json::array(), inputs = Json::object(), files = Json::object();
  for (int trial = 0; trial < suite.trials; ++trial)
    seeds.push_back(suite.seed + static_cast<std::uint64_t>(trial));
  for (const RunResult& run : runs)
    for (const InputDigest& input : run.place.inputs)
      inputs[run.spec.environment.name][input.name] = hex(input.digest);
  for (const RunResult& run : runs)
    for (const InputDigest& input : run.place.inputs)
      for (const FileDigest& file : input.files)
        files[run.spec.environment.name][input.name][file.file] = hex(file.digest);
  return {{"command", command},         {"commit", built_commit()},
          {"code", code_of_run()},      {"build_and_machine", fingerprint_json()},
          {"suite", suite_json(suite)}, {"seeds", seeds},
          {"inputs", inputs},           {"files", files}};
}

Json times_json(std::span<const RunResult> runs) {
  Json list = Json::array();
  for (const RunResult& run : runs) {
    const auto calls = [](const std::vector<double>& times_ms) -> Json {
      if (times_ms.empty()) return nullptr;
      const TimeSummary t = summarize(times_ms);
      return {{"median", t.median_ms}, {"p95", t.p95_ms}};
    };
    list.push_back({{"name", run.spec.name},
                    {"wall_s", run.wall_s},
                    {"host", run.circumstances.host},
                    {"session_start", run.circumstances.session_start},
                    {"jobs", run.circumstances.jobs},
                    {"load_per_processor", run.circumstances.load},
                    {"track_ms", calls(run.times.track_ms)},
                    {"relocalize_ms", calls(run.times.relocalize_ms)},
                    {"blank_ms", calls(run.times.blank_ms)}});
  }
  return {{"fingerprint", fingerprint_json()}, {"runs", list}};
}

}  // namespace mh
