// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/write.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/report/graded_report.hpp"
#include "bench/report/pages/curves.hpp"
#include "bench/report/pages/headlines.hpp"
#include "bench/report/pages/page_table.hpp"
#include "bench/report/pages/place_images.hpp"
#include "bench/report/pages/run_page.hpp"
#include "bench/report/pages/tables.hpp"
#include "bench/report/pages/verdict.hpp"
#include "bench/report/results_table.hpp"
#include "bench/report/suite_json.hpp"
#include "bench/suite/parameters.hpp"
#include "bench/suite/run_spec.hpp"
#include "bench/suite/shipped.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kBundle[] = {"index.html", "app.js", "app.css", "replay.js", "LICENSES.txt"};
constexpr std::size_t kRunsOfFile = 40;  ///< number of runs whose paths share a file

/// Writes pieces of data into files and counts them.
class Pieces {
 public:
  explicit Pieces(const fs::path& folder) : folder_(folder) { make_output_folder(folder); }
  /// @param piece  "0/runs": the file 0-runs.js
  void put(const std::string& piece, const Json& json) {
    std::string file = piece + ".js";
    std::ranges::replace(file, '/', '-');
    const std::string text = script_of(piece, json);
    write_atomically(folder_ / file, text);
    bytes_ += text.size();
    ++files_;
  }
  std::size_t files() const { return files_; }
  std::uintmax_t bytes() const { return bytes_; }

 private:
  fs::path folder_;
  std::size_t files_ = 0;
  std::uintmax_t bytes_ = 0;
};

/// Removes the data of an earlier report, and no other file.
void remove_earlier_data(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (is_file(entry.path()) && is_script_of_data(read_file(entry.path())))
      fs::remove(entry.path(), error);
}

/// Reasons why the figures may not be those of the whole suite, which a reader must know first.
Json warnings_json(const PagesSource& source) {
  Json warnings = Json::array();
  if (!source.problem.empty()) warnings.push_back(source.problem);
  const BenchResults& r = source.results;
  if (std::ranges::any_of(r.runs, [](const RunResult& run) { return run.place.cut; }))
    warnings.push_back(fmt::format(
        "Shortened to the first {} of each tour: a quick look, no result of this suite.",
        counted(source.suite->max_frames.value_or(0), "frame")));
  if (!r.failed.empty())
    warnings.push_back(fmt::format("{} failed; the figures do not include them.",
                                   counted(r.failed.size(), "run")));
  if (const auto gave_up =
          std::ranges::count_if(r.runs, [](const RunResult& run) { return run.mapping.gave_up; });
      gave_up > 0)
    warnings.push_back(
        fmt::format("{} gave up mapping (protocol: max_effort) after going back too often; the "
                    "figures include what they mapped until then.",
                    counted(static_cast<std::size_t>(gave_up), "run")));
  if (!r.missing.empty())
    warnings.push_back(fmt::format("{} not made yet; the figures do not include them.",
                                   counted(r.missing.size(), "run")));
  if (source.reproduction.is_object() &&
      source.reproduction.value("commit", "").ends_with("-dirty"))
    warnings.push_back(fmt::format("Made by a program with changes that were not committed ({}).",
                                   source.reproduction.value("commit", "")));
  for (const std::string& file : source.damaged)
    warnings.push_back(fmt::format("{} is damaged and left out.", file));
  return warnings;
}

/// Notes on how the figures were made, for readers who want to know.
Json notes_json(const Suite& suite) {
  Json notes = Json::array();
  if (suite.trials == 1)
    notes.push_back("One trial: this holds for these maps; other seeds draw other maps.");
  if (std::ranges::any_of(suite.environments, &Environment::is_recorded))
    notes.push_back("Recordings have one noise: trials differ in RANSAC's draws alone.");
  for (const std::string& line : base_lines(suite)) notes.push_back(line);
  return notes;
}

/// The point that tables and figures show if the suite sweeps settings; otherwise null.
Json first_point(const PagesSource& source) {
  if (!source.suite || source.suite->sweep.points.empty()) return nullptr;
  return shown_point(source.suite->sweep, parameter_points(*source.suite).front());
}

Json levels_json(const Suite& suite) {
  Json levels = Json::array();
  for (const Level& level : suite.levels) levels.push_back(level_name(level));
  return levels;
}

/// The systems of a suite with the labels that each sees: a page gives each one color.
Json arms_json(const Suite& suite) {
  Json arms = Json::array();
  for (const Arm& arm : arms_of(suite))
    arms.push_back({{"system", suite.systems[arm.system].name}, {"labels", arm.labels}});
  return arms;
}

Json suite_facts(const Suite& suite) {
  Json systems = Json::array(), labels = Json::array();
  for (const SystemSpec& system : suite.systems) systems.push_back(system.name);
  for (const Labels& mode : suite.labels) labels.push_back(name(mode));
  return {{"name", suite.name},
          {"trials", suite.trials},
          {"environments", suite.environments.size()},
          {"systems", systems},
          {"labels", labels},
          {"levels", levels_json(suite)},
          {"measure", name(suite.measure)},
          {"settings", suite_json(suite)}};
}

