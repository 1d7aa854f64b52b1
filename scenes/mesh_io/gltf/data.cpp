// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/gltf/data.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh::gltf {
namespace {

std::size_t size_of(std::size_t type) {
  switch (type) {
    case kInt8:
    case kUint8:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kUint32:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

std::size_t width_of(const std::string& type) {
  constexpr std::array<std::pair<const char*, std::size_t>, 4> kWidths = {
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}}};
  for (const auto& [name, width] : kWidths)
    if (type == name) return width;
  return 0;
}

template <class T>
float number_at(const char* at, bool normalized) {
  T value;
  std::memcpy(&value, at, sizeof value);
  const auto number = static_cast<float>(value);
  if constexpr (std::is_integral_v<T>)
    if (normalized)
      return std::max(number / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
  return number;
}

float number_at(const char* at, std::size_t type, bool normalized) {
  switch (type) {
    case kInt8:
      return number_at<std::int8_t>(at, normalized);
    case kUint8:
      return number_at<std::uint8_t>(at, normalized);
    case kInt16:
      return number_at<std::int16_t>(at, normalized);
    case kUint16:
      return number_at<std::uint16_t>(at, normalized);
    case kUint32:
      return number_at<std::uint32_t>(at, normalized);
    default:
      return number_at<float>(at, normalized);
  }
}

/// Type, width and number of an accessor's items.
struct Kind {
  std::size_t type, width, count;
  std::size_t bytes() const { return size_of(type) * width; }
};

Kind kind_of(const Json& accessor) {
  return {.type = index_in(accessor, "componentType", 0),
          .width = width_of(accessor.value("type", "")),
          .count = index_in(accessor, "count", 0)};
}

int decode(std::string_view mode, char* to, std::size_t count, std::size_t stride,
           std::string_view from) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(from.data());
  if (mode == "ATTRIBUTES")
    return meshopt_decodeVertexBuffer(to, count, stride, bytes, from.size());
  if (mode == "TRIANGLES") return meshopt_decodeIndexBuffer(to, count, stride, bytes, from.size());
  return meshopt_decodeIndexSequence(to, count, stride, bytes, from.size());
}

/// Whether the decoders can take data with these parameters. They only assert some of their
/// assumptions, so this must be checked first.
bool is_decodable(std::string_view mode, std::string_view filter, std::size_t count,
                  std::size_t stride) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 32, kWidest = 256;
  if (count == 0 || stride == 0 || stride > kWidest || count > kMostBytes / stride) return false;
  if (mode != "ATTRIBUTES")
    return filter == "NONE" && (stride == 2 || stride == 4) &&
           (mode == "INDICES" || (mode == "TRIANGLES" && count % 3 == 0));
  if (stride % 4 != 0) return false;
  return filter == "NONE" || filter == "EXPONENTIAL" || (filter == "QUATERNION" && stride == 8) ||
         (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8));
}

void unfilter(std::string_view filter, char* data, std::size_t count, std::size_t stride) {
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(data, count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(data, count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(data, count, stride);
}

}  // namespace

std::span<Json> list_of(Json& item, const char* name) {
  if (!item.is_object()) return {};
  const auto found = item.find(name);
  if (found == item.end() || !found->is_array()) return {};
  return found->get_ref<Json::array_t&>();
}

std::size_t index_in(const Json& item, const char* name, std::size_t otherwise) {
  if (!item.is_object()) return otherwise;
  const auto found = item.find(name);
  return found != item.end() && found->is_number_unsigned() ? found->get<std::size_t>() : otherwise;
}

std::string from_base64(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<int, 256> value_of;
  value_of.fill(-1);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    value_of[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char digit : text) {
    const int value = value_of[static_cast<unsigned char>(digit)];
    if (value < 0) break;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xffU);
  }
  return bytes;
}

Data::Data(Json& gltf, const std::filesystem::path& file, std::string_view body)
    : gltf_(gltf), file_(file), body_(body), new_buffer_(list_of(gltf, "buffers").size()) {}

void Data::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}", file_.string(), what));
}

