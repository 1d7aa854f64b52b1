// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/mesh_io.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <set>

#include "scenes/image_file.hpp"
#include "scenes/labeled.hpp"
#include "scenes/load.hpp"
#include "scenes/materials/materials.hpp"
#include "scenes/mesh_io/class_words.hpp"
#include "scenes/mesh_io/node_name.hpp"
#include "scenes/mesh_io/subdivide.hpp"
#include "scenes/srgb.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {
namespace fs = std::filesystem;

class MeshIo : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("mh_mesh_io_" + std::string(info->name()) + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

  /// The message of the InputError that loading throws.
  static std::string error_of(const fs::path& file) {
    try {
      load_mesh(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

/// Curved, textured, lit pieces of three classes and one unlabeled piece; they share materials.
Scene example_scene() {
  Scene scene;
  scene.name = "example";
  scene.materials = {
      make_material({.name = "oak", .kind = "wood_grain"}),
      make_material({.name = "weave", .kind = "fabric", .tone = {70, 90, 140}}),
      {.name = "paint", .base_color = {210, 60, 35}, .texture = {}},
      {.name = "bulb", .base_color = {255, 240, 200}, .texture = {}, .emission = {3, 2.5F, 2}}};
  scene.instances = {{.id = 1, .class_id = 5, .name = "kitchen/chair_1"},
                     {.id = 4, .class_id = 43, .name = "kitchen/potted_plant"},
                     {.id = 9, .class_id = 35, .name = "lamp"}};
  const std::array<InstanceId, 4> instance{1, 4, 9, 0};
  const std::array<ClassId, 4> class_id{5, 43, 35, 2};
  for (int piece = 0; piece < 4; ++piece)
    for (int j = 0; j <= 12; ++j)
      for (int i = 0; i <= 12; ++i) {
        const auto u = static_cast<float>(i) / 12.0F, v = static_cast<float>(j) / 12.0F;
        const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
        scene.positions_m.emplace_back(2.0F * piece + u, 3.0F * v - 1.1F,
                                       0.3F * std::sin(5.0F * u + v) + 0.1F);
        scene.uvs.emplace_back(2.3F * u - 0.4F, 1.7F * v);
        scene.light.emplace_back(0.2F + 1.1F * u, 0.9F - 0.5F * v, 0.4F);
        if (i == 12 || j == 12) continue;
        for (const auto& triangle : {std::array{first, first + 1, first + 13},
                                     std::array{first + 1, first + 14, first + 13}}) {
          scene.triangles.push_back(triangle);
          scene.material_of.push_back(static_cast<std::uint16_t>(j < 6 ? piece : 0));
          scene.class_of.push_back(class_id[piece]);
          scene.instance_of.push_back(instance[piece]);
        }
      }
  scene.rooms = {{.name = "kitchen", .polygon_m = {{0, 0}, {4.125, 0}, {4.125, 3}, {0, 3}}}};
  validate(scene);
  return scene;
}

/// A face in a form that can be compared across files: position, class and look.
struct FaceRecord {
  std::array<Eigen::Vector3f, 3> corners;
  std::array<Eigen::Vector2f, 3> uvs;
  std::array<Eigen::Vector3f, 3> light;
  ClassId class_id;
  InstanceId instance;
  std::string material;
};

std::vector<FaceRecord> sorted_faces(const Scene& scene) {
  std::vector<FaceRecord> faces;
  for (std::size_t f = 0; f < scene.triangles.size(); ++f) {
    FaceRecord record;
    for (int k = 0; k < 3; ++k) {
      const auto v = scene.triangles[f][k];
      record.corners[k] = scene.positions_m[v];
      record.uvs[k] = scene.uvs[v];
      record.light[k] = scene.light[v];
    }
    record.class_id = scene.class_of[f];
    record.instance = scene.instance_of[f];
    record.material = scene.materials[scene.material_of[f]].name;
    faces.push_back(record);
  }
  const auto key = [](const FaceRecord& r) {
    const Eigen::Vector3f c = r.corners[0] + r.corners[1] + r.corners[2];
    return std::tuple(std::lround(c.x() * 1e3F), std::lround(c.y() * 1e3F),
                      std::lround(c.z() * 1e3F));
  };
  std::ranges::sort(faces, {}, key);
  return faces;
}

TEST_F(MeshIo, GlbReadBackIsTheSameScene) {
  const Scene scene = example_scene();
  save_glb(scene, folder_ / "scene.glb");
  std::vector<std::string> warnings;
  const Scene read = load_mesh(folder_ / "scene.glb", &warnings);
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(read.triangles.size(), scene.triangles.size());

  const auto expected = sorted_faces(scene), actual = sorted_faces(read);
  for (std::size_t f = 0; f < expected.size(); ++f) {
    EXPECT_EQ(actual[f].class_id, expected[f].class_id);
    EXPECT_EQ(actual[f].instance, expected[f].instance);
    EXPECT_EQ(actual[f].material, expected[f].material);
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT((actual[f].corners[k] - expected[f].corners[k]).norm(), 1e-5F);
      EXPECT_LT((actual[f].uvs[k] - expected[f].uvs[k]).norm(), 1e-5F);
      EXPECT_LT((actual[f].light[k] - expected[f].light[k]).norm(), 1e-5F);
    }
  }
  ASSERT_EQ(read.instances.size(), scene.instances.size());
  for (std::size_t i = 0; i < read.instances.size(); ++i) {
    EXPECT_EQ(read.instances[i].id, scene.instances[i].id);
    EXPECT_EQ(read.instances[i].class_id, scene.instances[i].class_id);
    EXPECT_EQ(read.instances[i].name, scene.instances[i].name);
  }
  for (const Material& material : scene.materials) {
    const auto found = std::ranges::find(read.materials, material.name, &Material::name);
    ASSERT_NE(found, read.materials.end()) << material.name;
    EXPECT_EQ(found->texture, material.texture) << material.name;
    EXPECT_EQ(found->base_color, material.base_color) << material.name;
    EXPECT_LT((found->emission - material.emission).norm(), 1e-5F) << material.name;
  }
}

TEST_F(MeshIo, HolesOfATextureSurviveAGlb) {
  Scene scene = example_scene();
  Material& leaf = scene.materials[0];
  Grid2d<std::uint8_t> opacity(leaf.texture.width(), leaf.texture.height(), 255);
  opacity(3, 2) = 0;
  opacity(4, 2) = kOpaqueFrom - 1;
  leaf.opacity = opacity;
  save_glb(scene, folder_ / "leaf.glb");
  const Scene read = load_mesh(folder_ / "leaf.glb");
  const auto& same = *std::ranges::find(read.materials, leaf.name, &Material::name);
  EXPECT_EQ(same.opacity, leaf.opacity);
  EXPECT_EQ(same.texture, leaf.texture);
  for (const Material& other : read.materials)
    EXPECT_EQ(other.opacity.empty(), other.name != leaf.name) << other.name;
}

TEST_F(MeshIo, APaneSurvivesAGlb) {
  Scene scene = example_scene();
  Material& glass = scene.materials[0];
  glass.transmission = {0.8F, 0.9F, 0.85F};
  save_glb(scene, folder_ / "glass.glb");
  const Scene read = load_mesh(folder_ / "glass.glb");
  for (const Material& material : read.materials)
    if (material.name == glass.name)
      EXPECT_LT((material.transmission - glass.transmission).norm(), 1e-6F);
    else
      EXPECT_FALSE(material.is_pane()) << material.name;
}

TEST_F(MeshIo, AMaterialThatIsMostlySeenThroughIsAPane) {
  write("room.mtl",
        "newmtl glass\nKd 0 1 0\nd 0.25\nnewmtl milk\nKd 1 1 1\nd 0.8\nnewmtl gone\nd 0\n");
  const auto file = write("room.obj",
                          "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\n"
                          "o window_1\nusemtl glass\nf 1 2 3\n"
                          "o lamp_1\nusemtl milk\nf 1 2 3\n"
                          "o box_1\nusemtl gone\nf 1 2 3\n");
  const Scene scene = load_mesh(file);
  const auto transmission = [&](const char* name) {
    return std::ranges::find(scene.materials, name, &Material::name)->transmission;
  };
  EXPECT_LT((transmission("glass") - Eigen::Vector3f(0.75F, 1.0F, 0.75F)).norm(), 1e-6F);
  EXPECT_TRUE(transmission("milk").isZero());
  EXPECT_TRUE(transmission("gone").isZero());
}

TEST_F(MeshIo, AMaskBesideAnObjTextureCutsHoles) {
  write("leaf.mtl", "newmtl leaf\nmap_Kd pic.ppm\nmap_d mask.pgm\n");
  write("pic.ppm", std::string("P6\n2 1\n255\n") + std::string("\xff\x00\x00\x00\x00\xff", 6));
  write("mask.pgm", std::string("P5\n2 1\n255\n") + std::string("\x00\xff", 2));
  const auto file = write("leaf.obj",
                          "mtllib leaf.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                          "o plant_1\nusemtl leaf\nf 1/1 2/2 3/3\n");
  const Scene scene = load_mesh(file);
  const auto& leaf = *std::ranges::find(scene.materials, "leaf", &Material::name);
  ASSERT_EQ(leaf.opacity.size(), 2U);
  EXPECT_EQ(leaf.opacity(0, 0), 0);
  EXPECT_EQ(leaf.opacity(1, 0), 255);
}

TEST_F(MeshIo, AMaskCutsTheSameHolesIntoAVeryWideTexture) {
  constexpr int kWidth = 60000;  // squared, it needs more than 31 bits
  Grid2d<std::uint8_t> texture(kWidth, 1, 200), mask(kWidth, 1, 0);
  for (int x = 0; x < kWidth; ++x) mask(x, 0) = x % 7 == 0 ? 0 : 255;
  write("leaf.mtl", "newmtl leaf\nmap_Kd wide.png\nmap_d mask.png\n");
  write("wide.png", encode_png(texture));
  write("mask.png", encode_png(mask));
  const auto file = write("leaf.obj",
                          "mtllib leaf.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                          "usemtl leaf\nf 1/1 2/2 3/3\n");
  const Scene scene = load_mesh(file);
  const Grid2d<std::uint8_t>& opacity = scene.materials[scene.material_of[0]].opacity;
  ASSERT_EQ(opacity.width(), kWidth);
  EXPECT_TRUE(std::equal(opacity.begin(), opacity.end(), mask.begin()));
}

TEST_F(MeshIo, TwoGltfMaterialsOfOneNameGlowEachAsItSays) {
  const auto material = [](const std::string& red, const std::string& strength) {
    return R"({"name":"lamp","emissiveFactor":[)" + red +
           R"(,0,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":)" +
           strength + "}}}";
  };
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  write("lamps.bin", {reinterpret_cast<const char*>(corners), sizeof corners});
  const auto file = write(
      "lamps.gltf",
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"mesh":0,"children":[1]},{"mesh":1}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":1}]},)"
      R"({"primitives":[{"attributes":{"POSITION":0},"material":3},)"
      R"({"attributes":{"POSITION":0},"material":2}]}],)"
      R"("buffers":[{"uri":"lamps.bin","byteLength":36}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"materials":[)" +
          material("1", "100") + "," + material("1", "8") +
          R"(,{"name":"lamp","emissiveFactor":[0.5,0,0]},)" + material("1", "3") + "]}");
  const Scene scene = load_mesh(file);
  std::vector<float> reds;
  for (const std::uint16_t of_face : scene.material_of)
    reds.push_back(scene.materials[of_face].emission.x());
  EXPECT_EQ(reds, (std::vector<float>{8.0F, 3.0F, 0.5F}));
}

TEST_F(MeshIo, ATextureThatIsNoImageIsNamedAndMagenta) {
  write("room.mtl", "newmtl text\nmap_Kd text.png\nnewmtl huge\nmap_Kd huge.png\n");
  write("text.png", "this is not an image");
  // The first bytes of a PNG that declare 30,000 x 30,000 pixels, with nothing after them.
  write("huge.png",
        std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x75\x30\0\0\x75\x30\x08\x02", 26));
  const auto file = write("room.obj",
                          "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                          "o a\nusemtl text\nf 1/1 2/2 3/3\no b\nusemtl huge\nf 1/1 2/2 3/3\n");
  std::vector<std::string> warnings;
  const Scene scene = load_mesh(file, &warnings);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].find("text.png"), std::string::npos);
  EXPECT_NE(warnings[1].find("huge.png"), std::string::npos);
}

TEST_F(MeshIo, ACutTextureAndAMissingMtllibAreNamed) {
  const std::string png = encode_png(Grid2d<std::uint8_t>(64, 64));
  write("room.mtl", "newmtl cut\nmap_Kd cut.png\n");
  write("cut.png", png.substr(0, png.size() / 2));
  const std::string mesh =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\no a\nusemtl cut\nf 1/1 2/2 3/3\n";
  std::vector<std::string> warnings;
  testing::internal::CaptureStderr();
  load_mesh(write("room.obj", "mtllib room.mtl\n" + mesh), &warnings);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // libpng prints nothing
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("cut.png is truncated"), std::string::npos);
  warnings.clear();
  load_mesh(write("other.obj", "# mtllib no.mtl\nmtllib gone away.mtl \r\n" + mesh), &warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("other.obj:2: mtllib gone away.mtl is missing"), std::string::npos);
  warnings.clear();
  load_mesh(write("room.obj", "mtllib gone.mtl\n" + mesh), &warnings);  // room.mtl is used
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("cut.png"), std::string::npos);
}

TEST_F(MeshIo, WithoutAPlanEachFloorIsARoom) {
  Scene scene = example_scene();
  scene.instances[0] = {.id = 1, .class_id = 2, .name = "hall/floor"};
  for (std::size_t face = 0; face < scene.triangles.size(); ++face)
    if (scene.instance_of[face] == 1) scene.class_of[face] = 2;
  save_glb(scene, folder_ / "hall.glb");
  const Scene read = load_mesh(folder_ / "hall.glb");
  ASSERT_EQ(read.rooms.size(), 1U);
  EXPECT_EQ(read.rooms[0].name, "hall");
  EXPECT_NEAR(read.floor_area_m2(), 1.0 * 3.0, 1e-4);  // the bounding box of the piece, 1 m by 3 m
}

TEST_F(MeshIo, PlyReadBackKeepsOrderLabelsAndColors) {
  const Scene scene = example_scene();
  save_scannet_ply(scene, folder_ / "scene.ply", 0.0F);
  const Scene read = load_scene(folder_ / "scene.ply");
  EXPECT_EQ(read.name, scene.name);
  ASSERT_EQ(read.triangles, scene.triangles);
  EXPECT_EQ(read.class_of, scene.class_of);
  EXPECT_EQ(read.instance_of, scene.instance_of);
  ASSERT_EQ(read.positions_m.size(), scene.positions_m.size());
  for (std::size_t v = 0; v < read.positions_m.size(); ++v)
    EXPECT_EQ(read.positions_m[v], scene.positions_m[v]);
  ASSERT_EQ(read.colors.size(), scene.positions_m.size());
  EXPECT_TRUE(read.light.empty());
  ASSERT_EQ(read.rooms.size(), 1U);
  EXPECT_DOUBLE_EQ(read.floor_area_m2(), scene.floor_area_m2());
  EXPECT_EQ(read.instances[1].name, "kitchen/potted_plant");
  for (const Material& material : read.materials)
    EXPECT_EQ(material.base_color, (Rgb8{255, 255, 255}));
  for (std::size_t i = 0; i < read.instances.size(); ++i)
    EXPECT_LT(read.instances[i].min_m.x(), read.instances[i].max_m.x());
}

TEST_F(MeshIo, PlyColorIsTextureTimesLight) {
  // A uniform texture of known color under known light: the vertex color has a closed form.
  Scene scene;
  scene.name = "square";
  scene.materials = {
      {.name = "m", .base_color = {128, 255, 64}, .texture = Grid2d<Rgb8>(4, 4, {200, 100, 255})}};
  scene.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.uvs = {{0, 0}, {0.9F, 0.1F}, {-3.7F, 5.2F}};
  scene.light = {{1, 1, 1}, {0.25F, 0.5F, 0.75F}, {9, 9, 9}};
  scene.triangles = {{0, 1, 2}};
  scene.material_of = {0};
  scene.class_of = {2};
  scene.instance_of = {0};
  save_scannet_ply(scene, folder_ / "square.ply", 0.0F);
  const Scene read = load_mesh(folder_ / "square.ply");
  const auto linear = [](double level) {
    const double v = level / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const auto level = [](double v) {
    v = std::min(v, 1.0);
    return 255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
  };
  for (int v = 0; v < 3; ++v) {
    const Eigen::Vector3f light = scene.light[v];
    EXPECT_NEAR(read.colors[v].r, level(linear(200) * linear(128) * light.x()), 1.0);
    EXPECT_NEAR(read.colors[v].g, level(linear(100) * light.y()), 1.0);
    EXPECT_NEAR(read.colors[v].b, level(linear(64) * light.z()), 1.0);
  }
}

TEST_F(MeshIo, GltfExtrasNameClassAndInstanceAndYBecomesUp) {
  // One triangle from data embedded in the file: (0,0,0), (1,0,0), (0,2,0) in glTF's y-up frame.
  const auto file = write("extras.gltf", R"({"asset":{"version":"2.0"},"scene":0,
    "scenes":[{"nodes":[0,1]}],
    "nodes":[{"name":"thing","mesh":0,"extras":{"class":"night stand","instance":7}},
             {"name":"sofa_left","mesh":0,"translation":[0,0,5]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,0]}]})");
  const Scene scene = load_mesh(file);
  ASSERT_EQ(scene.triangles.size(), 2U);
  EXPECT_EQ(scene.class_of[0], *class_by_name("night stand"));
  EXPECT_EQ(scene.instance_of[0], 7);
  EXPECT_EQ(scene.class_of[1], *class_by_name("sofa"));
  EXPECT_EQ(scene.instance_of[1], 1);
  EXPECT_TRUE(scene.positions_m[2].isApprox(Eigen::Vector3f(0, 0, 2)));
  EXPECT_TRUE(scene.positions_m[5].isApprox(Eigen::Vector3f(0, -5, 2)));
}

