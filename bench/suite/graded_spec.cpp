// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/graded_spec.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/suite/names.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {
namespace {

constexpr std::size_t kMostQueries = 10000;

void check_edges(const YamlReader& node, const std::vector<double>& edges) {
  if (edges.size() < 2) node.fail("are the edges of bins: at least two are needed");
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i] <= edges[i - 1])
      node.fail(fmt::format("{} follows {}: edges must increase", edges[i], edges[i - 1]));
}

}  // namespace

std::size_t bin_of(const std::vector<double>& edges, double value) {
  const auto above = std::upper_bound(edges.begin(), edges.end(), value);
  return above == edges.begin() ? bins(edges) : static_cast<std::size_t>(above - edges.begin()) - 1;
}

GradedSpec read_graded(YamlReader node) {
  GradedSpec graded;
  MappingReader reader(node);
  fields(graded, reader);
  node.finish();
  check_edges(node.at("distance_m"), graded.distance_m);
  check_edges(node.at("angle_deg"), graded.angle_deg);
  if (const auto speed = node.find("speed")) require_distinct(*speed, graded.speed);
  const std::size_t queries =
      bins(graded.distance_m) * bins(graded.angle_deg) * graded.per_bin * graded.speed.size();
  if (queries > kMostQueries)
    node.fail(fmt::format("asks {} in each place, at most {} are allowed",
                          counted(queries, "query", "queries"), kMostQueries));
  return graded;
}

}  // namespace mh
