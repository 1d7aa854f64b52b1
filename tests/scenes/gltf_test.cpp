// SPDX-License-Identifier: Apache-2.0
// How glTF files are checked and adapted: extensions, and data that assimp misreads.
#include "scenes/mesh_io/gltf.hpp"

#include <draco/compression/encode.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "scenes/load.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

using Json = nlohmann::json;
using Eigen::Vector2f;
using Eigen::Vector3f;

template <class T>
constexpr int kComponent = std::is_same_v<T, std::int8_t>     ? 5120
                           : std::is_same_v<T, std::uint8_t>  ? 5121
                           : std::is_same_v<T, std::int16_t>  ? 5122
                           : std::is_same_v<T, std::uint16_t> ? 5123
                           : std::is_same_v<T, std::uint32_t> ? 5125
                                                              : 5126;

std::string raw(std::uint32_t number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

/// An image of one color; its format is detected from its content, not from its name.
std::string image(Rgb8 color) {
  std::string ppm = "P6\n2 2\n255\n";
  for (int i = 0; i < 4; ++i) ppm.append(reinterpret_cast<const char*>(&color), sizeof color);
  return ppm;
}

/// A glTF file with one node, mesh, primitive and material, to be filled by the tests.
struct File {
  Json json = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"name", "chair"}, {"mesh", 0}}}},
               {"meshes", {{{"primitives", {{{"attributes", Json::object()}, {"material", 0}}}}}}},
               {"materials", {{{"name", "look"}}}}};
  std::string data;

  Json& primitive() { return json["meshes"][0]["primitives"][0]; }
  Json& material() { return json["materials"][0]; }
  Json& texture() { return material()["pbrMetallicRoughness"]["baseColorTexture"]; }

  std::size_t view(std::string_view bytes) {
    data.resize((data.size() + 3) / 4 * 4);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}});
    data += bytes;
    return json["bufferViews"].size() - 1;
  }
  template <class T>
  std::size_t view(const std::vector<T>& numbers) {
    return view({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)});
  }
  /// Adds numbers as an accessor; `more` are additional members.
  template <class T>
  std::size_t add(const std::vector<T>& numbers, const std::string& type,
                  const Json& more = Json::object()) {
    const std::size_t width = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
    return add_accessor(view(numbers), kComponent<T>, numbers.size() / width, type, more);
  }
  std::size_t add_accessor(std::size_t view, int component, std::size_t count,
                           const std::string& type, const Json& more = Json::object()) {
    Json accessor = {
        {"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}};
    accessor.update(more);
    json["accessors"].push_back(accessor);
    return json["accessors"].size() - 1;
  }
  template <class T>
  void set(const char* attribute, const std::vector<T>& numbers, const std::string& type,
           const Json& more = Json::object()) {
    primitive()["attributes"][attribute] = add(numbers, type, more);
  }
  /// Sets the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0).
  void set_triangle() { set<float>("POSITION", {0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3"); }
  /// Makes an image the source of the texture, inside an extension if one is named.
  void show(const std::string& uri, const std::string& extension = "") {
    json["images"].push_back({{"uri", uri}});
    const std::size_t image = json["images"].size() - 1;
    Json& texture_record = json["textures"][0];
    if (extension.empty())
      texture_record["source"] = image;
    else
      texture_record["extensions"][extension]["source"] = image;
    texture()["index"] = 0;
  }

  std::string text(const char* buffer = "data.bin") {
    json["buffers"] = {{{"uri", buffer}, {"byteLength", data.size()}}};
    return json.dump();
  }
  std::string glb() {
    json["buffers"] = {{{"byteLength", data.size()}}};
    std::string chunk = json.dump(), body = data;
    chunk.resize((chunk.size() + 3) / 4 * 4, ' ');
    body.resize((body.size() + 3) / 4 * 4);
    return "glTF" + raw(2) + raw(static_cast<std::uint32_t>(28 + chunk.size() + body.size())) +
           raw(static_cast<std::uint32_t>(chunk.size())) + "JSON" + chunk +
           raw(static_cast<std::uint32_t>(body.size())) + std::string("BIN\0", 4) + body;
  }
};

class Gltf : public TemporaryFolder {
 protected:
  Scene load(File& file) {
    write("data.bin", file.data);
    warnings_.clear();
    return load_mesh(write("a.gltf", file.text()), &warnings_);
  }
  /// Loads the file in text and in binary form and expects the same scene.
  Scene load_both(File& file) {
    const Scene binary = load_mesh(write("a.glb", file.glb()));
    Scene scene = load(file);
    EXPECT_EQ(digest(binary), digest(scene));
    return scene;
  }
  std::string error_from(File& file) {
    return error_of([&] { load(file); });
  }

  std::vector<std::string> warnings_;
};

const Material& material_of(const Scene& scene) {
  return scene.materials[scene.material_of[0]];
}

TEST_F(Gltf, QuantizedNumbersAreWhatTheyStandFor) {
  File file;
  file.json["nodes"][0]["scale"] = {0.5, 0.5, 0.5};
  // 16 bits, padded to 8 bytes.
  file.set<std::int16_t>("POSITION", {-100, 2, 4, 0, 100, 0, 6, 0, 0, 8, -32768, 0}, "VEC3",
                         {{"count", 3}});
  file.json["bufferViews"][0]["byteStride"] = 8;
  file.set<std::int8_t>("NORMAL", {0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0}, "VEC3",
                        {{"normalized", true}, {"count", 3}});
  file.json["bufferViews"][1]["byteStride"] = 4;
  file.set<std::uint16_t>("TEXCOORD_0", {0, 65535, 13107, 39321, 65535, 0}, "VEC2",
                          {{"normalized", true}});
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const Scene scene = load_both(file);
  EXPECT_TRUE(warnings_.empty());
  EXPECT_EQ(scene.positions_m, (std::vector<Vector3f>{{-50, -2, 1}, {50, -3, 0}, {0, 16384, 4}}));
  EXPECT_EQ(scene.uvs, (std::vector<Vector2f>{{0, 1}, {0.2F, 0.6F}, {1, 0}}));
}

TEST_F(Gltf, NormalizedPositionsAndCoordinatesOfOneByteReachOne) {
  File file;
  file.set<std::int8_t>("POSITION", {127, -127, -128, 0, 127, 0, 0, 0, 127, 0, 0, 0}, "VEC3",
                        {{"normalized", true}, {"count", 3}});
  file.json["bufferViews"][0]["byteStride"] = 4;
  file.set<std::uint8_t>("TEXCOORD_0", {255, 0, 0, 0, 0, 255, 0, 0, 51, 153, 0, 0}, "VEC2",
                         {{"normalized", true}, {"count", 3}});
  file.json["bufferViews"][1]["byteStride"] = 4;
  file.set<std::uint8_t>("COLOR_0", {255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 0, 0}, "VEC3",
                         {{"normalized", true}, {"count", 3}});
  file.json["bufferViews"][2]["byteStride"] = 4;
  const Scene scene = load_both(file);
  EXPECT_EQ(scene.positions_m, (std::vector<Vector3f>{{1, 1, -1}, {1, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(scene.uvs, (std::vector<Vector2f>{{1, 0}, {0, 1}, {0.2F, 0.6F}}));
  EXPECT_EQ(scene.colors, (std::vector<Rgb8>{{255, 0, 0}, {0, 255, 0}, {0, 0, 0}}));
}

TEST_F(Gltf, SparseAccessorsReplaceSomeItems) {
  for (const bool has_base : {true, false}) {
    File file;
    file.set_triangle();
    const std::size_t places = file.view(std::vector<std::uint16_t>{1, 2});
    const std::size_t values = file.view(std::vector<float>{4, 5, 6, 7, 8, 9});
    Json& accessor = file.json["accessors"][0];
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                          {"values", {{"bufferView", values}}}};
    if (!has_base) accessor.erase("bufferView");
    EXPECT_EQ(load_both(file).positions_m,
              (std::vector<Vector3f>{{0, 0, 0}, {4, -6, 5}, {7, -9, 8}}));
    accessor["sparse"]["count"] = 3;
    EXPECT_TRUE(names(error_from(file), {"a.gltf: bufferViews[1]: 3 items of 2 bytes"}));
    accessor["sparse"]["count"] = 2;
    file.data[36] = 3;
    EXPECT_TRUE(names(error_from(file), {"a.gltf: accessors[0]: sparse index 3 of 3"}));
  }
}

TEST_F(Gltf, ATextureIsScaledTurnedAndMovedAndTakesItsSet) {
  write("t.png", image({255, 0, 0}));
  const std::vector<float> first = {0, 0, 1, 0, 0, 1}, second = {0.5F, 0.25F, 0, 0, 0.25F, 1};
  const auto uvs = [&](const Json& texture) {
    File file;
    file.set_triangle();
    file.set("TEXCOORD_0", first, "VEC2");
    file.set("TEXCOORD_1", second, "VEC2");
    file.show("t.png");
    file.texture().update(texture);
    const Scene scene = load_both(file);
    EXPECT_TRUE(warnings_.empty());
    EXPECT_FALSE(material_of(scene).texture.empty());
    return scene.uvs;
  };
  const auto transform = [](const Json& by) {
    return Json{{"extensions", {{"KHR_texture_transform", by}}}};
  };
  EXPECT_EQ(uvs(Json::object()), (std::vector<Vector2f>{{0, 0}, {1, 0}, {0, 1}}));
  EXPECT_EQ(uvs({{"texCoord", 1}}), (std::vector<Vector2f>{{0.5F, 0.25F}, {0, 0}, {0.25F, 1}}));
  EXPECT_EQ(uvs(transform({{"scale", {4, 2}}, {"offset", {0.5, -0.25}}})),
            (std::vector<Vector2f>{{0.5F, -0.25F}, {4.5F, -0.25F}, {0.5F, 1.75F}}));
  EXPECT_EQ(uvs(transform({{"scale", {2, 4}}, {"texCoord", 1}})),
            (std::vector<Vector2f>{{1, 1}, {0, 0}, {0.5F, 4}}));
  // The example from the extension's specification: the lower left quarter of the image.
  const std::vector<Vector2f> quarter = uvs(
      transform({{"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}}));
  const std::vector<Vector2f> wanted = {{0, 1}, {0, 0.5F}, {0.5F, 1}};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_LT((quarter[i] - wanted[i]).norm(), 1e-6F) << quarter[i].transpose();
}

TEST_F(Gltf, ATextureThatCannotLieAsItShouldIsWarnedOf) {
  write("t.png", image({255, 0, 0}));
  File file;
  file.set_triangle();
  file.set<float>("TEXCOORD_0", {0, 0, 1.5F, 0, 0, 1}, "VEC2");
  file.show("t.png");
  file.texture()["texCoord"] = 3;
  load(file);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_TRUE(names(warnings_[0], {"a.gltf: mesh", "TEXCOORD_3", "TEXCOORD_0 are used"}));
  file.texture().erase("texCoord");
  file.material()["emissiveFactor"] = {1, 0, 0};
  file.material()["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
  load(file);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_TRUE(names(warnings_[0], {"materials[0]", "emissive texture is placed differently"}));
  file.material().erase("emissiveTexture");
  file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 10497}}};
  file.json["textures"][0]["sampler"] = 0;
  load(file);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_TRUE(names(warnings_[0], {"material look", "clamped beyond"}));
  file.json["samplers"] = {{{"wrapS", 10497}, {"wrapT", 33648}}};
  load(file);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  file.texture()["extensions"]["KHR_texture_transform"]["scale"] = {3};
  EXPECT_TRUE(names(error_from(file), {"a.gltf: materials[0]: its KHR_texture_transform"}));
}

TEST_F(Gltf, MeshoptCompressionIsUndone) {
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  const std::vector<std::uint32_t> faces = {0, 1, 2, 2, 1, 3};
  File plain;
  plain.set("POSITION", corners, "VEC3");
  plain.primitive()["indices"] = plain.add(faces, "SCALAR");
  std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(4, 12));
  vertices.resize(
      meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), corners.data(), 4, 12));
  std::vector<unsigned char> indices(meshopt_encodeIndexBufferBound(6, 4));
  meshopt_encodeIndexVersion(1);
  indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), faces.data(), 6));
  File packed;
  const auto add = [&](const std::vector<unsigned char>& bytes, const char* mode, int count,
                       int stride) {
    const std::size_t view = packed.view(bytes);
    Json& record = packed.json["bufferViews"][view];
    record["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                       {"byteOffset", record["byteOffset"]},
                                                       {"byteLength", bytes.size()},
                                                       {"mode", mode},
                                                       {"count", count},
                                                       {"byteStride", stride}};
    record["byteOffset"] = 0;
    record["byteLength"] = count * stride;
    return view;
  };
  packed.primitive()["attributes"]["POSITION"] =
      packed.add_accessor(add(vertices, "ATTRIBUTES", 4, 12), 5126, 4, "VEC3");
  packed.primitive()["indices"] =
      packed.add_accessor(add(indices, "TRIANGLES", 6, 4), 5125, 6, "SCALAR");
  packed.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  EXPECT_EQ(digest(load_both(packed)), digest(load_both(plain)));
  Json& record = packed.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
  record["mode"] = "SOMEHOW";
  EXPECT_TRUE(names(error_from(packed), {"a.gltf: bufferViews[0]", "mode SOMEHOW"}));
  record["mode"] = "ATTRIBUTES";
  record["byteLength"] = vertices.size() - 1;
  EXPECT_TRUE(names(error_from(packed), {"a.gltf: bufferViews[0]", "damaged"}));
}

TEST_F(Gltf, DracoCompressionIsUndoneAndItsNumbersMayBeQuantized) {
  draco::Mesh mesh;
  mesh.set_num_points(3);
  const auto add = [&](draco::GeometryAttribute::Type kind, draco::DataType type, int width,
                       const auto& numbers) {
    draco::GeometryAttribute attribute;
    attribute.Init(kind, nullptr, static_cast<std::int8_t>(width), type, false,
                   static_cast<std::int64_t>(sizeof numbers[0]) * width, 0);
    const int id = mesh.AddAttribute(attribute, true, 3);
    for (std::uint32_t i = 0; i < 3; ++i)
      mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                            &numbers[i * static_cast<std::uint32_t>(width)]);
    return mesh.attribute(id)->unique_id();
  };
  const std::vector<std::int16_t> corners = {0, 0, 0, 300, 0, 0, 0, 200, 0};
  const std::vector<std::uint8_t> uvs = {0, 0, 255, 0, 0, 255};
  const auto position = add(draco::GeometryAttribute::POSITION, draco::DT_INT16, 3, corners);
  const auto uv = add(draco::GeometryAttribute::TEX_COORD, draco::DT_UINT8, 2, uvs);
  mesh.AddFace({draco::PointIndex(0), draco::PointIndex(1), draco::PointIndex(2)});
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer bytes;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(mesh, &bytes).ok());
  File file;
  const std::size_t view = file.view(std::string_view(bytes.data(), bytes.size()));
  file.json["accessors"] = {
      {{"componentType", 5122}, {"count", 3}, {"type", "VEC3"}},
      {{"componentType", 5121}, {"count", 3}, {"type", "VEC2"}, {"normalized", true}},
      {{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}}};
  file.primitive()["attributes"] = {{"POSITION", 0}, {"TEXCOORD_0", 1}};
  file.primitive()["indices"] = 2;
  Json& packed = file.primitive()["extensions"]["KHR_draco_mesh_compression"];
  packed = {{"bufferView", view}, {"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}};
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const Scene scene = load_both(file);
  EXPECT_EQ(scene.positions_m, (std::vector<Vector3f>{{0, 0, 0}, {300, 0, 0}, {0, 0, 200}}));
  EXPECT_EQ(scene.uvs, (std::vector<Vector2f>{{0, 0}, {1, 0}, {0, 1}}));
  file.data.resize(file.data.size() / 2);
  EXPECT_TRUE(names(error_from(file), {"a.gltf: bufferViews[0]", "are beyond"}));
  file.json["bufferViews"][0]["byteLength"] = file.data.size();
  EXPECT_TRUE(names(error_from(file), {"a.gltf: Draco compression"}));
}

TEST_F(Gltf, FacesOfVerticesThatAreNotThereAreWarnedOf) {
  File file;
  file.set_triangle();
  file.primitive()["indices"] = file.add<std::uint16_t>({0, 1, 2, 0, 1, 3}, "SCALAR");
  EXPECT_EQ(load(file).triangles.size(), 1U);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_TRUE(names(warnings_[0], {"a.gltf", "1 of 6 indices is beyond its 3 vertices"}));
}

TEST_F(Gltf, TheChunksOfABinaryFileMayLackTheirPadding) {
  File file;
  file.set_triangle();
  for (int extra = 1; extra <= 4; ++extra) {
    file.json["asset"]["generator"] = std::string(static_cast<std::size_t>(extra), 'x');
    const std::string padded = file.glb(), chunk = file.json.dump();
    const std::string body = padded.substr(20 + (chunk.size() + 3) / 4 * 4);
    const std::string bytes = "glTF" + raw(2) +
                              raw(static_cast<std::uint32_t>(20 + chunk.size() + body.size())) +
                              raw(static_cast<std::uint32_t>(chunk.size())) + "JSON" + chunk + body;
    EXPECT_EQ(digest(load_mesh(write("a.glb", bytes))), digest(load_mesh(write("a.glb", padded))))
        << chunk.size() % 4;
  }
}

TEST_F(Gltf, AnUnknownExtensionIsRefusedIfRequiredOtherwiseWarnedOf) {
  File file;
  file.set_triangle();
  file.json["extensionsUsed"] = {"ACME_fog", "FB_ngon_encoding", "KHR_lights_punctual",
                                 "KHR_materials_ior", "KHR_materials_variants"};
  load(file);
  ASSERT_EQ(warnings_.size(), 2U);
  EXPECT_TRUE(names(warnings_[0], {"a.gltf", "ACME_fog", "unknown"}));
  EXPECT_TRUE(names(warnings_[1], {"a.gltf", "KHR_lights_punctual", "lights are left out"}));
  file.json["extensionsRequired"] = {"KHR_materials_ior"};
  load(file);
  file.json["extensionsRequired"] = {"KHR_materials_ior", "ACME_fog"};
  EXPECT_TRUE(names(error_from(file), {"a.gltf", "requires", "ACME_fog"}));
  EXPECT_TRUE(names(error_of([&] { load_mesh(write("a.glb", file.glb())); }), {"ACME_fog"}));
}

TEST_F(Gltf, ImagesOfExtensionsAreShownOrNamedAndMagenta) {
  write("t.png", image({255, 0, 0}));
  write("t.ktx2", std::string("\xabKTX 20\xbb\r\n\x1a\n", 12) + std::string(100, '\0'));
  write("t.dds", "DDS " + std::string(124, '\0'));
  const cv::Mat blue(2, 2, CV_8UC3, cv::Scalar(255, 0, 0));
  std::vector<unsigned char> webp;
  cv::imencode(".webp", blue, webp, {cv::IMWRITE_WEBP_QUALITY, 101});  // lossless
  write("t.webp", {webp.begin(), webp.end()});
  const auto file_of = [](const std::string& uri, const std::string& extension) {
    File file;
    file.set_triangle();
    file.set<float>("TEXCOORD_0", {0, 0, 1, 0, 0, 1}, "VEC2");
    file.show(uri, extension);
    file.json["extensionsUsed"] = {extension};
    return file;
  };
  File file = file_of("t.webp", "EXT_texture_webp");
  EXPECT_EQ(material_of(load(file)).texture(0, 0), (Rgb8{0, 0, 255}));
  EXPECT_TRUE(warnings_.empty());
  for (const auto& [ktx_or_dds, extension, kind] :
       {std::array{"t.ktx2", "KHR_texture_basisu", "KTX"}, {"t.dds", "MSFT_texture_dds", "DDS"}}) {
    file = file_of(ktx_or_dds, extension);
    file.json["extensionsRequired"] = {extension};
    const Scene scene = load(file);
    EXPECT_EQ(material_of(scene).base_color, (Rgb8{255, 0, 255}));
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_TRUE(names(warnings_[0], {"a.gltf: material look", ktx_or_dds, kind, "not read"}));
    file.json.erase("extensionsRequired");
    file.show("t.png");  // the fallback for readers that cannot read the other image
    EXPECT_EQ(material_of(load(file)).texture(0, 0), (Rgb8{255, 0, 0}));
    EXPECT_TRUE(warnings_.empty());
  }
}

TEST_F(Gltf, NamesMayBeOfPercentCodesAndAnyLetters) {
  write("my t%C3%A9x 50%.png", image({255, 0, 0}));
  write("my t\xc3\xa9x 50%.png", image({0, 255, 0}));
  write("my data.bin", "");
  File file;
  file.set_triangle();
  file.set<float>("TEXCOORD_0", {0, 0, 1, 0, 0, 1}, "VEC2");
  file.show("my%20t%C3%A9x%2050%.png");
  const auto place = write("r\xc3\xa4um%20/m \xc3\xb6.gltf", file.text("my%20data.bin"));
  write("r\xc3\xa4um%20/my data.bin", file.data);
  write("r\xc3\xa4um%20/my t\xc3\xa9x 50%.png", image({0, 0, 255}));
  const Scene scene = load_scene(
      write("room.yaml", "objects:\n  - {file: \"r\xc3\xa4um%20/m \xc3\xb6.gltf\"}\n"), &warnings_);
  EXPECT_EQ(material_of(scene).texture(0, 0), (Rgb8{0, 0, 255}));
  EXPECT_TRUE(warnings_.empty());
  // A binary file finds the same image. A file whose actual name contains the escape codes takes
  // precedence.
  const auto binary = write("a.glb", file.glb());
  EXPECT_EQ(material_of(load_mesh(binary)).texture(0, 0), (Rgb8{0, 255, 0}));
  write("my%20t%C3%A9x%2050%.png", image({255, 255, 0}));
  EXPECT_EQ(material_of(load_mesh(binary)).texture(0, 0), (Rgb8{255, 255, 0}));
}

TEST_F(Gltf, EachInstanceOfAMeshIsAnObject) {
  File file;
  file.set_triangle();
  const float half = std::sqrt(0.5F);
  file.json["nodes"][0]["translation"] = {0, 0, -10};
  file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", file.add<float>({1, 0, 0, 0, 2, 0}, "VEC3")},
      {"ROTATION", file.add<float>({0, 0, 0, 1, 0, 0, half, half}, "VEC4")},
      {"SCALE", file.add<float>({1, 1, 1, 2, 2, 2}, "VEC3")}};
  file.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Scene scene = load_both(file);
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.instances[0].name, "chair");
  EXPECT_EQ(scene.instances[1].name, "chair_2");
  EXPECT_EQ(scene.class_of, (std::vector<ClassId>(2, *class_by_name("chair"))));
  const std::vector<Vector3f> wanted = {{1, 10, 0}, {2, 10, 0}, {1, 10, 1},
                                        {0, 10, 2}, {0, 10, 4}, {-2, 10, 2}};
  ASSERT_EQ(scene.positions_m.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_LT((scene.positions_m[i] - wanted[i]).norm(), 1e-6F) << scene.positions_m[i];
  file.json["accessors"].back()["count"] = 1;
  EXPECT_TRUE(names(error_from(file), {"a.gltf: accessors[3]: does not fit"}));
}

TEST_F(Gltf, HiddenNodesAreLeftOutAndMorphTargetsWeighed) {
  File file;
  file.set_triangle();
  file.json["nodes"].push_back({{"mesh", 0},
                                {"children", {2}},
                                {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  file.json["nodes"].push_back({{"mesh", 0}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.primitive()["targets"] = {
      {{"POSITION", file.add<float>({0, 0, 0, 4, 0, 0, 0, 0, 0}, "VEC3")}},
      {{"POSITION", file.add<float>({0, 0, 0, 0, 0, 0, 0, 2, 0}, "VEC3")}}};
  file.json["meshes"][0]["weights"] = {0.25, 0};
  EXPECT_EQ(load_both(file).positions_m, (std::vector<Vector3f>{{0, 0, 0}, {2, 0, 0}, {0, 0, 1}}));
}

TEST_F(Gltf, SpecularMaterialsHaveTheirDiffuseColor) {
  write("t.png", image({255, 0, 0}));
  File file;
  file.set_triangle();
  file.set<float>("TEXCOORD_0", {0, 0, 1, 0, 0, 1}, "VEC2");
  Json& look = file.material()["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  look = {{"diffuseFactor", {1, 0, 1, 1}}};
  file.json["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  EXPECT_EQ(material_of(load(file)).base_color, (Rgb8{255, 0, 255}));
  file.json["images"] = {{{"uri", "t.png"}}};
  file.json["textures"] = {{{"source", 0}}};
  look["diffuseTexture"] = {{"index", 0},
                            {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}};
  const Scene scene = load(file);
  EXPECT_EQ(material_of(scene).texture(0, 0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(scene.uvs[1], Vector2f(2, 0));
  EXPECT_TRUE(warnings_.empty());
}

}  // namespace
}  // namespace mh
