// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/graded_spec.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "slam/io/counted.hpp"

namespace mh {
namespace {

constexpr std::size_t kMostQueries = 10000;

std::vector<double> read_edges(const YamlReader& node, double most) {
  const std::vector<double> edges = node.as_numbers();
  if (edges.size() < 2) node.fail("are the edges of bins: at least two are needed");
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i] < 0 || edges[i] > most)
      node.fail(fmt::format("{} is outside 0 to {}", edges[i], most));
    if (i > 0 && edges[i] <= edges[i - 1])
      node.fail(fmt::format("{} stands behind {}: edges grow", edges[i], edges[i - 1]));
  }
  return edges;
}

std::vector<double> read_speeds(const YamlReader& node) {
  std::vector<double> speeds = node.as_numbers();
  if (speeds.empty()) node.fail("is empty: at least one is needed");
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    if (speeds[i] < 0.1 || speeds[i] > 10)
      node.fail(fmt::format("{} is outside 0.1 to 10", speeds[i]));
    if (std::count(speeds.begin(), speeds.end(), speeds[i]) > 1)
      node.fail(fmt::format("{} stands twice", speeds[i]));
  }
  return speeds;
}

}  // namespace

std::size_t bin_of(const std::vector<double>& edges, double value) {
  const auto above = std::upper_bound(edges.begin(), edges.end(), value);
  return above == edges.begin() ? bins(edges) : static_cast<std::size_t>(above - edges.begin()) - 1;
}

GradedSpec read_graded(YamlReader node) {
  GradedSpec graded;
  graded.distance_m = read_edges(node.at("distance_m"), 100);
  graded.angle_deg = read_edges(node.at("angle_deg"), 180);
  graded.per_bin = static_cast<std::size_t>(
      node.integer_or("per_bin", static_cast<std::int64_t>(graded.per_bin), 1, 1000));
  graded.seed = static_cast<std::uint64_t>(node.integer_or("seed", 0, 0, INT64_MAX));
  if (const auto speed = node.find("speed")) graded.speed = read_speeds(*speed);
  graded.least_shown = node.number_or("least_shown", graded.least_shown, 0, 1);
  node.finish();
  const std::size_t queries =
      bins(graded.distance_m) * bins(graded.angle_deg) * graded.per_bin * graded.speed.size();
  if (queries > kMostQueries)
    node.fail(fmt::format("asks {} in each place, at most {} can be",
                          counted(queries, "query", "queries"), kMostQueries));
  return graded;
}

}  // namespace mh
