// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/mtl_textures.hpp"

#include <gtest/gtest.h>

#include "scenes/mesh_io/mesh_io.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

using Eigen::Vector2f;

/// What is left of one line of a material after its options are removed.
std::string plain(const std::string& line, MtlTextures& textures) {
  const auto found = without_options("newmtl m\n" + line, "a.mtl", textures);
  return found ? found->substr(std::string("newmtl m\n").size()) : "";
}

TEST(MtlTextures, OptionsAroundANameAreReadAndRemoved) {
  const auto uvs = [](const std::string& line, const std::string& left) {
    MtlTextures textures;
    EXPECT_EQ(plain(line, textures), left.empty() ? "" : left + "\n") << line;
    EXPECT_TRUE(textures.warnings.empty());
    return textures.uvs.contains("m") ? textures.uvs.at("m") : MtlUvs();
  };
  const auto placed = [](const Vector2f& scale, const Vector2f& offset) {
    return MtlUvs{.scale = scale, .offset = offset};
  };
  EXPECT_EQ(uvs("map_Kd -s 2 3 1 -o .5 -.25 0 t.png", "map_Kd t.png"),
            placed({2, 3}, {0.5F, -0.25F}));
  EXPECT_EQ(uvs("map_Kd -s 4 my 2nd image.png\r", "map_Kd my 2nd image.png"),
            placed({4, 1}, {0, 0}));
  EXPECT_EQ(uvs("\tmap_kd my image.png -s 2 2 2", "map_kd my image.png"), placed({2, 2}, {0, 0}));
  EXPECT_EQ(uvs("map_Kd -clamp on -blendu off -mm 0 1 -texres 512 t.png", "map_Kd -clamp on t.png"),
            MtlUvs());
  EXPECT_EQ(uvs("map_Kd -bm 0.5 -imfchan l -t 0 0 0 -type sphere 2.png", "map_Kd 2.png"), MtlUvs());
  EXPECT_EQ(uvs("map_Kd -s.png", ""), MtlUvs());
  EXPECT_EQ(uvs("map_Kd my -s image.png", ""), MtlUvs());
  EXPECT_EQ(uvs("map_Bump -s 2 2 2 t.png", ""), MtlUvs());
  EXPECT_EQ(uvs("map_Ke -s 2 2 2 t.png", "map_Ke t.png"), placed({2, 2}, {0, 0}));
}

TEST(MtlTextures, OptionsThatAreNotHonoredAreNamed) {
  MtlTextures textures;
  plain("map_Kd -s 2 2 2 -mm 0.2 0.5 t.png\nmap_d -t 1 1 1 m.png", textures);
  ASSERT_EQ(textures.warnings.size(), 3U);
  EXPECT_TRUE(names(textures.warnings[0], {"a.mtl:2: material m: ", "map_kd's -mm"}));
  EXPECT_TRUE(names(textures.warnings[1], {"a.mtl:3: ", "map_d's -t"}));
  EXPECT_TRUE(names(textures.warnings[2], {"a.mtl:3: ", "map_d is placed differently"}));
}

class MtlTexturesOf : public TemporaryFolder {};

TEST_F(MtlTexturesOf, AnObjsTexturesAreScaledAndMoved) {
  write("my image.ppm", std::string("P6\n2 1\n255\n") + std::string("\xff\x00\x00\x00\x00\xff", 6));
  write("a.mtl",
        "newmtl tiles of a floor\nmap_Kd -s 2 4 1 -o 0.5 -1 0 my image.ppm\n"
        "newmtl plain\nmap_Kd -clamp on my image.ppm\n");
  std::vector<std::string> warnings;
  const auto obj = [&](const std::string& u) {
    return load_mesh(write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt " + u +
                                        " 0\nvt 0 0.5\nusemtl tiles of a floor\nf 1/1 2/2 3/3\n"
                                        "usemtl plain\nf 1/1 2/2 3/3\n"),
                     &warnings);
  };
  const Scene scene = obj("1");
  EXPECT_TRUE(warnings.empty());
  // v grows downward: it is 1 - v of the file.
  EXPECT_EQ(scene.uvs,
            (std::vector<Vector2f>{{0.5F, 2}, {2.5F, 2}, {0.5F, 0}, {0, 1}, {1, 1}, {0, 0.5F}}));
  for (const std::uint16_t material : scene.material_of)
    EXPECT_EQ(scene.materials[material].texture(1, 0), (Rgb8{0, 0, 255}));
  obj("3");
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(names(warnings[0], {"a.obj: material plain", "clamped"}));
}

}  // namespace
}  // namespace mh
