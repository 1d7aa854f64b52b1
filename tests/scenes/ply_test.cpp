// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/ply.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "scenes/mesh_io/mesh_io.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/// A square of two triangles.
PlyMesh square() {
  return {.positions_m = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5F}},
          .colors = {{1, 2, 3}, {255, 0, 0}, {0, 255, 0}, {9, 8, 7}},
          .labels = {0, 5, 40, 1163},
          .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

void expect_same(const PlyMesh& a, const PlyMesh& b) {
  EXPECT_EQ(a.positions_m, b.positions_m);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.labels, b.labels);
  EXPECT_EQ(a.triangles, b.triangles);
}

std::string error_of_ply(const std::string& bytes) {
  return error_of([&] { parse_ply(bytes, "mesh.ply"); });
}

/// A little-endian header with these elements.
std::string header(const std::string& elements) {
  return "ply\nformat binary_little_endian 1.0\n" + elements + "end_header\n";
}
const std::string kPoint = "property float x\nproperty float y\nproperty float z\n";
const std::string kList = "property list uchar int vertex_indices\n";

std::string points(int count) {
  std::string bytes;
  for (int i = 0; i < 3 * count; ++i) bytes += raw(static_cast<float>(i));
  return bytes;
}

TEST(Ply, ReadsBackWhatItWrote) {
  expect_same(parse_ply(ply_bytes(square()), "mesh.ply"), square());
  PlyMesh plain = square();
  plain.labels.clear();
  expect_same(parse_ply(ply_bytes(plain), "mesh.ply"), plain);
  EXPECT_TRUE(is_plain_ply(ply_bytes(plain)));
}

TEST(Ply, ReadsLabelsAlone) {
  const PlyMesh read = parse_ply(ply_bytes(square()), "mesh.ply", {.geometry = false});
  EXPECT_EQ(read.labels, square().labels);
  EXPECT_TRUE(read.positions_m.empty());
  EXPECT_TRUE(read.triangles.empty());
}

TEST(Ply, TakesAnyTypeAndOrderAndPassesOverTheUnknown) {
  const std::string bytes =
      header(
          "comment made by hand\nelement camera 1\nproperty list ushort float matrix\n"
          "element vertex 5\nproperty double z\nproperty ushort label\nproperty double y\n"
          "property short quality\nproperty double x\nproperty float red\nproperty float green\n"
          "property float blue\nelement face 2\nproperty uchar flag\n"
          "property list uint ushort vertex_index\nproperty list uchar float weights\n"
          "element edge 1\nproperty int a\nproperty int b\n") +
      [] {
        std::string body = raw(std::uint16_t{2}) + raw(1.0F) + raw(2.0F);
        for (int i = 0; i < 5; ++i)
          body += raw(double(i)) + raw(std::uint16_t(i)) + raw(10.0 + i) + raw(std::int16_t{-1}) +
                  raw(20.0 + i) + raw(1.0F) + raw(0.5F) + raw(0.0F);
        const auto face = [](std::initializer_list<std::uint16_t> corners) {
          std::string one = raw(std::uint8_t{7}) + raw(std::uint32_t(corners.size()));
          for (const std::uint16_t corner : corners) one += raw(corner);
          return one + raw(std::uint8_t{1}) + raw(0.25F);
        };
        return body + face({0, 1, 2}) + face({4, 3, 2, 1, 0}) + raw(1) + raw(2);
      }();
  const PlyMesh mesh = parse_ply(bytes, "mesh.ply");
  ASSERT_EQ(mesh.positions_m.size(), 5U);
  EXPECT_EQ(mesh.positions_m[3], Eigen::Vector3f(23, 13, 3));
  EXPECT_EQ(mesh.colors[0], (Rgb8{255, 128, 0}));
  EXPECT_EQ(mesh.labels[4], 4);
  // The pentagon becomes a fan of three triangles.
  const std::vector<std::array<std::uint32_t, 3>> expected = {
      {0, 1, 2}, {4, 3, 2}, {4, 2, 1}, {4, 1, 0}};
  EXPECT_EQ(mesh.triangles, expected);
}

TEST(Ply, EveryTruncationIsAnErrorThatNamesTheFile) {
  const std::string whole = ply_bytes(square());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_TRUE(names(error_of_ply(whole.substr(0, size)), {"mesh.ply"})) << size;
}

TEST(Ply, NamesTheFaceAndTheVertexThatIsNotThere) {
  PlyMesh mesh = square();
  mesh.triangles[1][2] = 4;
  EXPECT_TRUE(names(error_of_ply(ply_bytes(mesh)), {"face 1", "vertex 4 of 4"}));
  mesh.triangles[1][2] = 0xffffffff;  // -1 in a file with signed numbers
  EXPECT_TRUE(names(error_of_ply(ply_bytes(mesh)), {"face 1", "vertex -1 of 4"}));
  EXPECT_TRUE(names(error_of_ply(header("element vertex 1\n" + kPoint +
                                        "element face 1\n"
                                        "property list uchar char vertex_indices\n") +
                                 points(1) + raw(std::uint8_t{3}) + std::string("\0\0\xff", 3)),
                    {"face 0", "vertex -1 of 1"}));
}