std::string_view Data::buffer(std::size_t index) {
  if (index == new_buffer_) return added_;
  const std::span<Json> buffers = list_of(gltf_, "buffers");
  if (index >= buffers.size()) fail(fmt::format("buffers[{}]: does not exist", index));
  const std::string uri = buffers[index].value("uri", "");
  if (uri.empty()) return index == 0 ? body_ : std::string_view();
  HeldBytes& held = buffers_[index];
  if (held.owner) return held.view;
  constexpr std::string_view kCode = ";base64,";
  if (!uri.starts_with("data:"))
    held = map_file(file_.parent_path() / uri);
  else if (const std::size_t at = uri.find(kCode); at != uri.npos)
    held = hold(from_base64(std::string_view(uri).substr(at + kCode.size())));
  return held.view;
}

std::string_view Data::view(std::size_t index) {
  const std::span<Json> views = list_of(gltf_, "bufferViews");
  if (index >= views.size()) fail(fmt::format("bufferViews[{}]: does not exist", index));
  const std::string_view bytes = buffer(index_in(views[index], "buffer", kNone));
  const std::size_t offset = index_in(views[index], "byteOffset", 0);
  const std::size_t length = index_in(views[index], "byteLength", 0);
  if (offset > bytes.size() || length > bytes.size() - offset)
    fail(fmt::format("bufferViews[{}]: {} bytes from {} are beyond the {} of its buffer", index,
                     length, offset, bytes.size()));
  return bytes.substr(offset, length);
}

bool Data::is_plain(std::size_t accessor) const {
  const std::span<Json> accessors = list_of(gltf_, "accessors");
  if (accessor >= accessors.size()) return true;  // assimp reports it
  const Json& item = accessors[accessor];
  return index_in(item, "componentType", 0) == kFloat && !item.contains("sparse");
}

Data::Place Data::place_of(std::size_t view_index, std::size_t offset, std::size_t item,
                           std::size_t count) {
  const std::string_view bytes = view(view_index);
  const std::size_t stride =
      std::max(index_in(list_of(gltf_, "bufferViews")[view_index], "byteStride", item), item);
  if (count > 0 && (offset > bytes.size() || item > bytes.size() - offset ||
                    (count - 1) > (bytes.size() - offset - item) / stride))
    fail(fmt::format("bufferViews[{}]: {} items of {} bytes from {} on are beyond its {} bytes",
                     view_index, count, item, offset, bytes.size()));
  return {bytes.substr(std::min(offset, bytes.size())), stride};
}

Values Data::values(std::size_t index, bool shares) {
  const std::span<Json> accessors = list_of(gltf_, "accessors");
  if (index >= accessors.size()) fail(fmt::format("accessors[{}]: does not exist", index));
  const Json& accessor = accessors[index];
  const Kind kind = kind_of(accessor);
  const bool normalized = shares || accessor.value("normalized", false);
  if (kind.bytes() == 0)
    fail(fmt::format("accessors[{}]: componentType {}, type {}: is not known", index, kind.type,
                     accessor.value("type", "")));
  Values values{.width = kind.width, .numbers = {}};
  const std::size_t view_index = index_in(accessor, "bufferView", kNone);
  if (view_index == kNone) {
    if (!accessor.contains("sparse")) fail(fmt::format("accessors[{}]: has no data", index));
    constexpr std::size_t kMost = std::size_t{1} << 28;  // zeros, which take no space in the file
    if (kind.count > kMost) fail(fmt::format("accessors[{}]: {} items", index, kind.count));
    values.numbers.assign(kind.count * kind.width, 0.0F);
  } else {
    const auto [bytes, stride] =
        place_of(view_index, index_in(accessor, "byteOffset", 0), kind.bytes(), kind.count);
    values.numbers.reserve(kind.count * kind.width);
    for (std::size_t i = 0; i < kind.count; ++i)
      for (std::size_t k = 0; k < kind.width; ++k)
        values.numbers.push_back(
            number_at(bytes.data() + i * stride + k * size_of(kind.type), kind.type, normalized));
  }
  if (accessor.contains("sparse")) replace_sparse(index, normalized, values);
  return values;
}

