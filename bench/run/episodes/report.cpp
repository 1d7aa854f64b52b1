// SPDX-License-Identifier: Apache-2.0
#include "bench/run/episodes/report.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/report/text_table.hpp"
#include "bench/results/graded.hpp"
#include "bench/results/statistics.hpp"
#include "bench/suite/json_fields.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// What is said of one system in one variant, over all environments.
struct EpisodeSummary {
  std::size_t episodes = 0, successes = 0, collided = 0, wrong = 0, located = 0;
  double spl = 0;            ///< mean
  double worst_m_per_s = 0;  ///< contact
  std::vector<double> times_s;
  std::map<std::string, std::size_t> reasons;
};

EpisodeSummary summary_of(const std::vector<EpisodeRun>& runs, const std::string& system,
                          const std::string& variant) {
  EpisodeSummary s;
  for (const EpisodeRun& run : runs)
    for (const EpisodeScore& e : run.scores) {
      if (run.spec.system.name != system || e.variant != variant) continue;
      ++s.episodes;
      s.spl += e.spl;
      s.collided += e.collisions > 0 ? 1 : 0;
      s.wrong += e.wrong_arrival ? 1 : 0;
      s.located += e.located_s ? 1 : 0;
      s.worst_m_per_s = std::max(s.worst_m_per_s, e.worst_contact_m_per_s);
      if (e.success) {
        ++s.successes;
        s.times_s.push_back(e.time_s);
      } else {
        ++s.reasons[e.reason];
      }
    }
  if (s.episodes > 0) s.spl /= static_cast<double>(s.episodes);
  return s;
}

std::string reasons_text(const EpisodeSummary& s) {
  std::vector<std::string> parts;
  for (const auto& [reason, count] : s.reasons)
    parts.push_back(fmt::format("{} {}", count, reason));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Paired differences of two systems in one variant: over scenes as clusters if there are several,
/// else over the starts of one place.
std::vector<Comparison> comparisons_of(const Suite& suite, const std::vector<EpisodeRun>& runs,
                                       const SystemPair& pair, const std::string& variant) {
  const std::string& first = suite.systems[pair.first].name;
  const std::string& second = suite.systems[pair.second].name;
  const auto compared = [&](const char* measure, bool shares, auto&& value) {
    std::vector<std::vector<PairedDifference>> places;
    for (const Environment& environment : suite.environments) {
      std::map<std::size_t, std::optional<double>> of_first, of_second;
      for (const EpisodeRun& run : runs) {
        if (run.spec.environment.name != environment.name) continue;
        for (const EpisodeScore& e : run.scores) {
          if (e.variant != variant) continue;
          if (run.spec.system.name == first) of_first[e.start] = value(e);
          if (run.spec.system.name == second) of_second[e.start] = value(e);
        }
      }
      places.emplace_back();
      for (const auto& [start, a] : of_first)
        if (const auto b = of_second.find(start); b != of_second.end())
          places.back().push_back(paired_difference(a, b->second));
    }
    Comparison c = places.size() == 1 ? compare_paired(places.front(), shares, suite.seed)
                                      : compare_clusters(places, shares, suite.seed);
    c.what = {measure, "", fmt::format("{}: {} - {}", variant, first, second), ""};
    return c;
  };
  std::vector<Comparison> list{
      compared("success", true,
               [](const EpisodeScore& e) { return std::optional(e.success ? 1.0 : 0.0); }),
      compared("SPL", false, [](const EpisodeScore& e) { return std::optional(e.spl); })};
  holm(list);
  return list;
}

Json json_of_comparison(const Comparison& c) {
  return {{"what", c.what.text()},
          {"pairs", c.pairs},
          {"difference", json_of(c.difference)},
          {"low", json_of(c.low)},
          {"high", json_of(c.high)},
          {"p", json_of(c.p)},
          {"p_holm", json_of(c.p_holm)}};
}

template <class Visit>
void for_each_row(const Suite& suite, Visit visit) {
  for (const EpisodeVariant& variant : suite.episodes->variants)
    for (const SystemSpec& system : suite.systems) visit(variant.name, system.name);
}

}  // namespace