TEST(Ply, NamesTheFaceOfTooFewCorners) {
  for (const char corners : {'\0', '\1', '\2'}) {
    std::string bytes = ply_bytes(square());
    bytes[bytes.size() - 26] = corners;  // the number of corners of the first face
    EXPECT_TRUE(names(error_of_ply(bytes), {"face 0", "corners: 3 are needed"}));
  }
}

TEST(Ply, BytesBehindTheLastElementAreWarnedAbout) {
  std::vector<std::string> warnings;
  warn_of_bytes_left(parse_ply(ply_bytes(square()) + "\n", "mesh.ply"), "mesh.ply", &warnings);
  EXPECT_TRUE(warnings.empty());
  const PlyMesh mesh = parse_ply(ply_bytes(square()) + "more\n", "mesh.ply");
  expect_same(mesh, square());
  warn_of_bytes_left(mesh, "mesh.ply", &warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(names(warnings[0], {"mesh.ply", "4 bytes"}));
}

TEST(Ply, NamesTheVertexThatIsNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    PlyMesh mesh = square();
    mesh.positions_m[2].y() = bad;
    EXPECT_TRUE(names(error_of_ply(ply_bytes(mesh)), {"vertex 2", "not finite"}));
  }
}

TEST(Ply, CountsThatOverflowAreRefusedBeforeAnythingIsAllocated) {
  const std::string huge = "18446744073709551615";
  EXPECT_TRUE(names(error_of_ply(header("element vertex " + huge + "\n" + kPoint)), {"32 bits"}));
  EXPECT_TRUE(names(error_of_ply(header("element vertex 4294967295\n" + kPoint)), {"truncated"}));
  EXPECT_TRUE(names(error_of_ply(header("element vertex 99999999999999999999\n" + kPoint)),
                    {"mesh.ply:3", "number of elements"}));
  const std::string faces = "element vertex 3\n" + kPoint + "element face ";
  EXPECT_TRUE(names(error_of_ply(header(faces + huge + "\n" + kList) + points(3)), {"truncated"}));
  EXPECT_TRUE(names(error_of_ply(header(faces + "1\nproperty list uint int vertex_indices\n") +
                                 points(3) + raw(std::uint32_t{0xffffffff}) + points(1)),
                    {"list of 4294967295 items"}));
  EXPECT_TRUE(names(error_of_ply(header(faces + "1\nproperty list int int vertex_indices\n") +
                                 points(3) + raw(std::int32_t{-1}) + points(1)),
                    {"list of -1 items"}));
}

TEST(Ply, SaysWhatIsWrongWithAHeader) {
  EXPECT_TRUE(names(error_of_ply("hello\n"), {"mesh.ply:1", "not a PLY"}));
  EXPECT_TRUE(names(error_of_ply("ply\nformat ascii 2.0\nend_header\n"), {":2", "'ascii 2.0'"}));
  EXPECT_TRUE(names(error_of_ply("ply\nend_header\n"), {":2", "no format"}));
  EXPECT_TRUE(names(error_of_ply(header("property float x\n")), {"mesh.ply:3", "first element"}));
  EXPECT_TRUE(names(error_of_ply(header("element vertex 1\nproperty quux x\n")), {":4", "quux"}));
  EXPECT_TRUE(names(error_of_ply(header("element vertex 0\nproperty float x\n")), {"'y'"}));
  EXPECT_TRUE(names(error_of_ply(header("element vertex 0\n" + kPoint)), {"'face'"}));
  EXPECT_TRUE(names(error_of_ply(header("element face 0\n" + kList)), {"before the vertices"}));
  EXPECT_TRUE(is_plain_ply("ply\nformat ascii 1.0\n"));  // truncated: parse_ply reports it
  EXPECT_FALSE(is_plain_ply(header("element vertex 0\nproperty float s\n")));
}

/// The same square as text.
std::string square_as_text() {
  return "ply\nformat ascii 1.0\nelement vertex 4\n" + kPoint +
         "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty ushort label\n"
         "element face 2\n" +
         kList +
         "end_header\n"
         "0 0 0 1 2 3 0\n1 0 0 255 0 0 5\n 1 1 0 0 255 0 40\r\n0 +1 5e-1 9 8 7 1163\n"
         "3 0 1 2\n3 0 2 3\n";
}