TEST_F(MeshIo, ObjTextureBesideItAndAMissingOneIsNamedAndMagenta) {
  write("room.mtl", "newmtl there\nKd 1 1 1\nmap_Kd pic.ppm\nnewmtl gone\nmap_Kd nowhere.png\n");
  write("pic.ppm", std::string("P6\n2 1\n255\n") + std::string("\xff\x00\x00\x00\x00\xff", 6));
  const auto file = write("room.obj",
                          "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                          "o chair_1\nusemtl there\nf 1/1 2/2 3/3 4/4\n"
                          "o table_1\nusemtl gone\nf 1/1 2/2 3/3\n");
  std::vector<std::string> warnings;
  const Scene scene = load_mesh(file, &warnings);
  EXPECT_EQ(scene.triangles.size(), 3U);  // the square was split in two
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("nowhere.png"), std::string::npos);
  const auto& there = *std::ranges::find(scene.materials, "there", &Material::name);
  EXPECT_EQ(there.texture(0, 0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(there.texture(1, 0), (Rgb8{0, 0, 255}));
  const auto& gone = *std::ranges::find(scene.materials, "gone", &Material::name);
  EXPECT_TRUE(gone.texture.empty());
  EXPECT_EQ(gone.base_color, (Rgb8{255, 0, 255}));
  // v counts downward here: (0, 0) in OBJ is the lower left corner of the image.
  for (std::size_t v = 0; v < scene.positions_m.size(); ++v)
    EXPECT_FLOAT_EQ(scene.uvs[v].y(), 1.0F - scene.positions_m[v].y());
  EXPECT_EQ(scene.class_of[0], *class_by_name("chair"));
  EXPECT_EQ(scene.class_of[2], *class_by_name("table"));
  EXPECT_NE(scene.instance_of[0], scene.instance_of[2]);
}

TEST_F(MeshIo, DaeIsTurnedZUpAndScaledToMeters) {
  const auto file = write("box.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 100 0 0 0 200 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="lamp" name="lamp"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  const Scene scene = load_mesh(file);
  ASSERT_EQ(scene.triangles.size(), 1U);
  EXPECT_TRUE(scene.positions_m[scene.triangles[0][2]].isApprox(Eigen::Vector3f(0, 0, 2), 1e-5F))
      << scene.positions_m[scene.triangles[0][2]].transpose();
  EXPECT_EQ(scene.class_of[0], *class_by_name("lamp"));
}

TEST_F(MeshIo, BadFilesGiveOneErrorThatNamesThem) {
  EXPECT_NE(error_of(folder_ / "none.ply").find("no such file"), std::string::npos);
  const auto text = write("text.ply", "this is not a mesh\n");
  EXPECT_NE(error_of(text).find("text.ply"), std::string::npos);
  EXPECT_NE(error_of(write("text.glb", "this is not a mesh\n")).find("text.glb"),
            std::string::npos);
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face ";
  const std::string list = "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto nan = write("nan.ply", header + "1" + list + "0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n");
  EXPECT_NE(error_of(nan).find("not finite"), std::string::npos) << error_of(nan);
  const auto points = write("points.ply", header + "0" + list + "0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_NE(error_of(points).find("no visible faces"), std::string::npos) << error_of(points);
  const auto wild = write("wild.ply", header + "1" + list + "0 0 0\n1 0 0\n0 1 0\n3 0 1 99\n");
  EXPECT_NE(error_of(wild), "");
  EXPECT_THROW(load_scene(folder_ / "scene.xyz"), InputError);
}

TEST_F(MeshIo, APolygonOfVeryManyCornersIsAFan) {
  constexpr int kCorners = 3000;
  std::string text, face = "f";
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    face.append(" ").append(std::to_string(i + 1));
  }
  std::vector<std::string> warnings;
  const Scene scene = load_mesh(write("disk.obj", text + "f 1 2 3\n" + face + "\n"), &warnings);
  ASSERT_EQ(scene.triangles.size(), 1U + kCorners - 2);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("face of 3000 corners"), std::string::npos) << warnings[0];
  double area = 0;
  for (std::size_t t = 1; t < scene.triangles.size(); ++t) {
    const auto& [a, b, c] = scene.triangles[t];
    const auto& p = scene.positions_m;
    area += 0.5 * (p[b] - p[a]).cast<double>().cross((p[c] - p[a]).cast<double>()).z();
  }
  EXPECT_NEAR(area, std::numbers::pi, 1e-4);  // coordinates are written with six digits
}

TEST_F(MeshIo, ObjectsOfOneNameAreCounted) {
  const auto file =
      write("same.gltf",
            R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2,3,4,5]}],
