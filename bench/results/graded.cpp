// SPDX-License-Identifier: Apache-2.0
#include "bench/results/graded.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace mh {
namespace {

/// A quantity that queries are graded by.
struct Axis {
  const char *by, *unit;
  std::optional<double> QueryGrade::*value;
  std::vector<double> edges;
};

/// The rows of one level and one kind of labels at the first parameter point, by system and scene.
struct Block {
  std::size_t level = 0;
  Labels labels;
  std::vector<std::vector<const Row*>> systems;
};

std::vector<Block> blocks_of(const Suite& suite, std::span<const Row> rows) {
  std::vector<Block> blocks;
  for (const Row& row : rows) {
    if (row.parameters != 0 || row.trials.empty() || row.graded.queries == 0) continue;
    auto block = std::ranges::find_if(
        blocks, [&](const Block& b) { return b.level == row.level && b.labels == row.labels; });
    if (block == blocks.end())
      block = blocks.insert(
          blocks.end(), {row.level, row.labels,
                         std::vector(suite.systems.size(),
                                     std::vector<const Row*>(suite.environments.size(), nullptr))});
    block->systems[row.system][row.environment] = &row;
  }
  return blocks;
}

/// The answers to one query, summed over the trials.
struct Answers {
  double trials = 0, success = 0, correct = 0, false_positive = 0;
};

/// A row's answers to the queries of a bin, by the query's index.
std::map<std::size_t, Answers> answers_in(const Row& row, const Axis& axis, std::size_t bin) {
  std::map<std::size_t, Answers> found;
  for (const Trial& trial : row.trials)
    for (const QueryScore& q : trial.point->graded) {
      const std::optional<double>& value = q.grade.*axis.value;
      if (!value || bin_of(axis.edges, *value) != bin) continue;
      Answers& answers = found[q.answer.index];
      ++answers.trials;
      answers.success += q.success;
      answers.correct += q.correct;
      answers.false_positive += q.false_positive;
    }
  return found;
}

GradedShare share_of(const Answers& sum) {
  const auto [low, high] = wilson(sum.success, sum.trials);
  return {sum.success / sum.trials, sum.correct / sum.trials, sum.false_positive / sum.trials, low,
          high};
}

std::vector<PairedDifference> paired(const std::map<std::size_t, Answers>& first,
                                     const std::map<std::size_t, Answers>& second) {
  std::vector<PairedDifference> pairs;
  for (const auto& [query, a] : first)
    if (const auto b = second.find(query); b != second.end())
      pairs.push_back({a.success / a.trials - b->second.success / b->second.trials, true});
  return pairs;
}

std::optional<Comparison> compare(const std::vector<std::vector<PairedDifference>>& scenes,
                                  std::uint64_t seed) {
  constexpr std::size_t kFewestClusters = 4;
  std::vector<PairedDifference> all;
  for (const auto& scene : scenes) all.insert(all.end(), scene.begin(), scene.end());
  if (all.empty()) return std::nullopt;
  return scenes.size() >= kFewestClusters ? compare_clusters(scenes, true, seed)
                                          : compare_paired(all, true, seed);
}

GradedBin bin_in(const Suite& suite, const Block& block, const std::vector<std::size_t>& scenes,
                 const Axis& axis, std::size_t index) {
  GradedBin bin{.low = axis.edges[index], .high = axis.edges[index + 1]};
  std::vector<std::vector<std::map<std::size_t, Answers>>> found(suite.systems.size());
  for (std::size_t s = 0; s < suite.systems.size(); ++s) {
    Answers sum;
    std::size_t queries = 0;
    for (const std::size_t e : scenes) {
      const Row* row = block.systems[s][e];
      found[s].push_back(row != nullptr ? answers_in(*row, axis, index)
                                        : std::map<std::size_t, Answers>());
      queries += found[s].back().size();
      for (const auto& [query, a] : found[s].back()) {
        sum.trials += a.trials;
        sum.success += a.success;
        sum.correct += a.correct;
        sum.false_positive += a.false_positive;
      }
    }
    bin.queries = std::max(bin.queries, queries);
    bin.systems.push_back(sum.trials > 0 ? std::optional(share_of(sum)) : std::nullopt);
  }
  if (suite.compare.empty()) return bin;
  const SystemPair& pair = suite.compare.front();
  std::vector<std::vector<PairedDifference>> differences;
  for (std::size_t i = 0; i < scenes.size(); ++i)
    if (auto pairs = paired(found[pair.first][i], found[pair.second][i]); !pairs.empty())
      differences.push_back(std::move(pairs));
  bin.difference = compare(differences, suite.seed);
  return bin;
}

/// The edges of bins around each speed that was used; none if there is only one speed.
std::vector<double> edges_of_speeds(const std::vector<double>& speeds) {
  std::set<double> sorted(speeds.begin(), speeds.end());
  std::vector<double> edges;
  if (sorted.size() < 2) return edges;
  for (auto next = std::next(sorted.begin()); next != sorted.end(); ++next)
    edges.push_back(0.5 * (*std::prev(next) + *next));
  edges.insert(edges.begin(), 2 * *sorted.begin() - edges.front());
  edges.push_back(2 * *sorted.rbegin() - edges.back());
  return edges;
}

GradedCurve curve(const Suite& suite, const Block& block, const std::string& category,
                  const Axis& axis) {
  GradedCurve made{block.level, block.labels, category, axis.by, axis.unit, {}};
  std::vector<std::size_t> scenes;
  for (std::size_t e = 0; e < suite.environments.size(); ++e)
    if (category == kAllCategories || suite.environments[e].category == category)
      scenes.push_back(e);
  for (std::size_t b = 0; b < bins(axis.edges); ++b)
    made.bins.push_back(bin_in(suite, block, scenes, axis, b));
  return made;
}

}  // namespace

