// SPDX-License-Identifier: Apache-2.0
// What is repaired when files are read, and what files of one scene share.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "scenes/image_file.hpp"
#include "scenes/load.hpp"
#include "scenes/mesh_io/collada.hpp"
#include "scenes/mesh_io/gltf.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/obj_text.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class MeshRepair : public TemporaryFolder {
 protected:
  /// A square of two triangles; the lower one shows the left half of the image, the upper one the
  /// right half.
  fs::path write_square(const std::string& name, const std::string& look) const {
    write(name + ".mtl", "newmtl look\n" + look);
    return write(name + ".obj",
                 "mtllib " + name +
                     ".mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                     "vt 0.05 0.1\nvt 0.3 0.1\nvt 0.3 0.9\nvt 0.65 0.1\nvt 0.9 0.9\nvt 0.65 0.9\n"
                     "usemtl look\nf 1/1 2/2 3/3\nf 1/4 3/5 4/6\n");
  }
};

std::string ppm(int width, int height, const std::string& texels) {
  return "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" + texels;
}

/// One triangle with one material; `color` is the text between the tags.
std::string collada(const std::string& color, const std::string& positions) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Z_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="c"><phong><diffuse><color sid="d">)" +
         color +
         R"(</color></diffuse></phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="9">)" +
         positions + R"(</float_array><technique_common><accessor source="#pa" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/><p>
 0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n" name="chair_1"><instance_geometry url="#g">
<bind_material><technique_common><instance_material symbol="m" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshRepair, FacesBeforeTheFirstMaterialHaveNone) {
  write("c.mtl", "newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n");
  const auto color_of_first = [&](const std::string& color) {
    const Scene scene = load_mesh(write("c.obj", "mtllib c.mtl\nv 0 0 0" + color + "\nv 1 0 0" +
                                                     color + "\nv 0 1 0" + color + "\nv 1 1 0" +
                                                     color + "\nf 1 2 3\nusemtl green\nf 2 4 3\n"));
    EXPECT_EQ(scene.materials[scene.material_of[1]].base_color, (Rgb8{0, 255, 0}));
    return scene.materials[scene.material_of[0]].base_color;
  };
  EXPECT_EQ(color_of_first(""), (Rgb8{153, 153, 153})) << "as where no material is";
  EXPECT_EQ(color_of_first(" 0 0 1"), (Rgb8{255, 255, 255})) << "its colors show unchanged";
}

TEST_F(MeshRepair, ColladaMayHaveBlanksBeforeItsNumbers) {
  const Scene clean = load_mesh(write("a.dae", collada("1 0.5 0 1", "0 0 0 1 0 0 0 1 0")));
  ASSERT_EQ(clean.triangles.size(), 1U);
  EXPECT_EQ(clean.materials[clean.material_of[0]].base_color, (Rgb8{255, 128, 0}));
  for (const char* blank : {" ", "\n\t\t  ", "\r\n"}) {
    const std::string color = std::string(blank) + "1 0.5  0\t1" + blank;
    const std::string positions = std::string(blank) + "0 0 0\n1 0 0\n0 1 0" + blank;
    EXPECT_EQ(digest(load_mesh(write("b.dae", collada(color, positions)))), digest(clean));
  }
  EXPECT_EQ(repaired_collada("<a> \n x </a> <b> -1 </b>  "), "<a> \n x </a> <b>-1 </b>  ");
  EXPECT_EQ(repaired_collada(""), "");
  EXPECT_EQ(repaired_collada("a<b> 1"), "a<b>1");
  EXPECT_EQ(repaired_collada("<a"), "<a");
}

