// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/parameters.hpp"

#include <algorithm>
#include <cassert>

#include "bench/plan/names.hpp"
#include "slam/core/counted.hpp"
#include "slam/core/random.hpp"

namespace mh {
namespace {

constexpr Names<Overlap, 3> kOverlaps{
    {{"labels", Overlap::kLabels}, {"augmented", Overlap::kAugmented}, {"words", Overlap::kWords}}};
constexpr Names<SweepMap, 2> kMaps{{{"fixed", SweepMap::kFixed}, {"rebuilt", SweepMap::kRebuilt}}};
constexpr std::size_t kMaxPoints = 10000;

struct Range {
  double min, max;
  bool open;  ///< max itself is outside: equations 4 and 6 compare strictly, so 1 leaves nothing
};

Range range_of(std::string_view name) {
  if (name == "gamma") return {0.0, 1e6, false};
  if (name == "xi") return {1.0, 1e6, false};
  return {0.0, 1.0, true};
}

double read_parameter(const YamlReader& node, std::string_view name) {
  const Range range = range_of(name);
  if (!range.open) return node.as_double(range.min, range.max);
  const double value = node.as_double();
  if (value < range.min || value >= range.max)
    node.fail(fmt::format("{} is outside [{}, {})", value, range.min, range.max));
  return value;
}

/// Every combination of the listed values, the last parameter varying fastest.
void read_grid(YamlReader& node, const SemanticConfig& base, Sweep& sweep) {
  sweep.points = {base};
  for (const std::string_view name : kParameters) {
    const auto list = node.find(std::string(name));
    if (!list) continue;
    sweep.varied.emplace_back(name);
    std::vector<double> values;
    for (const YamlReader& item : items_of(*list))
      add_once(values, read_parameter(item, name), item);
    std::vector<SemanticConfig> points;
    for (const SemanticConfig& point : sweep.points)
      for (const double value : values) {
        points.push_back(point);
        parameter(points.back(), name) = value;
      }
    if (points.size() > kMaxPoints)
      list->fail(
          fmt::format("makes {}, at most {} can be", counted(points.size(), "point"), kMaxPoints));
    sweep.points = std::move(points);
  }
}

void read_sobol(YamlReader node, const SemanticConfig& base, Sweep& sweep) {
  const auto count = node.integer("points", 1, kMaxPoints);
  const auto seed = static_cast<std::uint64_t>(node.integer_or("seed", 0, 0, INT64_MAX));
  YamlReader ranges = node.at("ranges");
  std::vector<std::pair<double, double>> bounds;
  for (const std::string_view name : kParameters) {
    const auto range = ranges.find(std::string(name));
    if (!range) continue;
    const std::vector<YamlReader> ends = range->items();
    if (ends.size() != 2) range->fail("must be [low, high]");
    const double low = read_parameter(ends[0], name), high = read_parameter(ends[1], name);
    if (low >= high) range->fail(fmt::format("{} is not below {}", low, high));
    sweep.varied.emplace_back(name);
    bounds.emplace_back(low, high);
  }
  ranges.finish();
  node.finish();
  if (sweep.varied.empty()) ranges.fail("names no parameter");
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    const std::array<double, 4> unit = sobol_point(i, seed);
    SemanticConfig point = base;
    for (std::size_t k = 0; k < bounds.size(); ++k)
      parameter(point, sweep.varied[k]) =
          bounds[k].first + unit[k] * (bounds[k].second - bounds[k].first);
    sweep.points.push_back(point);
  }
}

}  // namespace

std::string_view name(SweepMap map) {
  return name_of(map, kMaps);
}
std::string_view name(Overlap overlap) {
  return name_of(overlap, kOverlaps);
}

double parameter(const SemanticConfig& config, std::string_view name) {
  if (name == "gamma") return config.gamma;
  if (name == "xi") return config.xi;
  if (name == "alpha") return config.alpha;
  assert(name == "beta");
  return config.beta;
}

double& parameter(SemanticConfig& config, std::string_view name) {
  if (name == "gamma") return config.gamma;
  if (name == "xi") return config.xi;
  if (name == "alpha") return config.alpha;
  assert(name == "beta");
  return config.beta;
}

SemanticConfig read_semantics(YamlReader node) {
  SemanticConfig c;
  for (const std::string_view name : kParameters)
    if (const auto child = node.find(std::string(name)))
      parameter(c, name) = read_parameter(*child, name);
  if (const auto overlap = node.find("overlap")) c.overlap = one_of(*overlap, kOverlaps);
  c.void_is_a_label = node.boolean("void_is_a_label", c.void_is_a_label);
  node.finish();
  return c;
}

Sweep read_sweep(YamlReader node, const SemanticConfig& base) {
  Sweep sweep;
  sweep.map = one_of(node.at("map"), kMaps);
  const auto sobol = node.find("sobol");
  if (sobol)
    read_sobol(*sobol, base, sweep);
  else
    read_grid(node, base, sweep);
  node.finish();
  if (sweep.varied.empty()) node.fail("varies nothing: gamma, xi, alpha, beta or sobol is needed");
  return sweep;
}

std::array<double, 4> sobol_point(std::uint32_t index, std::uint64_t seed) {
  constexpr int kBits = 32;
  // Primitive polynomials by degree s, inner coefficients a, and initial direction numbers m.
  struct Dimension {
    int s;
    std::uint32_t a;
    std::array<std::uint32_t, 3> m;
  };
  constexpr std::array<Dimension, 3> kDimensions{
      {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}}};
  std::array<double, 4> point{};
  for (std::size_t d = 0; d < point.size(); ++d) {
    std::array<std::uint32_t, kBits> v{};
    for (int k = 0; k < kBits; ++k) {
      if (d == 0) {
        v[k] = 1U << (kBits - 1 - k);
        continue;
      }
      const Dimension& p = kDimensions[d - 1];
      if (k < p.s) {
        v[k] = p.m[k] << (kBits - 1 - k);
        continue;
      }
      v[k] = v[k - p.s] ^ (v[k - p.s] >> p.s);
      for (int j = 1; j < p.s; ++j)
        if ((p.a >> (p.s - 1 - j)) & 1U) v[k] ^= v[k - j];
    }
    std::uint32_t x = 0;
    for (int k = 0; k < kBits; ++k)
      if ((index >> k) & 1U) x ^= v[k];
    x ^= static_cast<std::uint32_t>(RandomStream(seed).fork(d).bits(0));
    point[d] = static_cast<double>(x) * 0x1.0p-32;
  }
  return point;
}

}  // namespace mh