std::pair<double, double> wilson(double successes, double count) {
  if (count <= 0) return {0, 1};
  constexpr double kZ = 1.959964;
  const double p = successes / count, z2 = kZ * kZ;
  const double middle = (p + z2 / (2 * count)) / (1 + z2 / count);
  const double half =
      kZ / (1 + z2 / count) * std::sqrt(p * (1 - p) / count + z2 / (4 * count * count));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::vector<GradedCurve> graded_curves(const Suite& suite, std::span<const Row> rows) {
  std::vector<GradedCurve> curves;
  if (!suite.graded) return curves;
  const GradedSpec& graded = *suite.graded;
  const Axis distance{"distance", "m", &QueryGrade::mapped_m, graded.distance_m};
  const Axis angle{"angle", "deg", &QueryGrade::mapped_deg, graded.angle_deg};
  const Axis shown{"share of the view that was mapped",
                   "",
                   &QueryGrade::shown,
                   {0, 0.25, 0.5, 0.75, 1.0 + 1e-9}};
  const Axis speed{"speed", "x", &QueryGrade::speed, edges_of_speeds(graded.speed)};
  std::set<std::string> categories;
  for (const Environment& e : suite.environments) categories.insert(e.category);
  for (const Block& block : blocks_of(suite, rows)) {
    for (const Axis& axis : {distance, angle, shown, speed}) {
      GradedCurve made = curve(suite, block, std::string(kAllCategories), axis);
      std::erase_if(made.bins, [](const GradedBin& bin) { return bin.queries == 0; });
      if (!made.bins.empty()) curves.push_back(std::move(made));
    }
    if (categories.size() < 2) continue;
    for (const std::string& category : categories)
      curves.push_back(curve(suite, block, category, distance));
  }
  return curves;
}

GradedDraws graded_draws(const Suite& suite, std::span<const Row> rows) {
  GradedDraws draws;
  std::set<std::size_t> counted;
  for (const Row& row : rows)
    if (!row.trials.empty() && counted.insert(row.environment).second)
      for (const GradedCell& cell : row.trials.front().run->place.graded) {
        draws.asked += cell.asked;
        draws.hidden += cell.hidden;
        ++draws.cells;
        draws.short_cells += suite.graded && cell.asked < suite.graded->per_bin;
      }
  return draws;
}

}  // namespace mh
