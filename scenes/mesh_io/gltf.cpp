// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/gltf.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/core/json_text.hpp"

namespace mh {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kHeader = 20;  // of a binary file, and of its first chunk, which is the JSON

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

std::string bytes_of(std::size_t number) {
  const auto narrow = static_cast<std::uint32_t>(number);
  return {reinterpret_cast<const char*>(&narrow), sizeof narrow};
}

void require_places(const Json& gltf, const std::filesystem::path& file) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 40;
  for (const char* list : {"accessors", "bufferViews"}) {
    const auto found = gltf.find(list);
    if (found == gltf.end() || !found->is_array()) continue;
    for (std::size_t i = 0; i < found->size(); ++i)
      for (const char* key : {"byteOffset", "byteLength", "byteStride", "count"}) {
        const Json& item = (*found)[i];
        const auto value = item.is_object() ? item.find(key) : item.end();
        if (value == item.end() || !value->is_number()) continue;
        if (value->is_number_unsigned() && value->get<std::uint64_t>() < kMost) continue;
        throw InputError(fmt::format("{}: {}[{}].{}: {} is not an integer from 0 to 2^40",
                                     file.string(), list, i, key, value->dump()));
      }
  }
}

/// @returns whether there was anything to drop
bool drop_movement(Json& gltf) {
  bool any = gltf.erase("animations") + gltf.erase("skins") > 0;
  if (const auto nodes = gltf.find("nodes"); nodes != gltf.end() && nodes->is_array())
    for (Json& node : *nodes) any = (node.is_object() && node.erase("skin") > 0) || any;
  return any;
}

}  // namespace

std::optional<std::string> repaired_gltf(std::string_view bytes,
                                         const std::filesystem::path& file) {
  std::string_view text = bytes, chunks;
  const bool binary = bytes.starts_with("glTF");
  if (binary) {
    if (bytes.size() < kHeader) return std::nullopt;
    text = bytes.substr(kHeader, number_at(bytes, 12));
    chunks = bytes.substr(kHeader + text.size());
  }
  Json gltf = parse_json_or_discard<Json>(text);
  if (!gltf.is_object()) return std::nullopt;
  require_places(gltf, file);
  if (!drop_movement(gltf)) return std::nullopt;
  std::string repaired = gltf.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!binary) return repaired;
  repaired.append((4 - repaired.size() % 4) % 4, ' ');
  return std::string(bytes.substr(0, 8)) + bytes_of(kHeader + repaired.size() + chunks.size()) +
         bytes_of(repaired.size()) + std::string(bytes.substr(16, 4)) + repaired +
         std::string(chunks);
}

}  // namespace mh