/// One triangle, in binary form if requested; `more` are additional members.
std::string gltf(const std::string& more, const std::string& in_node = "",
                 const std::string& in_accessor = "", bool binary = false) {
  const std::string uri =
      R"(,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA")";
  std::string text =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + in_node +
      R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" +
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3")" + in_accessor +
      R"(}],"bufferViews":[{"buffer":0,"byteLength":36}],)" + R"("buffers":[{"byteLength":36)" +
      (binary ? "" : uri) + "}]" + more + "}";
  if (!binary) return text;
  while (text.size() % 4 != 0) text += ' ';
  const auto raw = [](const auto& value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto number = [&](std::size_t n) { return raw(static_cast<std::uint32_t>(n)); };
  return "glTF" + number(2) + number(20 + text.size() + 8 + 36) + number(text.size()) + "JSON" +
         text + number(36) + std::string("BIN\0", 4) +
         raw(std::array<float, 9>{0, 0, 0, 1, 0, 0, 0, 1, 0});
}

TEST_F(MeshRepair, GltfIsReadWithoutItsAnimationsAndSkins) {
  const std::string moved =
      R"(,"animations":[{"channels":[],"samplers":[{"input":0,"output":0,"interpolation":1}]}])"
      R"(,"skins":[{"joints":[0]}])";
  for (const bool binary : {false, true}) {
    const char* name = binary ? "a.glb" : "a.gltf";
    const std::uint64_t clean = digest(load_mesh(write(name, gltf("", "", "", binary))));
    EXPECT_EQ(digest(load_mesh(write(name, gltf(moved, R"(,"skin":0)", "", binary)))), clean);
  }
  EXPECT_FALSE(repaired_gltf(gltf(""), "a.gltf"));
  for (const std::string none : {"", "glTF", "[", "{}", "[1]", "\xff"})
    EXPECT_FALSE(repaired_gltf(none, "a.gltf")) << none;
  const std::string whole = gltf(moved, "", "", true);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NO_THROW(repaired_gltf(whole.substr(0, size), "a.gltf"));
}

TEST_F(MeshRepair, GltfOfPlacesBeyondAnyBufferIsRefused) {
  for (const char* offset : {"18446744073709551608", "-4", "0.5"}) {
    try {
      load_mesh(write("a.gltf", gltf("", "", std::string(",\"byteOffset\":") + offset)));
      ADD_FAILURE() << offset;
    } catch (const InputError& error) {
      EXPECT_NE(
          std::string(error.what()).find(std::string("a.gltf: accessors[0].byteOffset: ") + offset),
          std::string::npos)
          << error.what();
    }
  }
}

TEST_F(MeshRepair, ObjMayLackZerosBeforePointsAndItsMaterialsBeAnisotropic) {
  EXPECT_EQ(repaired_obj("v .5 -.5\t+.5e1 1.5\nf 1 2 3\nusemtl a .5\n v .1"),
            "v 0.5 -0.5\t+0.5e1 1.5\nf 1 2 3\nusemtl a .5\n v 0.1");
  EXPECT_EQ(repaired_obj("newmtl m\naniso 0.7\nKd .5 0 0\nanisor 1"), "newmtl m\n\nKd .5 0 0\n\n");
  EXPECT_EQ(repaired_obj("mtllib a.mtl\nv .5 0 0\nf 1 1 1\nusemtl m\nf 1 1 1\n"),
            "mtllib a.mtl\nv 0.5 0 0\nusemtl DefaultMaterial\nf 1 1 1\nusemtl m\nf 1 1 1\n");
  EXPECT_FALSE(repaired_obj("mtllib a.mtl\nusemtl m\nf 1 1 1\n"));
  EXPECT_FALSE(repaired_obj("v 0 0 0\nf 1 1 1\nusemtl m\nf 1 1 1"));
  EXPECT_FALSE(repaired_obj(""));
  EXPECT_FALSE(repaired_obj("v 0.5 1.5 -2.5\n"));
  write("a.mtl", "newmtl m\nKd 1 0 0\naniso 0.7\nanisor 0.8\n");
  const Scene scene = load_mesh(
      write("a.obj", "mtllib a.mtl\nv 0 0 0\nv .5 0 0\nv 0 -.5e0 0\nusemtl m\nf 1 2 3\n"));
  ASSERT_EQ(scene.positions_m.size(), 3U);
  EXPECT_EQ(scene.positions_m[1], Eigen::Vector3f(0.5F, 0, 0));
  EXPECT_EQ(scene.positions_m[2], Eigen::Vector3f(0, -0.5F, 0));
  EXPECT_EQ(scene.materials[scene.material_of[0]].base_color, (Rgb8{255, 0, 0}));
}