TEST(Ply, ReadsTextAndBigEndianAlike) {
  expect_same(parse_ply(square_as_text(), "mesh.ply"), square());
  std::string big = "ply\nformat binary_big_endian 1.0\nelement vertex 3\n" + kPoint +
                    "property ushort label\nelement face 1\n" + kList + "end_header\n";
  const auto append = [&](auto value) {
    std::string bytes = raw(value);
    std::ranges::reverse(bytes);
    big += bytes;
  };
  for (const int i : {0, 1, 2}) {
    for (int axis = 0; axis < 3; ++axis) append(static_cast<float>(i * axis));
    append(static_cast<std::uint16_t>(300 + i));
  }
  append(std::uint8_t{3});
  for (const std::int32_t i : {2, 1, 0}) append(i);
  const PlyMesh mesh = parse_ply(big, "mesh.ply");
  EXPECT_EQ(mesh.positions_m[2], Eigen::Vector3f(0, 2, 4));
  EXPECT_EQ(mesh.labels, (std::vector<std::uint16_t>{300, 301, 302}));
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{2, 1, 0}));
}

TEST(Ply, CutAnywhereIsToldInEveryEncoding) {
  const std::string text = square_as_text();
  for (std::size_t size = 4; size + 3 < text.size(); ++size)  // the last index has one digit
    EXPECT_FALSE(error_of_ply(text.substr(0, size)).empty()) << size;
  std::string wrong = text;
  wrong.replace(wrong.find("5e-1"), 4, "half");
  EXPECT_TRUE(names(error_of_ply(wrong), {"'half' is not a number", "record 3 of 4", "vertex"}));
  wrong = text;
  wrong.replace(wrong.find("1163"), 4, "99999");
  EXPECT_TRUE(names(error_of_ply(wrong), {"99999", "range"}));
  EXPECT_TRUE(names(error_of_ply("ply\nformat ascii 1.0\nelement vertex 999999999\n" + kPoint +
                                 "end_header\n0 0 0\n"),
                    {"truncated"}));
}

class LabeledPly : public TemporaryFolder {};

TEST_F(LabeledPly, ReplicasFacesAreOfTheirObjects) {
  // Two squares belong to object 7, one to object 3, one to no object.
  std::string text = "ply\nformat ascii 1.0\nelement vertex 4\n" + kPoint + "element face 4\n" +
                     kList + "property int object_id\nend_header\n" +
                     "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                     "4 0 1 2 3 7\n4 0 1 2 3 3\n4 0 1 2 3 7\n4 0 1 2 3 -1\n";
  write("scene/mesh_semantic.ply", text);
  std::vector<std::string> warnings;
  const Scene bare = load_mesh(folder_ / "scene/mesh_semantic.ply", &warnings);
  EXPECT_EQ(bare.instance_of, (std::vector<InstanceId>{8, 8, 4, 4, 8, 8, 0, 0}));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(names(warnings[0], {"mesh_semantic.ply", "info_semantic.json"}));
  write("scene/info_semantic.json",
        R"({"classes":[{"id":1,"name":"tv-screen"}],"objects":[
            {"class_id":1,"class_name":"tv-screen","id":7},{"class_id":9,"class_name":"indoor-plant","id":3}]})");
  warnings.clear();
  const Scene scene = load_mesh(folder_ / "scene/mesh_semantic.ply", &warnings);
  EXPECT_TRUE(warnings.empty());
  const ClassId tv = *class_by_name("tv"), plant = *class_by_name("potted plant");
  EXPECT_EQ(scene.class_of, (std::vector<ClassId>{tv, tv, plant, plant, tv, tv, 0, 0}));
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.instances[0].name, "indoor-plant_4");
  EXPECT_EQ(scene.instances[1].class_id, tv);
  write("scene/info_semantic.json", "{");
  EXPECT_TRUE(names(error_of([&] { load_mesh(folder_ / "scene/mesh_semantic.ply"); }),
                    {"info_semantic.json"}));
  std::filesystem::remove(folder_ / "scene/info_semantic.json");
  write("scene/mesh_semantic.ply", text.replace(text.find(" 7\n"), 3, " 65541\n"));
  EXPECT_TRUE(names(error_of([&] { load_mesh(folder_ / "scene/mesh_semantic.ply"); }), {"65541"}));
}

