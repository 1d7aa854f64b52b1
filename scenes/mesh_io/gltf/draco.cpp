// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/gltf/draco.hpp"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <array>

namespace mh::gltf {
namespace {

std::size_t component_type_of(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return kInt8;
    case draco::DT_UINT8:
      return kUint8;
    case draco::DT_INT16:
      return kInt16;
    case draco::DT_UINT16:
      return kUint16;
    case draco::DT_UINT32:
      return kUint32;
    case draco::DT_FLOAT32:
      return kFloat;
    default:
      return 0;  // no accessor has this type
  }
}

/// Adds an accessor with the values of an attribute; its other members are those of `like`.
std::size_t add_attribute(const draco::Mesh& mesh, const draco::PointAttribute& from, Json like,
                          Data& data) {
  std::string bytes(mesh.num_points() * static_cast<std::size_t>(from.byte_stride()), '\0');
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i)
    from.GetMappedValue(draco::PointIndex(i),
                        bytes.data() + i * static_cast<std::size_t>(from.byte_stride()));
  for (const char* old : {"bufferView", "byteOffset", "sparse"}) like.erase(old);
  like["componentType"] = component_type_of(from.data_type());
  like["count"] = std::size_t{mesh.num_points()};
  return data.add(bytes, std::move(like));
}

std::size_t add_faces(const draco::Mesh& mesh, Data& data) {
  std::string bytes;
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i)
    for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(i))) {
      const std::uint32_t index = point.value();
      bytes.append(reinterpret_cast<const char*>(&index), sizeof index);
    }
  return data.add(bytes, {{"componentType", std::size_t{kUint32}},
                          {"count", std::size_t{mesh.num_faces()} * 3},
                          {"type", "SCALAR"}});
}

void decompress(Json& primitive, const Json& packed, Json& gltf, Data& data) {
  const std::string_view bytes = data.view(index_in(packed, "bufferView", kNone));
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) data.fail("Draco compression: " + decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  Json& attributes = primitive["attributes"];
  for (const auto& [name, id] : packed.at("attributes").items()) {
    const draco::PointAttribute* from = mesh.GetAttributeByUniqueId(id.get<std::uint32_t>());
    const std::size_t accessor = index_in(attributes, name.c_str(), kNone);
    if (from == nullptr || accessor >= list_of(gltf, "accessors").size())
      data.fail(fmt::format("Draco compression: attribute {}: does not exist", name));
    const Json like = list_of(gltf, "accessors")[accessor];
    attributes[name] = add_attribute(mesh, *from, like, data);
  }
  primitive["indices"] = add_faces(mesh, data);
  primitive["mode"] = std::size_t{4};  // triangles, strips too
}

}  // namespace

void decompress_primitives(Json& gltf, Data& data) {
  const Json::json_pointer place("/extensions/KHR_draco_mesh_compression");
  for (Json& mesh : list_of(gltf, "meshes"))
    for (Json& primitive : list_of(mesh, "primitives")) {
      if (!primitive.is_object() || !primitive.contains(place)) continue;
      const Json packed = primitive[place];
      decompress(primitive, packed, gltf, data);
      primitive["extensions"].erase("KHR_draco_mesh_compression");
    }
}

}  // namespace mh::gltf