TEST_F(MeshRepair, ColladaMayHaveAnImageThatNamesNoFile) {
  const std::string image = "<image id=\"i\"><!--<init_from>a.png</init_from>--></image>";
  EXPECT_EQ(repaired_collada(image),
            "<image id=\"i\"><init_from>that it does not name</init_from></image>");
  for (const std::string sound :
       {"<image id=\"i\"/><b></b>", "<image><init_from>a.png</init_from></image>"})
    EXPECT_EQ(repaired_collada(sound), sound);
  std::string file = collada("1 0.5 0 1", "0 0 0 1 0 0 0 1 0");
  const std::uint64_t clean = digest(load_mesh(write("a.dae", file)));
  file.insert(file.find("<library_effects>"), "<library_images>" + image + "</library_images>");
  EXPECT_EQ(digest(load_mesh(write("b.dae", file))), clean);
}

TEST_F(MeshRepair, ColladaMayHaveCommentsAndPolygonsWithHoles) {
  const std::string clean = collada("1 0.5 0 1", "0 0 0 1 0 0 0 1 0");
  const auto with = [&](std::string from, const std::string& to) {
    std::string text = clean;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos);
    return load_mesh(write("c.dae", text.replace(at, from.size(), to)));
  };
  const std::uint64_t seen = digest(load_mesh(write("a.dae", clean)));
  EXPECT_EQ(digest(with("<vertices id=\"v\">", "<vertices id=\"v\"><!-- <input/> -->")), seen);
  const std::string triangles =
      clean.substr(clean.find("<triangles"), clean.find("</triangles>") - clean.find("<triangles"));
  EXPECT_EQ(with(triangles + "</triangles>",
                 "<polygons count=\"1\" material=\"m\"><input semantic=\"VERTEX\" source=\"#v\" "
                 "offset=\"0\"/><ph><p>0 1 2</p><h>2 1 0</h></ph></polygons>")
                .triangles.size(),
            1U);
}

TEST_F(MeshRepair, FilesOfOneSceneShareOneImageInMemory) {
  const std::string texture = ppm(2, 1, std::string("\x10\x20\x30\x40\x50\x60", 6));
  write("paint.ppm", texture);
  write("copy.ppm", texture);  // a different file with the same image
  write_square("a", "map_Kd paint.ppm\n");
  write_square("b", "map_Kd copy.ppm\n");
  const Scene scene = load_scene(write("room.yaml",
                                       "objects:\n  - {file: a.obj}\n  - {file: b.obj}\n"
                                       "  - {file: a.obj, name: c}\n"));
  std::vector<const void*> images;
  for (const std::uint16_t material : scene.material_of)
    images.push_back(scene.materials[material].texture.identity());
  ASSERT_EQ(images.size(), 6U);
  EXPECT_NE(images[0], nullptr);
  EXPECT_EQ(std::ranges::count(images, images[0]), 6);
}

