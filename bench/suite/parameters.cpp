// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/parameters.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/suite/names.hpp"
#include "slam/config/by_name.hpp"
#include "slam/config/slam.hpp"
#include "slam/core/random.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

constexpr Names<SweepMap, 2> kMaps{{{"fixed", SweepMap::kFixed}, {"rebuilt", SweepMap::kRebuilt}}};
constexpr std::size_t kMaxPoints = 10000;
constexpr std::string_view kLevelPrefix = "level.";

/// @throws InputError at the value's place unless the name is that of a setting that can be varied.
void check_varied(const std::string& name, const YamlReader& place, SweepMap map) {
  if (is_dial(name))
    place.fail(fmt::format("is a dial of the level: name it '{}{}'", kLevelPrefix, name));
  if (!is_setting(name))
    place.fail("is not a setting of SLAM" + hint(name, setting_names(), "`slam --print-settings`"));
  if (map == SweepMap::kFixed && !name.starts_with("semantics."))
    place.fail("decides the map, too: it needs `map: rebuilt`");
}

/// Multiplies the combinations by the listed values of a dial of the level.
void read_doses(const std::string& dial, const YamlReader& list, Sweep& sweep) {
  if (!is_dial(dial)) list.fail(no_dial(dial));
  if (sweep.map == SweepMap::kFixed) list.fail("decides the map, too: it needs `map: rebuilt`");
  std::vector<double> values;
  for (const YamlReader& item : items_of(list)) values.push_back(read_dose(dial, item));
  require_distinct(list, words_of(values, [](double v) { return fmt::format("{:.6g}", v); }));
  std::vector<std::vector<Dose>> combinations;
  if (sweep.doses.empty()) sweep.doses.emplace_back();
  if (sweep.doses.size() * values.size() > kMaxPoints)
    list.fail(fmt::format("makes more than {} combinations", kMaxPoints));
  for (const std::vector<Dose>& doses : sweep.doses)
    for (const double value : values) {
      combinations.push_back(doses);
      combinations.back().push_back({dial, value});
    }
  sweep.doses = std::move(combinations);
}

/// Reads every combination of the listed values, the last setting varying fastest.
void read_grid(YamlReader& node, const SlamConfig& base, Sweep& sweep) {
  sweep.points = {base};
  for (const auto& [name, list] : node.entries()) {
    if (name == "map") continue;
    if (name.starts_with(kLevelPrefix)) {
      read_doses(name.substr(kLevelPrefix.size()), list, sweep);
      continue;
    }
    check_varied(name, list, sweep.map);
    sweep.varied.push_back(name);
    const std::vector<YamlReader> items = items_of(list);
    std::vector<std::string> values;
    for (const YamlReader& item : items) {
      SlamConfig value = base;
      read_setting(value, name, item);
      values.push_back(setting_text(value, name));
    }
    require_distinct(list, values);
    // Checked before allocation: two long lists would use all memory.
    const std::size_t count = sweep.points.size() * items.size();
    if (count > kMaxPoints)
      list.fail(
          fmt::format("makes {}, at most {} are allowed", counted(count, "point"), kMaxPoints));
    std::vector<SlamConfig> points;
    for (const SlamConfig& point : sweep.points)
      for (const YamlReader& item : items) {
        points.push_back(point);
        read_setting(points.back(), name, item);
      }
    sweep.points.assign(points.begin(), points.end());
  }
}

