// SPDX-License-Identifier: Apache-2.0
#include "bench/results/gate/from_runs.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "bench/results/rows.hpp"
#include "bench/suite/fingerprint.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/json_fields.hpp"
#include "slam/config/slam.hpp"
#include "slam/core/digest.hpp"

namespace mh {
namespace {

std::string run_digest(const RunResult& run) {
  std::uint64_t sum = digest(run.estimate);
  const auto add = [&](const auto& shown) {
    sum = chained(sum, shown.image_digest);
    sum = chained(sum, shown.matching_digest);
    sum = chained(sum, shown.pose_digest);
  };
  for (const MappedFrame& call : run.mapping.calls) add(call);
  for_each_query(run, [&](const QueryScore& q) { add(q.answer); });
  for (const EpisodeScore& episode : run.episodes) sum = chained(sum, episode.digest);
  return hex(sum);
}

/// "what=digest of content" for an input of a run and for every file that the input refers to. File
/// locations are left out, so moving a file changes nothing.
std::string content(std::string_view what, const std::filesystem::path& source,
                    const InputDigest& input) {
  if (is_generated(source)) {
    const std::string text = source.string();
    return fmt::format("{}={};", what, hex(digest_bytes(text.data(), text.size())));
  }
  std::string text;
  for (const FileDigest& file : input.files)
    text += file.file == source.filename()
                ? fmt::format("{}={};", what, hex(file.digest))
                : fmt::format("{}/{}={};", what, file.file, hex(file.digest));
  return text;
}

/// The contents of the sources of an environment or variant. An absent source adds nothing, so that
/// suites keep their baselines when a new kind of source is introduced.
/// @param input_of  returns the name that a source has among the inputs
template <class Of, class InputOf>
std::string contents(const Of& of, const std::vector<InputDigest>& inputs,
                     const InputOf& input_of) {
  std::string text;
  sources(of, [&](const WorldSource& source, const std::optional<std::filesystem::path>& path) {
    if (path)
      text += content(source.key, *path,
                      *std::ranges::find(inputs, input_of(source), &InputDigest::name));
  });
  return text;
}

/// The settings of episodes, and the contents of the sources of their variants.
std::string episodes_text(const EpisodesSpec& episodes, InputReader& reader) {
  nlohmann::ordered_json json = json_of(episodes);
  json.erase("variants");
  std::string text = fmt::format("episodes={};", json.dump());
  const std::vector<InputDigest> inputs = reader.inputs_of(episodes);
  for (const EpisodeVariant& variant : episodes.variants) {
    text += fmt::format("variant={};", variant.name);
    text += contents(variant, inputs,
                     [&](const WorldSource& source) { return input_name(variant, source); });
  }
  return text;
}

/// Everything that determines labels; for a kind of labels without settings, just its name.
std::string labels_text(const Labels& labels, InputReader& reader) {
  std::string text = fmt::format("labels={};", name(labels));
  if (labels.dials) text += fmt::format("dials={};", json_of(*labels.dials).dump());
  if (labels.detector)
    text += fmt::format(
        "{}settings={};",
        content("detector", source_of(*labels.detector), reader.detector(*labels.detector)),
        format_detector_settings(labels.detector->settings, false));
  return text;
}

}  // namespace

RunFigures figures(const RunResult& run) {
  const RunSpec& spec = run.spec;
  std::string system = spec.system.name;
  if (spec.labels != Labels()) system += fmt::format("-{}", name(spec.labels));
  RunFigures figures{.scenario = spec.environment.name,
                     .system = system + "-" + level_name(spec.level),
                     .seed = spec.seed,
                     .digest = run_digest(run),
                     .repeatable = spec.system.repeatable};
  if (run.points.empty()) return figures;
  // Figures that may be judged, and the denominators of shares.
  const std::vector<Figure> all = figures_of(run, 0);
  for (const Figure& figure : all)
    if (figure.metric.better != Better::kNeither || std::ranges::any_of(all, [&](const Figure& f) {
          return f.metric.count == figure.metric.name;
        }))
      figures.values[figure.metric.name] = figure.value;
  return figures;
}

std::vector<RunFigures> figures(std::span<const RunResult> runs) {
  std::vector<RunFigures> all;
  for (const RunResult& run : runs) all.push_back(figures(run));
  return all;
}

std::string gate_suite_digest(const Suite& suite, InputReader& reader) {
  std::string text = fmt::format(
      "trials={};seed={};frames={};protocol={};", suite.trials, suite.seed,
      suite.max_frames ? std::to_string(*suite.max_frames) : "all", json_of(suite.protocol).dump());
  if (suite.graded) text += fmt::format("graded={};", json_of(*suite.graded).dump());
  if (suite.episodes) text += episodes_text(*suite.episodes, reader);
  for (const SystemSpec& system : suite.systems) text += fmt::format("system={};", system.name);
  for (const Labels& labels : suite.labels) text += labels_text(labels, reader);
  for (const Sense sense : suite.senses)
    text += fmt::format("sense={};", name_of(sense, words(sense)));
  for (const auto& level : suite.levels)
    text += level.is_file() ? content(level_name(level), level.file, reader.level(level.file))
                            : level_name(level) + ";";
  for (const Environment& e : suite.environments) {
    const std::vector<InputDigest> inputs = reader.inputs_of(e);
    text += fmt::format("environment={};", e.name);
    if (e.is_recorded()) {
      for (const InputDigest& input : inputs)
        text += fmt::format("{}={};", input.name, hex(input.digest));
      continue;
    }
    text += contents(e, inputs, [](const WorldSource& source) { return source.key; });
    if (e.frame != SceneFrame{}) text += fmt::format("frame={};", json_of(e.frame).dump());
  }
  return hex(digest_bytes(text.data(), text.size()));
}

nlohmann::ordered_json gate_settings(const Suite& suite, InputReader& reader) {
  nlohmann::ordered_json settings = {{"slam", json_of(suite.slam)}};
  if (!suite.vocabulary.empty())
    settings["vocabulary"] = hex(reader.vocabulary(suite.vocabulary).files.front().digest);
  for (const SystemSpec& system : suite.systems)
    if (!system.is_outside())
      for (const auto& [setting, value] : system.settings)
        settings[system.name][setting] = value.as_string();
    else
      for (const InputDigest& file : reader.program(system))
        settings[system.name][file.name.substr(system.name.size() + 2)] = hex(file.digest);
  return settings;
}

nlohmann::ordered_json gate_origin() {
  nlohmann::ordered_json origin = fingerprint_json();
  origin["program"] = hex(digest_file("/proc/self/exe"));
  return origin;
}

}  // namespace mh