"nodes":[{"mesh":0,"name":"chair"},{"mesh":0,"name":"chair_2"},{"mesh":0,"name":"chair"},
{"mesh":0,"name":"chair"},{"mesh":0,"name":"x#class=chair#instance=70000"},{"mesh":0,"name":"chair_2"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":
"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  std::vector<std::string> names;
  for (const Instance& instance : load_mesh(file).instances) names.push_back(instance.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"chair", "chair_2", "chair_3", "chair_4", "x", "chair_2_2"}));
}

TEST_F(MeshIo, ExtrasThatAreNoIdsAreNone) {
  const auto file = write("extras.gltf",
                          R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2,3]}],
"nodes":[{"mesh":0,"name":"a","extras":{"instance":65541}},{"mesh":0,"name":"b","extras":{"instance":5.9}},
{"mesh":0,"name":"c","extras":{"instance":9,"class":300}},{"mesh":0,"name":"d","extras":{"instance":-5}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":
"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  std::map<std::string, int> ids;
  for (const Instance& instance : load_mesh(file).instances) {
    ids[instance.name] = instance.id;
    EXPECT_EQ(instance.class_id, kVoid);
  }
  EXPECT_EQ(ids, (std::map<std::string, int>{{"a", 1}, {"b", 2}, {"c", 9}, {"d", 3}}));
}

TEST_F(MeshIo, LabelsOfAnotherMeshAreRefused) {
  const Scene scene = example_scene();
  save_scannet_ply(scene, folder_ / "a.ply", 0.0F);
  Scene smaller = scene;
  smaller.triangles.pop_back();
  smaller.material_of.pop_back();
  smaller.class_of.pop_back();
  smaller.instance_of.pop_back();
  save_scannet_ply(smaller, folder_ / "b.ply", 0.0F);
  fs::rename(folder_ / "b.labels.json", folder_ / "a.labels.json");
  EXPECT_NE(error_of(folder_ / "a.ply").find("a.labels.json"), std::string::npos);
  write("a.labels.json", "{\"format\": ");
  EXPECT_NE(error_of(folder_ / "a.ply").find("a.labels.json"), std::string::npos);
}

TEST_F(MeshIo, AnUnwritableFolderLeavesNothingBehind) {
  EXPECT_THROW(save_glb(example_scene(), folder_ / "none" / "a.glb"), InputError);
  EXPECT_THROW(save_scannet_ply(example_scene(), folder_ / "none" / "a.ply"), InputError);
  EXPECT_TRUE(fs::is_empty(folder_));
}

double area_m2(const Scene& scene, ClassId class_id) {
  double sum = 0.0;
  for (std::size_t f = 0; f < scene.triangles.size(); ++f) {
    const auto& [a, b, c] = scene.triangles[f];
    const Eigen::Vector3f ab = scene.positions_m[b] - scene.positions_m[a];
    const Eigen::Vector3f ac = scene.positions_m[c] - scene.positions_m[a];
    if (scene.class_of[f] == class_id) sum += 0.5 * ab.cross(ac).norm();
  }
  return sum;
}

TEST_F(MeshIo, ADensePlyHasTheSameSurfacesAndMoreOfTheTexture) {
  const Scene scene = example_scene();
  save_scannet_ply(scene, folder_ / "dense.ply");
  const Scene read = load_mesh(folder_ / "dense.ply");
  EXPECT_GT(read.triangles.size(), 5 * scene.triangles.size());
  // The piece without an instance counts as background and stays unchanged.
  EXPECT_EQ(std::ranges::count(read.instance_of, 0), std::ranges::count(scene.instance_of, 0));
  for (const ClassId id : {5, 43, 35, 2}) {
    ASSERT_GT(area_m2(scene, id), 1.0);
    EXPECT_NEAR(area_m2(read, id), area_m2(scene, id), 1e-3) << int{id};
  }
  EXPECT_EQ(read.instances.size(), scene.instances.size());
}

TEST(Subdivide, KeepsEdgesShortNeighborsJoinedAndInterpolatesLinearly) {
  Scene scene;  // a square and an irregular triangle attached to it; light = x, uv = (y, x + y)
  scene.positions_m = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {3, 0.4F, 0}};
  for (const Eigen::Vector3f& p : scene.positions_m) {
    scene.light.emplace_back(p.x(), p.x(), p.x());
    scene.uvs.emplace_back(p.y(), p.x() + p.y());
  }
  scene.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
  scene.material_of = {0, 0, 0};
  scene.class_of = {1, 2, 3};
  scene.instance_of = {0, 0, 0};
  scene.materials = {{.name = "m", .texture = {}}};
  const Scene fine = subdivide(scene, 0.1F);
  EXPECT_NO_THROW(validate(fine));
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> faces_at_edge;
  for (const auto& t : fine.triangles)
    for (int i = 0; i < 3; ++i) {
      const auto a = t[i], b = t[(i + 1) % 3];
      EXPECT_LE((fine.positions_m[a] - fine.positions_m[b]).norm(), 0.1F + 1e-6F);
      ++faces_at_edge[std::minmax(a, b)];
    }
  // A crack would show up as an edge that has one face and is not on the outline.
  double outline = 0.0;
  for (const auto& [edge, count] : faces_at_edge) {
    EXPECT_LE(count, 2);
    if (count == 1)
      outline += (fine.positions_m[edge.first] - fine.positions_m[edge.second]).norm();
  }
  EXPECT_NEAR(outline, 3.0 + std::hypot(2.0, 0.4) + std::hypot(2.0, 0.6), 1e-4);
  for (std::size_t v = 0; v < fine.positions_m.size(); ++v) {
    const Eigen::Vector3f& p = fine.positions_m[v];
    EXPECT_NEAR(fine.light[v].x(), p.x(), 1e-5F);
    EXPECT_NEAR(fine.uvs[v].y(), p.x() + p.y(), 1e-5F);
  }
  for (const ClassId id : {1, 2}) EXPECT_NEAR(area_m2(fine, id), 0.5, 1e-5);
  EXPECT_NEAR(area_m2(fine, 3), 1.0, 1e-5);
}