TEST_F(MeshRepair, ImagesFinerThanAnybodySeesAreShrunk) {
  // 1024 texels: on a width of 1 m they are kept; on 4 cm (0.04 mm each), their number is halved
  // until a texel measures 0.6 mm.
  std::string texels;
  for (int i = 0; i < 1024 * 4; ++i) texels += std::string(3, i % 2 == 0 ? '\0' : '\xff');
  write("fine.ppm", ppm(1024, 4, texels));
  write("m.mtl", "newmtl look\nmap_Kd fine.ppm\n");
  write("m.obj",
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 0.00390625 0\nv 0 0.00390625 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl look\nf 1/1 2/2 3/3 4/4\n");
  const auto width = [&](const char* scale) {
    const Scene scene = load_scene(
        write("s.yaml", std::string("objects:\n  - {file: m.obj, scale: ") + scale + "}\n"));
    return scene.materials[scene.material_of[0]].texture.width();
  };
  EXPECT_EQ(width("1"), 1024);
  EXPECT_EQ(width("0.6"), 512);
  EXPECT_EQ(width("0.04"), 64);
  const Scene scene = load_scene(folder_ / "s.yaml");
  // Averages over areas are taken in linear light: half of white is sRGB 188.
  EXPECT_EQ(scene.materials[scene.material_of[0]].texture(30, 0), (Rgb8{188, 188, 188}));
}

TEST_F(MeshRepair, EmissionIsMultipliedByItsTexture) {
  // The left half is black, the right half has a linear value of one half (sRGB 188).
  std::string texels;
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x) texels += std::string(3, x < 10 ? '\0' : '\xbc');
  write("glow.ppm", ppm(20, 10, texels));
  const Scene scene = load_mesh(write_square("lamp", "Kd 0 0 0\nKe 2 2 1\nmap_Ke glow.ppm\n"));
  ASSERT_EQ(scene.triangles.size(), 2U);
  const auto emission = [&](std::size_t face) {
    return scene.materials[scene.material_of[face]].emission;
  };
  EXPECT_TRUE(emission(0).isZero()) << emission(0).transpose();
  EXPECT_LT((emission(1) - Eigen::Vector3f(1, 1, 0.5F)).norm(), 0.06F) << emission(1).transpose();
  // Without a texture, the whole square glows; with a missing texture, nothing does, and there is a
  // warning.
  const Scene plain = load_mesh(write_square("plain", "Ke 2 2 1\n"));
  for (const std::uint16_t material : plain.material_of)
    EXPECT_EQ(plain.materials[material].emission, Eigen::Vector3f(2, 2, 1));
  std::vector<std::string> warnings;
  const Scene gone = load_mesh(write_square("gone", "Ke 2 2 1\nmap_Ke none.ppm\n"), &warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(names(warnings[0], {"none.ppm", "missing"}));
  EXPECT_TRUE(gone.materials[gone.material_of[0]].emission.isZero());
}

TEST_F(MeshRepair, APlyOfAScanWithoutTexturesKeepsItsFaces) {
  Scene scan;
  scan.name = "scan";
  scan.positions_m = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  scan.colors = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
  scan.triangles = {{0, 1, 2}};
  scan.material_of = {0};
  scan.class_of = {0};
  scan.instance_of = {0};
  scan.materials = {{.name = "scan", .texture = {}}};
  scan.instances = {};
  save_scannet_ply(scan, folder_ / "scan.ply");
  const Scene same = load_mesh(folder_ / "scan.ply");
  EXPECT_EQ(same.triangles, scan.triangles);
  EXPECT_EQ(same.colors, scan.colors);
}

TEST(ImageFile, WhatAPngSaysBesideTheImageIsNotHeard) {
  const std::string png = encode_png(Grid2d<std::uint8_t>(3, 2, 77));
  const std::string damaged_profile("\0\0\0\x05iCCPx\0\0zz\x6b\x4f\x36\x1c", 17);
  constexpr std::size_t kBehindHeader = 8 + 25;
  const std::string remark = png.substr(0, kBehindHeader) +
                             std::string("\0\0\0\4tEXtab\0c\xa0\x12\x2a\x3d", 16) +
                             png.substr(kBehindHeader);
  EXPECT_EQ(without_remarks(remark), png);
  EXPECT_EQ(
      without_remarks(png.substr(0, kBehindHeader) + damaged_profile + png.substr(kBehindHeader)),
      png);
  EXPECT_EQ(without_remarks("no PNG"), "no PNG");
  for (std::size_t size = 0; size < png.size(); ++size) without_remarks(png.substr(0, size));
}

}  // namespace
}  // namespace mh