std::string episodes_table(const Suite& suite, const std::vector<EpisodeRun>& runs) {
  TextTable table({"variant", "system", "success", "95 %", "located", "median s", "SPL", "collided",
                   "worst m/s", "wrong arrivals"},
                  2);
  for_each_row(suite, [&](const std::string& variant, const std::string& system) {
    const EpisodeSummary s = summary_of(runs, system, variant);
    const auto [low, high] =
        wilson(static_cast<double>(s.successes), static_cast<double>(s.episodes));
    table.add({variant, system, fmt::format("{}/{}", s.successes, s.episodes),
               fmt::format("{:.0f}-{:.0f} %", 100 * low, 100 * high), std::to_string(s.located),
               s.times_s.empty() ? "-" : fmt::format("{:.1f}", median(s.times_s)),
               fmt::format("{:.2f}", s.spl), std::to_string(s.collided),
               fmt::format("{:.2f}", s.worst_m_per_s), std::to_string(s.wrong)},
              reasons_text(s));
  });
  std::string text = fmt::format("{}: {} in {}, the same for each system\n\n{}", suite.name,
                                 counted(suite.episodes->starts, "kidnapping"),
                                 counted(suite.environments.size(), "environment"), table.text());
  for (const SystemPair& pair : suite.compare)
    for (const EpisodeVariant& variant : suite.episodes->variants) {
      text += "\n";
      for (const Comparison& c : comparisons_of(suite, runs, pair, variant.name))
        text += fmt::format("  {}: {:+.3f} ({:+.3f} to {:+.3f}), {} pairs, p {:.3f}, Holm {:.3f}\n",
                            c.what.text(), c.difference, c.low, c.high, c.pairs, c.p, c.p_holm);
    }
  return text;
}

Json episodes_json(const Suite& suite, const std::vector<EpisodeRun>& runs) {
  Json json = {{"suite", suite.name},
               {"summary", Json::array()},
               {"comparisons", Json::array()},
               {"runs", Json::array()}};
  for_each_row(suite, [&](const std::string& variant, const std::string& system) {
    const EpisodeSummary s = summary_of(runs, system, variant);
    const auto [low, high] =
        wilson(static_cast<double>(s.successes), static_cast<double>(s.episodes));
    json["summary"].push_back(
        {{"variant", variant},
         {"system", system},
         {"episodes", s.episodes},
         {"successes", s.successes},
         {"low", json_of(low)},
         {"high", json_of(high)},
         {"located", s.located},
         {"median_time_s", s.times_s.empty() ? Json() : json_of(median(s.times_s))},
         {"spl", json_of(s.spl)},
         {"collided", s.collided},
         {"worst_contact_m_per_s", json_of(s.worst_m_per_s)},
         {"wrong_arrivals", s.wrong},
         {"reasons", s.reasons}});
  });
  for (const SystemPair& pair : suite.compare)
    for (const EpisodeVariant& variant : suite.episodes->variants)
      for (const Comparison& c : comparisons_of(suite, runs, pair, variant.name))
        json["comparisons"].push_back(json_of_comparison(c));
  for (const EpisodeRun& run : runs) {
    Json episodes = Json::array();
    for (const EpisodeScore& score : run.scores) episodes.push_back(json_of(score));
    json["runs"].push_back({{"name", run.spec.name},
                            {"environment", run.spec.environment.name},
                            {"system", run.spec.system.name},
                            {"key", run.key},
                            {"episodes", episodes}});
    if (!run.failure.empty()) json["runs"].back()["failure"] = run.failure;
  }
  return json;
}

std::string write_episodes(const std::filesystem::path& out, const Suite& suite,
                           const std::vector<EpisodeRun>& runs) {
  const std::string table = episodes_table(suite, runs);
  write_atomically(out / "table.txt", table);
  write_atomically(out / "episodes.json", episodes_json(suite, runs).dump(1) + "\n");
  return table;
}

}  // namespace mh
