// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/class_map.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "scenes/scannet/label_table.hpp"
#include "slam/io/error.hpp"
#include "slam/io/yaml.hpp"

namespace mh {
namespace {

constexpr std::uint32_t kGreatest = 65535;  // of 16 bits

void set(ClassMap& map, std::uint32_t id, ClassId class_id) {
  if (id >= map.size()) map.resize(id + 1, kVoid);
  map[id] = class_id;
}

}  // namespace

ClassMap load_class_map(const std::filesystem::path& file) {
  ClassMap map;
  if (file.extension() == ".tsv") {
    for (const auto& [id, class_id] : load_label_table(file).class_of_id)
      if (id <= kGreatest) set(map, id, class_id);
    return map;
  }
  YamlReader yaml = YamlReader::load(file);
  for (const auto& [key, node] : yaml.entries()) {
    std::uint32_t id = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), id);
    if (error != std::errc() || end != key.data() + key.size() || id > kGreatest)
      node.fail(fmt::format("'{}' is not an id from 0 to {}", key, kGreatest));
    const std::string word = node.as_string();
    const auto class_id = word == "void" ? std::optional(kVoid) : class_by_name(word);
    if (!class_id) node.fail(fmt::format("'{}' is not a class", word));
    set(map, id, *class_id);
  }
  return map;
}

void note_foreign_ids(const LabelsOfFrames& labels, const ClassMap& map,
                      const std::filesystem::path& table, std::vector<std::string>& notes) {
  const auto is_zero = [](std::uint16_t id) { return id == 0; };
  const auto has_class = [&](std::uint16_t id) { return id < map.size() && map[id] != kVoid; };
  for (std::size_t i = 0; i < labels.frames; ++i) try {
      const auto ids = labels.read(i);
      if (!ids || std::ranges::all_of(*ids, is_zero)) continue;
      if (std::ranges::none_of(*ids, has_class))
        notes.push_back(
            fmt::format("{}: none of its ids has a class in {}: are they from another table?",
                        labels.place(i), table.string()));
      return;
    } catch (const InputError&) {  // only its frame is skipped
    }
}

std::string no_labels_note(const std::filesystem::path& table) {
  return fmt::format("{}: is not used: the recording has no labels", table.string());
}

SemanticImage one_hot(const Grid2d<std::uint16_t>& ids, const ClassMap* map) {
  SemanticImage semantics;
  semantics.index = Grid2d<std::uint8_t>(ids.width(), ids.height());
  for (const ClassInfo& info : classes())
    semantics.palette.push_back(ClassDistribution::one_hot(info.id));
  std::ranges::transform(ids, semantics.index.begin(), [&](std::uint16_t id) {
    if (map != nullptr) return id < map->size() ? (*map)[id] : kVoid;
    if (id >= semantics.palette.size()) throw InputError(fmt::format("class {} is unknown", id));
    return static_cast<ClassId>(id);
  });
  return semantics;
}

}  // namespace mh