TEST(NodeName, RoundTrip) {
  for (const ClassInfo& info : classes()) {
    const NodeLabel label = parse_node_name(node_name("kitchen/x_2", info.id, 513));
    EXPECT_EQ(label.name, "kitchen/x_2");
    EXPECT_EQ(label.class_id, info.id);
    EXPECT_EQ(label.instance, 513);
  }
}

TEST(NodeName, GuessesClassFromTheNounOfTheLastPart) {
  const std::pair<const char*, const char*> kNames[] = {
      {"kitchen/night_stand_2", "night stand"},
      {"Chair.003", "chair"},
      {"sofa left", "sofa"},
      {"wooden_table_02", "table"},
      {"wooden_bookshelf_worn", "bookshelf"},
      {"table/gadget", "void"},
      {"", "void"},
      // CamelCase, digits, vendor prefixes.
      {"KitchenTable_01", "table"},
      {"aws_robomaker_residential_NightStand_01", "night stand"},
      {"FloorB_01", "floor"},
      {"TVCabinet_01", "cabinet"},
      {"TV_02", "television"},
      {"SM_Chair2Left", "chair"},
      // Plurals and synonyms.
      {"Chairs", "chair"},
      {"boxes_3", "box"},
      {"bookshelves", "bookshelf"},
      {"Couch", "sofa"},
      {"fridge_white", "refridgerator"},
      {"telly", "television"},
      {"lamp_stand", "lamp"},
      {"LampStand", "lamp"},
      {"nightstand", "night stand"},
      {"coffeeTable", "table"},
      {"Wardrobe_01", "cabinet"},
      {"DeskPortraitA_02", "picture"},
      {"GroundB_01", "floor"},
      {"books", "books"},
      {"wall_clock", "clock"},
      {"microwaveOven", "microwave"},
      // Names of two classes: the noun counts.
      {"floor_01_walls", "wall"},
      {"hospital_floor_02_ceiling", "ceiling"},
      {"table_lamp", "lamp"},
      {"floor lamp", "lamp"},
      {"shower_curtain", "shower curtain"},
      {"chair_and_table", "chair"},
      {"table_with_chairs", "table"},
      {"box_of_books", "box"},
      {"window_frame", "window"},
      // Words that only look like the name of a class.
      {"portable_gadget", "void"},
      {"bedroom", "void"},
      {"Bed_Room", "void"},
      {"floor_plan", "void"},
      {"background", "void"},
  };
  for (const auto& [name, class_name] : kNames)
    EXPECT_EQ(classes()[guess_class(name)].name, class_name) << name;
}

