// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/gltf.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/mesh_io/gltf/draco.hpp"
#include "scenes/mesh_io/gltf/extensions.hpp"
#include "scenes/mesh_io/gltf/materials.hpp"
#include "scenes/mesh_io/gltf/nodes.hpp"
#include "slam/io/error.hpp"
#include "slam/io/json_text.hpp"

namespace mh {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kHeader = 20;  // of the file and its first chunk, before the JSON

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

/// Whether a file is glTF 2, the version whose extensions are handled here; a file that states no
/// version counts as glTF 2.
bool is_version_2(const Json& gltf) {
  const Json::json_pointer place("/asset/version");
  return !gltf.contains(place) || !gltf[place].is_string() ||
         gltf[place].get_ref<const std::string&>().starts_with("2");
}

/// @returns the content of the additional buffer; empty if there is none
std::string repair(Json& gltf, const std::filesystem::path& file, std::string_view body,
                   std::vector<std::string>& warnings) {
  gltf::drop_movement(gltf);
  if (!is_version_2(gltf)) return {};
  gltf::check_extensions(gltf, file, warnings);
  gltf::decode_uris(gltf, file.parent_path());
  gltf::choose_images(gltf);
  gltf::repair_materials(gltf);
  gltf::drop_hidden(gltf);
  gltf::Data data(gltf, file, body);
  data.decompress_views();
  gltf::decompress_primitives(gltf, data);
  gltf::place_instances(gltf, data);
  gltf::repair_primitives(gltf, data, gltf::take_uv_placements(gltf, file, warnings), warnings);
  return data.finish();
}

/// The content of a binary file's second chunk.
std::string_view body_of(std::string_view chunks) {
  constexpr std::size_t kHead = 8;
  if (chunks.size() < kHead || chunks.substr(4, 3) != "BIN") return {};
  return chunks.substr(kHead, number_at(chunks, 0));
}

/// Whether the second chunk begins where the first ends. It should begin at a multiple of 4, which
/// some writers forget (early versions of trimesh).
bool is_unpadded(std::size_t end, std::string_view bytes) {
  constexpr std::size_t kLength = 4;
  return end % 4 != 0 && end + kLength < bytes.size() && bytes.substr(end + kLength, 3) == "BIN";
}

std::string_view chunks_after(std::size_t end, std::string_view bytes) {
  const std::size_t begin = is_unpadded(end, bytes) ? end : (end + 3) / 4 * 4;
  return bytes.substr(std::min(begin, bytes.size()));
}

}  // namespace

std::optional<RepairedGltf> repaired_gltf(std::string_view bytes, const std::filesystem::path& file,
                                          std::vector<std::string>* warnings) {
  std::string_view text = bytes, chunks;
  const bool binary = bytes.starts_with("glTF");
  if (binary) {
    if (bytes.size() < kHeader) return std::nullopt;
    text = bytes.substr(kHeader, number_at(bytes, 12));
    chunks = chunks_after(kHeader + text.size(), bytes);
  }
  Json gltf = parse_json_or_discard<Json>(text);
  if (!gltf.is_object()) return std::nullopt;
  require_places(gltf, file);
  const Json before = gltf;
  RepairedGltf repaired;
  std::vector<std::string> lines;
  try {
    repaired.decoded = repair(gltf, file, body_of(chunks), lines);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is not valid glTF: {}", file.string(), error.what()));
  }
  if (warnings != nullptr)
    for (const std::string& line : lines)
      warnings->push_back(fmt::format("{}: {}", file.string(), line));
  if (gltf == before && !(binary && is_unpadded(kHeader + text.size(), bytes))) return std::nullopt;
  repaired.decoded_name = file.parent_path() / gltf::kDecodedBuffer;
  repaired.bytes = gltf.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!binary) return repaired;
  repaired.bytes.append((4 - repaired.bytes.size() % 4) % 4, ' ');
  repaired.bytes = std::string(bytes.substr(0, 8)) +
                   bytes_of(kHeader + repaired.bytes.size() + chunks.size()) +
                   bytes_of(repaired.bytes.size()) + std::string(bytes.substr(16, 4)) +
                   repaired.bytes + std::string(chunks);
  return repaired;
}

}  // namespace mh
