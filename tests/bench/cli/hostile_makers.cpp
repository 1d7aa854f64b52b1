// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <array>

#include <fmt/format.h>

#include "tests/bench/cli/hostile_files.hpp"

namespace mh {
namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes += static_cast<char>(value >> static_cast<unsigned>(shift) & 0xffU);
  return bytes;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string typed = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(typed.data()), static_cast<uInt>(typed.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + typed +
         big_endian(static_cast<std::uint32_t>(sum));
}

}  // namespace

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

std::string png(std::uint32_t width, std::uint32_t height, int bits, int color_type,
                const std::string& rows) {
  uLongf size = compressBound(rows.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(rows.data()), rows.size(), 9);
  packed.resize(size);
  const std::string header = big_endian(width) + big_endian(height) + static_cast<char>(bits) +
                             static_cast<char>(color_type) + std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", packed) + chunk("IEND", "");
}

std::string ply_header(const std::string& format, const std::string& vertices,
                       const std::string& faces) {
  return fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, vertices, faces);
}

std::string triangle_ply() {
  return ply_header("binary_little_endian") + raw(std::array<float, 9>{0, 0, 0, 1, 0, 0, 0, 1, 0}) +
         '\3' + raw(std::array<std::int32_t, 3>{0, 1, 2});
}

std::string gltf(const std::string& nodes, const std::string& scene_nodes,
                 const std::string& more) {
  std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + scene_nodes +
                     R"(]}],"nodes":[)" + nodes + "]," +
                     R"("bufferViews":[{"buffer":0,"byteLength":36}])";
  // Three positions: (0, 0, 0), (1, 0, 0), (0, 1, 0).
  const std::array<std::string, 3> parts = {
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])",
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}])",
      R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
      R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}])"};
  for (const std::string& part : parts)  // unless `more` has its own
    if (more.find(part.substr(0, part.find(':'))) == more.npos) text += "," + part;
  return text + more + "}";
}

std::string glb(const std::string& json) {
  const auto size = static_cast<std::uint32_t>(json.size());
  return "glTF" + raw(std::uint32_t{2}) + raw(20 + size) + raw(size) + "JSON" + json;
}

std::string dae(const std::string& nodes, const std::string& libraries) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">
0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#a" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/>
</vertices><triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p>
</triangles></mesh></geometry></library_geometries>)" +
         libraries + "<library_visual_scenes><visual_scene id=\"s\">" + nodes +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene>"
         "</COLLADA>";
}

std::string world(const std::string& content) {
  return R"(<?xml version="1.0"?><sdf version="1.6"><world name="w">)" + content + "</world></sdf>";
}

}  // namespace mh