TEST(NodeName, WordsOfTheListNameClassesAndStandOnce) {
  std::set<std::string_view> words;
  for (const ClassWord& word : kClassWords) {
    EXPECT_TRUE(class_by_name(word.class_name)) << word.class_name;
    EXPECT_TRUE(words.insert(word.words).second) << word.words;
    EXPECT_EQ(classes()[guess_class(word.words)].name, word.class_name) << word.words;
  }
}

TEST_F(MeshIo, NamesAroundANodeHelpWhereItsOwnTellsNothing) {
  // Three kinds of nodes: with a named mesh; below a named group; below a story.
  const char* gltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"name":"root","children":[1,2,4,6]},{"name":"Cube","mesh":0},
             {"name":"Walls","children":[3]},{"name":"Cube.001","mesh":1},
             {"name":"first_floor","children":[5]},{"name":"Cube.002","mesh":1},
             {"name":"Cube.003","mesh":1}],
    "meshes":[{"name":"BigSofa","primitives":[{"attributes":{"POSITION":0}}]},
              {"name":"Mesh","primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                  "min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  std::ofstream(folder_ / "room.gltf") << gltf;
  const Scene scene = load_mesh(folder_ / "room.gltf");
  std::map<std::string, std::string_view> class_of;
  for (const Instance& instance : scene.instances)
    class_of[instance.name] = classes()[instance.class_id].name;
  EXPECT_EQ(class_of["Cube"], "sofa");
  EXPECT_EQ(class_of["Cube.001"], "wall");
  EXPECT_EQ(class_of["Cube.002"], "void");
  EXPECT_EQ(class_of["Cube.003"], "void");
}

TEST_F(MeshIo, LabelsThatAreSuggestedLoadAsTheyAreAndWhenFilled) {
  std::ofstream(folder_ / "room.obj") << "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nv 1 0 0\nv 0 1 0\n"
                                         "o gizmo_01\nf 1 2 3\no gizmo_02\nf 1 2 4\n"
                                         "o w[1]dget\nf 1 5 6\no chair\nf 1 5 4\n";
  const Scene before = load_mesh(folder_ / "room.obj");
  const LabeledSurface surface = survey_labels(before);
  EXPECT_NEAR(surface.area_m2, 2 + 2 + 0.5 + 1, 1e-6);
  EXPECT_NEAR(surface.share(), 1 / 5.5, 1e-6);
  ASSERT_EQ(surface.unlabeled.size(), 2U);
  EXPECT_EQ(surface.unlabeled[0].pattern, "gizmo*");
  EXPECT_NEAR(surface.unlabeled[0].area_m2, 4, 1e-6);
  std::string text = suggested_labels(surface);
  std::ofstream(folder_ / "labels.yaml") << text;
  EXPECT_EQ(load_mesh(folder_ / "room.obj").class_of, before.class_of);
  for (const char* name : {"table", "clock"})
    text.replace(text.find("void", text.find('"')), 4, name);
  std::ofstream(folder_ / "labels.yaml") << text;
  const Scene after = load_mesh(folder_ / "room.obj");
  EXPECT_EQ(survey_labels(after).share(), 1.0);
  EXPECT_EQ(after.class_of[0], *class_by_name("table"));
  EXPECT_EQ(after.class_of[2], *class_by_name("clock"));
}

}  // namespace
}  // namespace mh