void read_sobol(YamlReader node, const SlamConfig& base, Sweep& sweep) {
  const auto count = node.integer("points", 1, kMaxPoints);
  const auto seed = static_cast<std::uint64_t>(node.integer_or("seed", 0, 0, INT64_MAX));
  YamlReader ranges = node.at("ranges");
  std::vector<std::pair<double, double>> bounds;
  for (const auto& [name, range] : ranges.entries()) {
    check_varied(name, range, sweep.map);
    const std::vector<YamlReader> ends = range.items();
    if (ends.size() != 2) range.fail("must be [low, high]");
    SlamConfig low = base, high = base;
    read_setting(low, name, ends[0]);
    read_setting(high, name, ends[1]);
    bounds.emplace_back(setting_value(low, name), setting_value(high, name));
    if (!is_number(name)) range.fail("is not a number: list its values instead, without `sobol`");
    if (bounds.back().first >= bounds.back().second)
      range.fail(fmt::format("{} is not below {}", bounds.back().first, bounds.back().second));
    sweep.varied.push_back(name);
    if (sweep.varied.size() > kSobolDimensions)
      range.fail(fmt::format("is one too many: {} can be varied", kSobolDimensions));
  }
  node.finish();
  if (sweep.varied.empty()) ranges.fail("names no setting");
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    const auto unit = sobol_point(i, seed);
    SlamConfig point = base;
    for (std::size_t k = 0; k < bounds.size(); ++k)
      set_between(point, sweep.varied[k], bounds[k].first, bounds[k].second, unit[k]);
    sweep.points.push_back(point);
  }
}

/// Refuses points at which gamma or a label mass would not have the effect that the suite states.
void check_weights(const YamlReader& node, const Sweep& sweep) {
  const auto varies = [&](std::string_view setting) {
    return std::ranges::find(sweep.varied, setting) != sweep.varied.end();
  };
  const auto has_mass = [](const SlamConfig& point) { return point.semantics.label_mass != 0; };
  if (varies(kLabelMass) && !std::ranges::all_of(sweep.points, has_mass))
    node.fail(fmt::format("{}: 0 is not a mass: it leaves the weight to {}", kLabelMass, kGamma));
  if (varies(kGamma) && sweep.map == SweepMap::kFixed &&
      std::ranges::any_of(sweep.points, has_mass))
    node.fail(fmt::format("{} does nothing on a fixed map where {} is not 0", kGamma, kLabelMass));
}

}  // namespace

std::string_view name(SweepMap map) {
  return name_of(map, kMaps);
}

std::string_view shown_name(std::string_view setting) {
  constexpr std::string_view kPaper = "semantics.";
  return setting.starts_with(kPaper) ? setting.substr(kPaper.size()) : setting;
}

std::string shown_value(const SlamConfig& config, std::string_view setting) {
  return is_number(setting) ? fmt::format("{:.4g}", setting_value(config, setting))
                            : setting_text(config, setting);
}

std::string shown_point(const Sweep& sweep, const SlamConfig& point) {
  std::string text;
  for (const std::string& name : sweep.varied)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", shown_name(name),
                        shown_value(point, name));
  return text;
}

Sweep read_sweep(YamlReader node, const SlamConfig& base) {
  Sweep sweep;
  sweep.map = one_of(node.at("map"), kMaps);
  const auto sobol = node.find("sobol");
  if (sobol) {
    read_sobol(*sobol, base, sweep);
    node.finish();
  } else {
    read_grid(node, base, sweep);
  }
  if (sweep.varied.empty() && !sweep.doses.empty()) sweep.points.clear();
  if (sweep.varied.empty() && sweep.doses.empty())
    node.fail("varies nothing: a setting with its values, or sobol, is needed");
  check_weights(node, sweep);
  return sweep;
}

std::array<double, kSobolDimensions> sobol_point(std::uint32_t index, std::uint64_t seed) {
  constexpr int kBits = 32;
  // Primitive polynomials of degree s, inner coefficients a, and initial direction numbers m.
  struct Dimension {
    int s;
    std::uint32_t a;
    std::array<std::uint32_t, 5> m;
  };
  constexpr std::array<Dimension, kSobolDimensions - 1> kDimensions{{{1, 0, {1}},
                                                                     {2, 1, {1, 3}},
                                                                     {3, 1, {1, 3, 1}},
                                                                     {3, 2, {1, 1, 1}},
                                                                     {4, 1, {1, 1, 3, 3}},
                                                                     {4, 4, {1, 3, 5, 13}},
                                                                     {5, 2, {1, 1, 5, 5, 17}}}};
  std::array<double, kSobolDimensions> point{};
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