TEST_F(LabeledPly, ThreeRScansVerticesAreOfTheirObjects) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 5\n" + kPoint +
      "property ushort objectId\nproperty ushort globalId\nproperty uchar NYU40\n"
      "element face 3\n" +
      kList + "end_header\n" +
      "0 0 0 1 35 2\n1 0 0 1 35 2\n1 1 0 1 35 2\n0 1 0 4 9 40\n0 2 0 4 9 40\n"
      "3 0 1 2\n3 2 3 4\n3 1 2 3\n";
  write("labels.instances.annotated.v2.ply", text);
  write("semseg.v2.json",
        R"({"scan_id":"x","segGroups":[{"id":1,"objectId":1,"label":"floor","segments":[1]},
            {"id":4,"objectId":4,"label":"microwave","segments":[4]}]})");
  const Scene scene = load_mesh(folder_ / "labels.instances.annotated.v2.ply");
  EXPECT_EQ(scene.instance_of, (std::vector<InstanceId>{1, 4, 1}));
  EXPECT_EQ(scene.class_of, (std::vector<ClassId>{2, *class_by_name("microwave"), 2}));
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.instances[0].name, "floor_1");
  EXPECT_EQ(scene.instances[1].name, "microwave_4");
}

TEST_F(LabeledPly, LabelsAloneAreNyu40) {
  PlyMesh mesh = square();
  mesh.labels = {5, 5, 5, 1163};
  write("mesh.ply", ply_bytes(mesh));
  std::vector<std::string> warnings;
  mesh.labels = {5, 1163, 1163, 1163};
  EXPECT_EQ(load_mesh(folder_ / "mesh.ply").class_of, (std::vector<ClassId>{5, 5}));
  write("mesh.ply", ply_bytes(mesh));
  EXPECT_EQ(load_mesh(folder_ / "mesh.ply", &warnings).class_of, (std::vector<ClassId>{0, 0}));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(names(warnings[0], {"mesh.ply", "2 faces", "not an NYU40 id"}));
}

using PlyFile = TemporaryFolder;

// MeshLab writes spaces around the texture's name.
TEST_F(PlyFile, BlanksAroundATexturesNameAreNotOfIt) {
  write("my tex.ppm", std::string("P6\n1 1\n255\n\xff") + '\0' + '\0');
  std::vector<std::string> warnings;
  const Scene scene = load_mesh(
      write("a.ply",
            "ply\nformat ascii 1.0\ncomment TextureFile   my tex.ppm \nelement vertex 3\n" +
                kPoint + "property float s\nproperty float t\nelement face 1\n" + kList +
                "end_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"),
      &warnings);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
  ASSERT_FALSE(scene.materials[0].texture.empty());
  EXPECT_EQ(scene.materials[0].texture(0, 0), (Rgb8{255, 0, 0}));
}

// MeshLab's format, with two faces at a seam that use different places of the image. assimp would
// give each vertex the coordinates of its last face.
TEST_F(PlyFile, CornersKeepTheTextureCoordinatesOfTheirFaces) {
  write("t.ppm", std::string("P6\n2 1\n255\n\xff") + std::string(4, '\0') + "\xff");
  const std::string text =
      "ply\nformat ascii 1.0\ncomment TextureFile t.ppm\nelement vertex 4\n" + kPoint +
      "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n" + kList +
      "property list uchar float texcoord\nproperty int texnumber\nend_header\n"
      "0 0 0 9 9 9\n1 0 0 8 8 8\n1 1 0 7 7 7\n0 1 0 6 6 6\n"
      "3 0 1 2 6 0.25 0 0.25 0 0.25 1 0\n3 0 2 3 6 0.75 0 0.75 1 0.75 1 0\n";
  std::vector<std::string> warnings;
  const Scene scene = load_mesh(write("a.ply", text), &warnings);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
  ASSERT_EQ(scene.triangles.size(), 2U);
  for (const std::size_t face : {0U, 1U})
    for (const std::uint32_t vertex : scene.triangles[face])
      EXPECT_EQ(scene.uvs[vertex].x(), face == 0 ? 0.25F : 0.75F);
  EXPECT_EQ(scene.positions_m[scene.triangles[1][2]], Eigen::Vector3f(0, 1, 0));
  EXPECT_EQ(scene.colors[scene.triangles[1][2]], (Rgb8{6, 6, 6}));
  EXPECT_FALSE(scene.materials[0].texture.empty());
  for (const std::size_t cut : {20U, 60U})
    EXPECT_NE(error_of([&] { load_mesh(write("b.ply", text.substr(0, text.size() - cut))); }), "");
  std::string beyond = text;
  beyond.replace(beyond.find("3 0 2 3"), 7, "3 0 2 4");
  EXPECT_TRUE(names(error_of([&] { load_mesh(write("b.ply", beyond)); }),
                    {"b.ply", "face 1 names vertex 4 of 4"}));
}

TEST_F(PlyFile, ColorsOfFacesAreWarnedOf) {
  std::vector<std::string> warnings;
  load_mesh(write("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + kPoint +
                               "element face 1\n" + kList +
                               "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 9 9 9\n"),
            &warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(names(warnings[0], {"a.ply", "its face colors are not read"}));
}

}  // namespace
}  // namespace mh
