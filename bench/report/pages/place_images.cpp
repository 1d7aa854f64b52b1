// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/place_images.hpp"

#include <algorithm>
#include <string_view>

#include "bench/protocol/usable_frame.hpp"
#include "bench/report/packed.hpp"
#include "bench/report/pages/run_page.hpp"
#include "bench/report/pages/tables.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPlans = 6;
constexpr std::size_t kMoments = 600;  ///< poses of a path that is drawn small
constexpr int kFrameWidth_px = 320;
constexpr std::size_t kFrames = 4;

/// A run's drawing with its queries (if it has a second tour, the queries of that tour); empty if
/// there is no drawing.
std::string plan_of(const PagesSource& source, const RunResult& run) {
  constexpr std::uintmax_t kLargest = 2'000'000;
  constexpr std::string_view kPng = "\x89PNG";
  if (source.folder.empty()) return "";
  // The folder may contain files of a different run.
  if (is_file(source.folder / run.spec.name / "map.yaml") && !grid_of(source, run)) return "";
  for (const char* name : {"topdown_second_tour.png", "topdown.png"}) {
    const fs::path file = source.folder / run.spec.name / name;
    if (!is_file(file) || fs::file_size(file) > kLargest) continue;
    if (std::string content = read_file(file); content.starts_with(kPng)) return content;
  }
  return "";
}

/// For each arm (system and labels), its first trial in the environment and at the level of `like`.
std::vector<const RunResult*> side_by_side(const Suite& suite, const std::vector<RunResult>& runs,
                                           const RunResult& like) {
  std::vector<const RunResult*> found;
  for (const Arm& arm : arms_of(suite))
    for (const RunResult& run : runs)
      if (run.spec.environment.name == like.spec.environment.name &&
          run.spec.level == like.spec.level &&
          run.spec.system.name == suite.systems[arm.system].name &&
          (arm.labels == "none" || name(run.spec.labels) == arm.labels)) {
        found.push_back(&run);
        break;
      }
  return found;
}

/// Whether an input is still the one that the environment's runs used.
bool is_of_results(const InputDigest& input, const std::string& environment,
                   const std::vector<RunResult>& runs) {
  return std::ranges::none_of(runs, [&](const RunResult& run) {
    return run.spec.environment.name == environment &&
           std::ranges::any_of(run.place.inputs, [&](const InputDigest& used) {
             return used.name == input.name && used.digest != input.digest;
           });
  });
}

}  // namespace

Json place_images_json(const PagesSource& source) {
  if (!source.suite) return nullptr;
  const std::vector<RunResult>& runs = source.results.runs;
  Json plans = Json::array();
  const auto drawn = std::ranges::find_if(
      runs, [&](const RunResult& run) { return !plan_of(source, run).empty(); });
  if (drawn != runs.end())
    for (const RunResult* run : side_by_side(*source.suite, runs, *drawn))
      if (const std::string png = plan_of(source, *run); !png.empty() && plans.size() < kMostPlans)
        plans.push_back({{"run", run->spec.name},
                         {"system", run->spec.system.name},
                         {"labels", run->spec.system.sees_labels() ? name(run->spec.labels) : ""},
                         {"environment", run->spec.environment.name},
                         {"png", base64(png)}});
  const auto has_path = [](const RunResult& run) {
    return !run.truth.empty() || !run.estimate.empty();
  };
  const auto run = std::ranges::find_if(runs, has_path);
  const bool draws = plans.empty() && run != runs.end();
  if (plans.empty() && !draws && source.frames.is_null()) return nullptr;
  return {{"plans", std::move(plans)},
          {"run", draws ? run_page_json(source, *run, kMoments) : Json()},
          {"queries", draws ? queries_json(source, &*run) : Json()},
          {"frames", source.frames}};
}

Json frames_json(const PagesSource& source) {
  const Suite& suite = *source.suite;
  const auto recorded = std::ranges::find_if(suite.environments, &Environment::is_recorded);
  if (recorded == suite.environments.end()) return nullptr;
  Json list = Json::array();
  std::string problem;
  try {
    std::vector<InputDigest> now;
    const OpenedRecording opened =
        noted(now, "sequence", split_sequence(recorded->sequence).second,
              [&] { return open_recorded(*recorded, recorded->sequence, false); });
    if (!is_of_results(now.front(), recorded->name, source.results.runs))
      throw InputError("has changed since these results were made");
    const std::size_t size =
        std::min(opened.sequence->size(), suite.max_frames.value_or(opened.sequence->size()));
    for (std::size_t k = 0; k < kFrames && k < size; ++k) {
      const std::size_t i = k * (size - 1) / std::max<std::size_t>(1, kFrames - 1);
      try {
        const RgbdFrame frame = usable_frame(*opened.sequence, i, RandomStream(0));
        list.push_back({{"frame", i}, {"jpeg", small_jpeg(frame.color, kFrameWidth_px)}});
      } catch (const UnusableFrame&) {  // the next one may be usable
      }
    }
    if (list.empty()) problem = "none of the frames that were tried can be read";
  } catch (const InputError& error) {
    problem = without_place(error.what(), recorded->sequence);
  }
  return {{"environment", recorded->name},
          {"problem", problem.empty() ? Json() : Json(problem)},
          {"list", std::move(list)}};
}

}  // namespace mh
