// SPDX-License-Identifier: Apache-2.0
#include "bench/results/gate/baseline.hpp"

#include <cmath>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_number.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

Json run_json(const RunFigures& run) {
  Json values = Json::object();
  for (const auto& [name, value] : run.values)
    values[name] = value && std::isfinite(*value) ? Json(*value) : Json();
  return {{"scenario", run.scenario},
          {"system", run.system},
          {"seed", run.seed},
          {"digest", run.digest},
          {"values", values}};
}

RunFigures read_run(const Json& json) {
  RunFigures run{.scenario = json.at("scenario").get<std::string>(),
                 .system = json.at("system").get<std::string>(),
                 .seed = whole_number<std::uint64_t>(json.at("seed")),
                 .digest = json.at("digest").get<std::string>()};
  for (const auto& [name, value] : json.at("values").items())
    run.values[name] = value.is_null() ? std::nullopt : std::optional(value.get<double>());
  return run;
}

Baseline read(const Json& json) {
  Baseline baseline{.suite = json.at("suite").get<std::string>(),
                    .suite_digest = json.at("suite_digest").get<std::string>(),
                    .origin = json.at("origin"),
                    .settings = json.value("settings", Json())};
  for (const Json& run : json.at("runs")) baseline.runs.push_back(read_run(run));
  return baseline;
}

}  // namespace

std::vector<std::string> changed_settings(const Baseline& before, const Baseline& now) {
  std::vector<std::string> changed;
  if (before.settings.is_null()) return changed;
  const auto old_ones = before.settings.flatten(), new_ones = now.settings.flatten();
  const auto shown = [](const Json& all, const std::string& key) {
    return all.contains(key) ? all.at(key).dump() : std::string("none");
  };
  const auto note = [&](const std::string& key) {
    std::string path = key.substr(1);  // a JSON pointer: ~1 stands for a slash, ~0 for a tilde
    for (const auto& [escape, meant] : {std::pair("~1", "/"), std::pair("~0", "~")})
      for (auto at = path.find(escape); at != std::string::npos; at = path.find(escape, at + 1))
        path.replace(at, 2, meant);
    changed.push_back(
        fmt::format("{}: {} -> {}", path, shown(old_ones, key), shown(new_ones, key)));
  };
  for (const auto& [key, value] : old_ones.items())
    if (shown(new_ones, key) != value.dump()) note(key);
  for (const auto& [key, value] : new_ones.items())
    if (!old_ones.contains(key)) note(key);
  return changed;
}

std::string to_text(const Baseline& baseline) {
  std::string text = fmt::format(
      "{{\n\"format\": \"{}\",\n\"suite\": {},\n\"suite_digest\": {},\n\"origin\": {},\n"
      "{}\"runs\": [",
      kBaselineFormat, Json(baseline.suite).dump(), Json(baseline.suite_digest).dump(),
      baseline.origin.dump(2),
      baseline.settings.is_null() ? std::string()
                                  : fmt::format("\"settings\": {},\n", baseline.settings.dump(2)));
  for (std::size_t i = 0; i < baseline.runs.size(); ++i)
    text += (i == 0 ? "\n" : ",\n") + run_json(baseline.runs[i]).dump();
  return text + "\n]\n}\n";
}

void save_baseline(const Baseline& baseline, const std::filesystem::path& file) {
  write_atomically(file, to_text(baseline));
}

bool is_baseline(const std::string& text) {
  const Json json = parse_json_or_discard<Json>(text);
  return json.is_object() && json.contains("format") && json["format"].is_string() &&
         json["format"].get<std::string>().starts_with("modelhouse-baseline-");
}

Baseline load_baseline(const std::filesystem::path& file) {
  const Json json = parse_json_or_discard<Json>(read_text(file));
  if (!json.is_object() || !json.contains("format") || !json["format"].is_string())
    throw InputError(
        fmt::format("{}: is not a baseline: it should be JSON as `modelhouse check "
                    "--update` writes it",
                    file.string()));
  const auto format = json["format"].get<std::string>();
  if (format != kBaselineFormat)
    throw InputError(fmt::format("{}: format: '{}' is not '{}', which this program reads",
                                 file.string(), format, kBaselineFormat));
  try {
    return read(json);
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{}: is damaged: {}", file.string(), json_fault(e)));
  } catch (const InputError& e) {  // a number in it is invalid
    throw InputError(fmt::format("{}: is damaged: {}", file.string(), e.what()));
  }
}

void check_suite(const Baseline& baseline, const std::filesystem::path& file,
                 const std::string& suite, const std::string& suite_digest) {
  if (baseline.suite != suite)
    throw InputError(fmt::format("{}: suite: is a baseline of the suite '{}', not of '{}'",
                                 file.string(), baseline.suite, suite));
  if (baseline.suite_digest != suite_digest)
    throw InputError(fmt::format(
        "{}: suite_digest: '{}' was made before the suite's scenes, tours, systems, seeds, "
        "protocol or --frames changed (now '{}'): look at the change, then run with --update",
        file.string(), baseline.suite_digest, suite_digest));
}

}  // namespace mh
