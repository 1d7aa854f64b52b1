// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "scenes/house/plan_parts.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

Rgb8 read_tone(const YamlReader& yaml) {
  const std::vector<double> n = yaml.as_numbers(3);
  for (const double v : n)
    if (v < 0 || v > 255) yaml.fail(fmt::format("{} is outside [0, 255]", v));
  return {static_cast<std::uint8_t>(n[0]), static_cast<std::uint8_t>(n[1]),
          static_cast<std::uint8_t>(n[2])};
}

}  // namespace

Eigen::Vector3f read_light_color(const YamlReader& yaml) {
  const std::vector<double> n = yaml.as_numbers(3);
  for (const double v : n)
    if (v < 0) yaml.fail(fmt::format("{} is negative; light cannot be", v));
  return Eigen::Vector3d(n[0], n[1], n[2]).cast<float>();
}

Materials read_materials(YamlReader yaml) {
  Materials result;
  for (auto& [name, entry] : yaml.entries()) {
    MaterialSpec spec;
    spec.name = name;
    const YamlReader kind = entry.at("kind");
    spec.kind = kind.as_string();
    if (std::ranges::find(material_kinds(), spec.kind) == material_kinds().end())
      kind.fail(fmt::format("unknown kind of material '{}'{}", spec.kind,
                            hint(spec.kind, words_of(material_kinds()))));
    if (const auto tone = entry.find("tone")) spec.tone = read_tone(*tone);
    spec.variation = entry.number_or("variation", spec.variation, 0.0, 1.0);
    spec.seed = static_cast<std::uint64_t>(entry.integer_or("seed", 0, 0, 1'000'000'000));
    entry.finish();
    result.emplace(name, spec);
  }
  return result;
}

MaterialSpec material_by_name(const YamlReader& yaml, const Materials& materials) {
  const auto found = materials.find(yaml.as_string());
  if (found == materials.end())
    yaml.fail(fmt::format(
        "unknown material '{}'{}", yaml.as_string(),
        hint(yaml.as_string(), words_of(materials, [](const auto& m) { return m.first; }))));
  return found->second;
}

std::string materials_text(std::span<const MaterialSpec> materials) {
  std::string out = "materials:\n";
  for (const MaterialSpec& m : materials)
    out += fmt::format("  {}: {{kind: {}, tone: [{}, {}, {}], variation: {:.2f}, seed: {}}}\n",
                       m.name, m.kind, m.tone.r, m.tone.g, m.tone.b, m.variation, m.seed);
  return out;
}

}  // namespace mh
