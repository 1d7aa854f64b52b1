// SPDX-License-Identifier: Apache-2.0
#include "bench/report/episodes_report.hpp"

#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/protocol/query_means.hpp"
#include "bench/report/text_table.hpp"
#include "bench/results/graded.hpp"
#include "bench/results/statistics.hpp"
#include "bench/suite/json_fields.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// Counts failures by their reason.
std::map<std::string, std::size_t> reasons_of(const std::vector<EpisodeScore>& episodes) {
  std::map<std::string, std::size_t> reasons;
  for (const EpisodeScore& e : episodes)
    if (!e.success) ++reasons[e.reason];
  return reasons;
}

/// The number of episodes that corresponds to a share in a summary.
long number(const EpisodeSummary& s, double share) {
  return std::lround(share * s.count);
}

/// Paired differences of two systems in one variant. Starts are paired; with several scenes, scenes
/// are the clusters.
std::vector<Comparison> comparisons_of(const Suite& suite, std::span<const RunResult> runs,
                                       const SystemPair& pair, const std::string& variant) {
  const std::string& first = suite.systems[pair.first].name;
  const std::string& second = suite.systems[pair.second].name;
  const auto compared = [&](const char* measure, bool shares, auto&& value) {
    std::vector<std::vector<PairedDifference>> places;
    for (const Environment& environment : suite.environments) {
      std::map<std::size_t, std::optional<double>> of_first, of_second;
      for (const RunResult& run : runs) {
        if (run.spec.environment.name != environment.name) continue;
        for (const EpisodeScore& e : run.episodes) {
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

std::vector<EpisodeScore> episodes_of(std::span<const RunResult> runs, const std::string& system,
                                      const std::string& variant) {
  std::vector<EpisodeScore> episodes;
  for (const RunResult& run : runs)
    if (run.spec.system.name == system)
      for (const EpisodeScore& e : run.episodes)
        if (e.variant == variant) episodes.push_back(e);
  return episodes;
}

std::string episodes_table(const Suite& suite, std::span<const RunResult> runs) {
  if (!suite.episodes) return "";
  TextTable table({"variant", "system", "success", "95 %", "located", "median s", "SPL", "collided",
                   "worst m/s", "wrong arrivals"},
                  2);
  for_each_row(suite, [&](const std::string& variant, const std::string& system) {
    const std::vector<EpisodeScore> episodes = episodes_of(runs, system, variant);
    const EpisodeSummary s = summarize(episodes);
    const auto [low, high] = wilson(s.success * s.count, s.count);
    std::vector<std::string> reasons;
    for (const auto& [reason, count] : reasons_of(episodes))
      reasons.push_back(fmt::format("{} {}", count, reason));
    table.add(
        {variant, system, fmt::format("{}/{}", number(s, s.success), s.count),
         fmt::format("{:.0f}-{:.0f} %", 100 * low, 100 * high),
         std::to_string(number(s, s.located)),
         s.median_s ? fmt::format("{:.1f}", *s.median_s) : "-", fmt::format("{:.2f}", s.spl),
         std::to_string(number(s, s.collided)), fmt::format("{:.2f}", s.worst_contact_m_per_s),
         std::to_string(number(s, s.wrong_arrivals))},
        fmt::format("{}", fmt::join(reasons, ", ")));
  });
  std::string text = fmt::format("\n{}: {} in {}, the same for each system\n\n{}", suite.name,
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

Json episodes_json(const Suite& suite, std::span<const RunResult> runs) {
  Json summary = Json::array(), comparisons = Json::array();
  for_each_row(suite, [&](const std::string& variant, const std::string& system) {
    const std::vector<EpisodeScore> episodes = episodes_of(runs, system, variant);
    const EpisodeSummary s = summarize(episodes);
    const auto [low, high] = wilson(s.success * s.count, s.count);
    summary.push_back({{"variant", variant},
                       {"system", system},
                       {"episodes", episodes.size()},
                       {"successes", number(s, s.success)},
                       {"low", json_of(low)},
                       {"high", json_of(high)},
                       {"located", number(s, s.located)},
                       {"median_time_s", json_of(s.median_s)},
                       {"spl", json_of(s.spl)},
                       {"collided", number(s, s.collided)},
                       {"worst_contact_m_per_s", json_of(s.worst_contact_m_per_s)},
                       {"wrong_arrivals", number(s, s.wrong_arrivals)},
                       {"reasons", reasons_of(episodes)}});
  });
  for (const SystemPair& pair : suite.compare)
    for (const EpisodeVariant& variant : suite.episodes->variants)
      for (const Comparison& c : comparisons_of(suite, runs, pair, variant.name))
        comparisons.push_back(json_of_comparison(c));
  return {{"summary", summary}, {"comparisons", comparisons}};
}

}  // namespace mh
