// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "slam/io/held_bytes.hpp"

namespace mh::gltf {

using Json = nlohmann::json;

/// The name of the buffer with the decoded data: not a file, since assimp gets it from memory.
inline constexpr const char* kDecodedBuffer = "decoded by modelhouse.bin";

/// The elements of the array that is a JSON object's member of this name; empty if there is none.
std::span<Json> list_of(Json& item, const char* name);

/// The index that an object's member of this name holds; `otherwise` if there is no such member.
std::size_t index_in(const Json& item, const char* name, std::size_t otherwise);
inline constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The bytes that a base64 text encodes, up to the first character that is not base64.
std::string from_base64(std::string_view text);

enum ComponentType : std::size_t {
  kInt8 = 5120,
  kUint8 = 5121,
  kInt16 = 5122,
  kUint16 = 5123,
  kUint32 = 5125,
  kFloat = 5126
};

/// Items of `width` numbers each.
struct Values {
  std::size_t width = 0;
  std::vector<float> numbers;
  std::size_t count() const { return width == 0 ? 0 : numbers.size() / width; }
};

/// Reads the accessors of a glTF 2.0 file, and adds new ones, whose bytes are in one additional
/// buffer.
/// @throws InputError naming file and item: data outside of its buffer, an unknown type.
class Data {
 public:
  /// @param body  the binary chunk of a .glb; it and `gltf` must outlive this
  Data(Json& gltf, const std::filesystem::path& file, std::string_view body);

  /// Whether assimp reads the accessor as we do: floats in a buffer, not sparse.
  bool is_plain(std::size_t accessor) const;
  /// Values as floats: normalized integers are divided by their type's maximum, values that a
  /// sparse accessor overrides are replaced.
  /// @param shares the values are fractions of one: integers are normalized even if the file does
  /// not request that
  Values values(std::size_t accessor, bool shares = false);
  /// The bytes of a buffer view.
  std::string_view view(std::size_t index);
  /// Replaces buffer views that use EXT_meshopt_compression with views of the decompressed data.
  void decompress_views();

  /// @returns the index of a new accessor
  std::size_t add(const Values& values);
  /// @param accessor  the new accessor's other members
  std::size_t add(std::string_view bytes, Json accessor);

  /// Adds the new buffer to the file unless it is empty. @returns its content
  std::string finish();

  [[noreturn]] void fail(const std::string& what) const;

 private:
  struct Place {
    std::string_view bytes;
    std::size_t stride = 0;
  };
  std::string_view buffer(std::size_t index);
  void decompress(Json& view, const Json& packed, std::size_t index);
  void replace_sparse(std::size_t accessor, bool normalized, Values& values);
  Place place_of(std::size_t view, std::size_t offset, std::size_t item, std::size_t count);

  Json& gltf_;
  const std::filesystem::path& file_;
  std::string_view body_;
  std::map<std::size_t, HeldBytes> buffers_;
  std::size_t new_buffer_;
  std::string added_;
};

}  // namespace mh::gltf