void write_source(Pieces& pieces, const std::string& place, const PagesSource& source,
                  std::size_t moments) {
  Json overview = {{"warnings", warnings_json(source)}, {"notes", Json::array()}};
  Json figures = Json::object();
  if (source.suite) {
    const Suite& suite = *source.suite;
    const std::vector<Row> rows = make_rows(suite, source.results.runs, source.results.failed);
    const std::vector<CategoryRow> categories = make_category_rows(suite, rows);
    overview["suite"] = suite_facts(suite);
    overview["notes"] = notes_json(suite);
    overview["definitions"] = definitions_text(suite);
    overview["verdicts"] = verdicts_json(suite, rows);
    overview["tiles"] = tiles_json(suite, rows, categories);
    overview["table1"] = table1_json(suite, categories);
    overview["table2"] = table2_json(suite, categories);
    overview["published_ate"] = published_ate_json(suite, rows);
    if (overview["table2"].is_null())
      overview["table2"] = episodes_page_json(suite, source.results.runs);
    figures = {{"candidates", candidates_json(suite, categories)},
               {"density", density_json(suite, rows)},
               {"by_frame", error_by_frame_json(suite, rows)},
               {"sweep", sweep_pages_json(suite, rows)},
               {"graded", graded_json(suite, rows)}};
  }
  pieces.put(place + "/overview", overview);
  pieces.put(place + "/place", place_images_json(source));
  pieces.put(place + "/figures", figures);
  pieces.put(place + "/runs", runs_json(source));
  pieces.put(place + "/queries", queries_json(source));
  pieces.put(place + "/audit", audit_tables_json(source));
  pieces.put(place + "/reproduction", source.reproduction);
  std::size_t next = 0;
  for (const auto& [name, replay] : source.replay_of) {
    pieces.put(fmt::format("{}/replay{}", place, next), replay);
    if (const auto views = source.views_of.find(name); views != source.views_of.end())
      pieces.put(fmt::format("{}/views{}", place, next), views->second);
    ++next;
  }
  const std::vector<RunResult>& runs = source.results.runs;
  for (std::size_t first = 0; first < runs.size(); first += kRunsOfFile) {
    Json list = Json::array();
    for (std::size_t i = first; i < std::min(first + kRunsOfFile, runs.size()); ++i)
      list.push_back(run_page_json(source, runs[i], moments));
    pieces.put(fmt::format("{}/paths{}", place, first / kRunsOfFile), list);
  }
}

}  // namespace

fs::path bundle_folder() {
  return data_folder() / "bench/report/pages/bundle";
}

std::string digest_of_web(const fs::path& web) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(web)) {
    const std::string name = entry.path().lexically_relative(web).generic_string();
    if (entry.is_regular_file() && !name.starts_with("node_modules/")) names.push_back(name);
  }
  std::ranges::sort(names);
  std::uint64_t sum = 0xcbf29ce484222325;
  const auto add = [&](const std::string& text) {
    for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  };
  for (const std::string& name : names) {
    add(name + "\n");
    add(read_file(web / name));
  }
  return fmt::format("{:016x}", sum);
}

std::vector<std::string> names_of_pages() {
  std::vector<std::string> names{std::begin(kBundle), std::end(kBundle)};
  names.emplace_back("data");
  return names;
}

WrittenPages write_pages(const fs::path& out, std::span<const PagesSource> sources,
                         std::size_t budget) {
  make_output_folder(out);
  remove_earlier_data(out / "data");
  Pieces pieces(out / "data");
  std::size_t runs = 0;
  for (const PagesSource& source : sources) runs += source.results.runs.size();
  Json folders = Json::array();
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const PagesSource& source = sources[s];
    write_source(pieces, std::to_string(s), source, moments_for(runs, budget));
    Json replays = Json::array();
    for (const auto& [name, replay] : source.replay_of) replays.push_back(name);
    Json views = Json::array();
    for (const auto& [name, view] : source.views_of) views.push_back(name);
    folders.push_back({{"name", source.name},
                       {"problem", source.problem.empty() ? Json() : Json(source.problem)},
                       {"suite", source.suite ? Json(source.suite->name) : Json()},
                       {"runs", source.results.runs.size()},
                       {"failed", source.results.failed.size()},
                       {"missing", source.results.missing.size()},
                       {"audit", source.audit.is_object()},
                       {"damaged", source.damaged},
                       {"first_point", first_point(source)},
                       {"runs_of_file", kRunsOfFile},
                       {"arms", source.suite ? arms_json(*source.suite) : Json::array()},
                       {"levels", source.suite ? levels_json(*source.suite) : Json::array()},
                       {"replays", std::move(replays)},
                       {"views", std::move(views)}});
  }
  pieces.put("index", {{"format", "modelhouse-report-1"}, {"folders", folders}});
  WrittenPages written{out / "index.html", pieces.files(), pieces.bytes()};
  for (const char* file : kBundle) {
    const std::string content = read_file(bundle_folder() / file);
    write_atomically(out / file, content);  // after the data, which index.html needs
    written.bytes += content.size();
    ++written.files;
  }
  return written;
}

}  // namespace mh