void Data::replace_sparse(std::size_t accessor, bool normalized, Values& values) {
  const Kind kind = kind_of(list_of(gltf_, "accessors")[accessor]);
  const Json& sparse = list_of(gltf_, "accessors")[accessor]["sparse"];
  const std::size_t count = index_in(sparse, "count", 0);
  const Json& places = sparse.at("indices");
  const Json& replaced = sparse.at("values");
  const std::size_t index_type = index_in(places, "componentType", 0);
  if (index_type != kUint8 && index_type != kUint16 && index_type != kUint32)
    fail(fmt::format("accessors[{}]: sparse indices of componentType {}", accessor, index_type));
  const Place at = place_of(index_in(places, "bufferView", kNone),
                            index_in(places, "byteOffset", 0), size_of(index_type), count);
  const Place from = place_of(index_in(replaced, "bufferView", kNone),
                              index_in(replaced, "byteOffset", 0), kind.bytes(), count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t item = 0;  // its bytes in the file are little-endian
    std::memcpy(&item, at.bytes.data() + i * size_of(index_type), size_of(index_type));
    if (item >= values.count())
      fail(fmt::format("accessors[{}]: sparse index {} of {}", accessor, item, values.count()));
    for (std::size_t k = 0; k < kind.width; ++k)
      values.numbers[item * kind.width + k] = number_at(
          from.bytes.data() + i * kind.bytes() + k * size_of(kind.type), kind.type, normalized);
  }
}

void Data::decompress_views() {
  const std::span<Json> views = list_of(gltf_, "bufferViews");
  for (std::size_t i = 0; i < views.size(); ++i)
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      const Json::json_pointer place(std::string("/extensions/") + name);
      if (!views[i].is_object() || !views[i].contains(place)) continue;
      const Json packed = views[i].at(place);
      decompress(views[i], packed, i);
      break;
    }
}

void Data::decompress(Json& view, const Json& packed, std::size_t index) {
  const std::string mode = packed.value("mode", ""), filter = packed.value("filter", "NONE");
  const std::size_t count = index_in(packed, "count", 0),
                    stride = index_in(packed, "byteStride", 0);
  if (!is_decodable(mode, filter, count, stride))
    fail(
        fmt::format("bufferViews[{}]: meshopt compression of mode {}, filter {}, {} items of {} "
                    "bytes is not known",
                    index, mode, filter, count, stride));
  const std::string_view bytes = buffer(index_in(packed, "buffer", kNone));
  const std::size_t offset = index_in(packed, "byteOffset", 0);
  const std::size_t length = index_in(packed, "byteLength", 0);
  std::string unpacked(count * stride, '\0');
  if (offset > bytes.size() || length > bytes.size() - offset ||
      decode(mode, unpacked.data(), count, stride, bytes.substr(offset, length)) != 0)
    fail(
        fmt::format("bufferViews[{}]: its meshopt compression is damaged or of a newer version: "
                    "write the file without it",
                    index));
  unfilter(filter, unpacked.data(), count, stride);
  added_.resize((added_.size() + 3) / 4 * 4);
  Json plain = {
      {"buffer", new_buffer_}, {"byteOffset", added_.size()}, {"byteLength", unpacked.size()}};
  if (view.contains("byteStride")) plain["byteStride"] = stride;
  added_ += unpacked;
  view = std::move(plain);
}

std::size_t Data::add(std::string_view bytes, Json accessor) {
  added_.resize((added_.size() + 3) / 4 * 4);
  Json& views = gltf_["bufferViews"];
  views.push_back(
      {{"buffer", new_buffer_}, {"byteOffset", added_.size()}, {"byteLength", bytes.size()}});
  added_ += bytes;
  accessor["bufferView"] = views.size() - 1;
  Json& accessors = gltf_["accessors"];
  accessors.push_back(std::move(accessor));
  return accessors.size() - 1;
}

std::size_t Data::add(const Values& values) {
  constexpr std::array<const char*, 5> kTypes = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  return add(
      {reinterpret_cast<const char*>(values.numbers.data()), values.numbers.size() * sizeof(float)},
      {{"componentType", std::size_t{kFloat}},
       {"count", values.count()},
       {"type", kTypes.at(values.width)}});
}

std::string Data::finish() {
  if (!added_.empty())
    gltf_["buffers"].push_back({{"uri", kDecodedBuffer}, {"byteLength", added_.size()}});
  return std::move(added_);
}

}  // namespace mh::gltf
