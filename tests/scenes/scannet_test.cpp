// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/scannet.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "scenes/load.hpp"
#include "scenes/materials/materials.hpp"
#include "scenes/mesh_io/ply.hpp"
#include "scenes/scannet/annotation.hpp"
#include "scenes/scannet/label_table.hpp"
#include "scenes/scannet/scene_info.hpp"
#include "slam/io/files.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

// A strip of six squares along x; column i (0 to 6) consists of vertices 2i and 2i + 1.
PlyMesh strip() {
  PlyMesh mesh;
  for (int i = 0; i <= 6; ++i)
    for (int j = 0; j < 2; ++j) {
      mesh.positions_m.emplace_back(static_cast<float>(i), static_cast<float>(j), 0.0F);
      mesh.colors.push_back({static_cast<std::uint8_t>(10 * i), 20, 30});
    }
  for (std::uint32_t i = 0; i < 12; i += 2) {
    mesh.triangles.push_back({i, i + 2, i + 1});
    mesh.triangles.push_back({i + 1, i + 2, i + 3});
  }
  return mesh;
}

constexpr const char* kTableV2 =
    "id\traw_category\tcategory\tcount\tnyu40id\teigen13id\tnyuClass\tnyu40class\n"
    "1\twall\twall\t8277\t1\t12\twall\twall\n"
    "2\tchair\tchair\t4646\t5\t4\tchair\tchair\n"
    "1163\toffice chair\tchair\t595\t5\t4\tchair\tchair\n"
    "35\tmonitor\tmonitor\t765\t40\t7\tmonitor\totherprop\n";
// v1 has different column names and no raw_category.
constexpr const char* kTableV1 =
    "category\tindex\tcount\tnyu40id\teigen13id\tnyuClass\tnyu40class\n"
    "wall\t1\t8277\t1\t12\twall\twall\n"
    "chair\t2\t4646\t5\t4\tchair\tchair\n"
    "office chair\t1163\t595\t5\t4\tchair\tchair\n"
    "monitor\t35\t765\t40\t7\tmonitor\totherprop\n";

// Columns 0 and 1 are segment 7, columns 2 and 3 segment 0, column 4 segment 90000, columns 5 and 6
// segment 3.
constexpr const char* kSegments =
    R"({"params":{"kThresh":"0.0001","segMinVerts":"20"},"sceneId":"s","segIndices":)"
    R"([7,7,7,7,0,0,0,0,90000,90000,3,3,3,3]})";
constexpr const char* kAggregation =
    R"({"sceneId":"scannet.s","appId":"Aggregator.v2","segGroups":[)"
    R"({"id":0,"objectId":0,"segments":[7],"label":"wall"},)"
    R"({"id":1,"objectId":1,"segments":[0],"label":"office chair"},)"
    R"({"id":2,"objectId":2,"segments":[90000],"label":"flux capacitor"}]})";

class Scannet : public TemporaryFolder {
 protected:
  /// @param labels  of the columns 0 to 6
  void write_scene(const std::array<std::uint16_t, 7>& labels, const std::string& info) const {
    PlyMesh mesh = strip();
    write("s/s_vh_clean_2.ply", ply_bytes(mesh));
    for (const std::uint16_t label : labels) mesh.labels.insert(mesh.labels.end(), 2, label);
    write("s/s_vh_clean_2.labels.ply", ply_bytes(mesh));
    write("s/s_vh_clean_2.0.010000.segs.json", kSegments);
    write("s/s.aggregation.json", kAggregation);
    write("s/s.txt", info);
  }
  void write_v2() const {
    write("scannetv2-labels.combined.tsv", kTableV2);
    write_scene({1, 1, 5, 5, 0, 40, 40},
                "axisAlignment = 0 -1 0 10 1 0 0 20 0 0 1 30 0 0 0 1 \nsceneType = Office\n");
  }
  void write_v1() const {
    write("scannet-labels.combined.tsv", kTableV1);
    write_scene({1, 1, 1163, 1163, 0, 35, 35}, "sceneType = Office\n");
  }
  std::string error() const {
    return mh::error_of([&] { load_scannet(folder_ / "s"); });
  }
};

/// What both releases specify for the strip, with two faces per square.
void expect_strip(const Scene& scene) {
  // Square 1 is between the wall (columns 0, 1) and the chair: its first face has two corners on
  // the wall, its second face has two on the chair. Square 3 is between the chair and the unknown
  // object, square 4 between the unknown object and the monitor, which belongs to no object.
  EXPECT_EQ(scene.class_of, (std::vector<ClassId>{1, 1, 1, 5, 5, 5, 5, 0, 0, 40, 40, 40}));
  EXPECT_EQ(scene.instance_of, (std::vector<InstanceId>{1, 1, 1, 2, 2, 2, 2, 3, 3, 0, 0, 0}));
  ASSERT_EQ(scene.instances.size(), 3U);
  EXPECT_EQ(scene.instances[0].class_id, 1);
  EXPECT_EQ(scene.instances[1].class_id, 5);
  EXPECT_EQ(scene.instances[1].name, "office chair_2");
  EXPECT_EQ(scene.instances[2].class_id, kVoid);
  EXPECT_EQ(scene.name, "s");
  EXPECT_EQ(scene.triangles, strip().triangles);
  EXPECT_EQ(scene.colors, strip().colors);
}

TEST_F(Scannet, ReadsAReleaseTwoFolder) {
  write_v2();
  std::vector<std::string> warnings;
  const Scene scene = load_scannet(folder_ / "s", &warnings);
  expect_strip(scene);
  for (std::size_t v = 0; v < scene.positions_m.size(); ++v) {
    const Eigen::Vector3f p = strip().positions_m[v];
    EXPECT_EQ(scene.positions_m[v], Eigen::Vector3f(10 - p.y(), 20 + p.x(), 30 + p.z()));
  }
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(names(warnings[0], {"s.aggregation.json", "1 of 3 objects", "'flux capacitor'"}));
  EXPECT_EQ(scene.instances[1].min_m, Eigen::Vector3f(9, 21, 30));  // only the faces of the chair
}

TEST_F(Scannet, ReadsAReleaseOneFolderWhoseLabelsAreRawIds) {
  write_v1();
  std::vector<std::string> warnings;
  const Scene scene = load_scannet(folder_ / "s", &warnings);
  expect_strip(scene);
  EXPECT_EQ(scene.positions_m, strip().positions_m);  // no alignment
  EXPECT_EQ(warnings.size(), 1U);
}

TEST_F(Scannet, TellsTheReleasesApartWhereBothTablesLieSideBySide) {
  write_v1();
  write("scannetv2-labels.combined.tsv", kTableV2);
  expect_strip(load_scannet(folder_ / "s"));
  write_v2();
  expect_strip(load_scannet(folder_ / "s"));
}

TEST_F(Scannet, CategoriesThatNyu40LumpsTogetherKeepTheirClass) {
  const LabelTable table = parse_label_table(
      "id\traw_category\tnyu40id\tnyu40class\n1\tmicrowave\t40\totherprop\n"
      "2\twall clock\t40\totherprop\n3\tlaptop computer\t40\totherprop\n4\tcoffee cups\t40\t\n"
      "5\toven mitt\t40\t\n6\tlaptop bag\t37\tbag\n7\tmonitor\t40\t\n8\tclock\t\t\n",
      "t.tsv");
  const auto class_of = [&](std::uint32_t id) { return classes()[table.class_of_id.at(id)].name; };
  EXPECT_EQ(class_of(1), "microwave");
  EXPECT_EQ(class_of(2), "clock");
  EXPECT_EQ(class_of(3), "laptop");
  EXPECT_EQ(class_of(4), "cup");
  EXPECT_EQ(class_of(5), "otherprop");
  EXPECT_EQ(class_of(6), "bag");
  EXPECT_EQ(class_of(7), "otherprop");
  EXPECT_EQ(class_of(8), "void");

  write_v2();  // the chair becomes a microwave, whose label is 40
  write("scannetv2-labels.combined.tsv",
        std::string(kTableV2) + "99\tmicrowave\tmicrowave\t9\t40\t7\tmicrowave\totherprop\n");
  write_scene({1, 1, 40, 40, 0, 40, 40}, "axisAlignment = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  std::string aggregation = kAggregation;
  aggregation.replace(aggregation.find("office chair"), 12, "microwave");
  write("s/s.aggregation.json", aggregation);
  const Scene scene = load_scannet(folder_ / "s");
  const ClassId microwave = *class_by_name("microwave");
  EXPECT_EQ(scene.instances[1].class_id, microwave);
  EXPECT_EQ(std::ranges::count(scene.class_of, microwave), 4);
}

TEST_F(Scannet, KeepsItsLabelsWhereItIsPlaced) {
  write_v2();
  for (const char* file : {"s/s_vh_clean_2.ply", "s"}) {
    write("place.yaml",
          fmt::format("objects:\n  - {{file: {}, name: scan, position_m: [1, 2, 3]}}\n", file));
    const Scene alone = load_scannet(folder_ / "s");
    const Scene scene = load_scene(folder_ / "place.yaml");
    EXPECT_EQ(scene.class_of, alone.class_of);
    EXPECT_EQ(scene.instance_of, alone.instance_of);
    EXPECT_EQ(scene.instances[1].name, "scan/office chair_2");
    EXPECT_TRUE(scene.positions_m[0].isApprox(alone.positions_m[0] + Eigen::Vector3f(1, 2, 3)));
  }
}

TEST_F(Scannet, OpensAsAnySceneByFolderAndByMesh) {
  write_v2();
  expect_strip(load_scene(folder_ / "s"));
  expect_strip(load_scene(folder_ / "s" / "s_vh_clean_2.ply"));
  EXPECT_TRUE(names(error_of([&] { load_scene(folder_); }), {"_vh_clean_2.ply"}));
  write("s/t_vh_clean_2.ply", ply_bytes(strip()));
  expect_strip(load_scene(folder_ / "s"));  // the scene named like the folder is loaded
  fs::rename(folder_ / "s", folder_ / "other");
  EXPECT_TRUE(names(error_of([&] { load_scene(folder_ / "other"); }), {"2 scenes"}));
}

TEST_F(Scannet, TheMeshAloneIsASceneToo) {
  write("s/s_vh_clean_2.ply", ply_bytes(strip()));
  std::vector<std::string> warnings;
  const Scene scene = load_scannet(folder_ / "s", &warnings);
  EXPECT_EQ(scene.class_of, std::vector<ClassId>(12, kVoid));
  EXPECT_TRUE(scene.instances.empty());
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(names(warnings[0], {"segs.json"}));
}

TEST_F(Scannet, WithoutATableReleaseTwoStillHasItsLabelsAndReleaseOneIsRefused) {
  write_v2();
  fs::remove(folder_ / "scannetv2-labels.combined.tsv");
  const Scene scene = load_scannet(folder_ / "s");
  EXPECT_EQ(scene.class_of[0], 1);
  EXPECT_EQ(scene.class_of[11], 40);
  write_scene({1, 1, 1163, 1163, 0, 35, 35}, "");
  EXPECT_TRUE(names(error(), {"labels.ply", "label 1163", "scannet-labels.combined.tsv"}));
}

TEST_F(Scannet, CountsVerticesWhoseRawIdTheTableLacks) {
  write_v1();
  write_scene({1, 1, 1163, 1163, 0, 999, 35}, "");
  std::vector<std::string> warnings;
  load_scannet(folder_ / "s", &warnings);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_TRUE(names(warnings[0], {"2 of 14 vertices", "scannet-labels.combined.tsv"}));
}

TEST_F(Scannet, CountsSegmentsOfSeveralObjectsAndSegmentsThatNoVertexHas) {
  write_v2();
  write("s/s.aggregation.json", R"({"segGroups":[{"objectId":0,"segments":[7,0],"label":"wall"},)"
                                R"({"objectId":1,"segments":[0,12,13],"label":"office chair"}]})");
  std::vector<std::string> warnings;
  const Scene scene = load_scannet(folder_ / "s", &warnings);
  EXPECT_EQ(scene.instance_of[4], 2);  // segment 0 belongs to the last object that lists it
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_TRUE(names(warnings[0], {"aggregation.json", "1 of 4 segments", "segment 0)"}));
  EXPECT_TRUE(names(warnings[1], {"aggregation.json", "2 of the 4 segments", "segment 12)"}));
}

TEST_F(Scannet, LabelsBeyondNyu40InAnAlignedSceneGiveWayToTheObjects) {
  write_v2();
  write("scannet-labels.combined.tsv", kTableV1);  // the alignment shows that the scene is from v2
  write_scene({1, 1, 50, 50, 0, 40, 50}, "axisAlignment = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  std::vector<std::string> warnings;
  const Scene scene = load_scannet(folder_ / "s", &warnings);
  EXPECT_EQ(scene.class_of, (std::vector<ClassId>{1, 1, 1, 5, 5, 5, 5, 0, 0, 40, 40, 0}));
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_TRUE(names(warnings[0], {"labels.ply", "6 of 14 vertices", "NYU40", "up to 50"}));
}

TEST_F(Scannet, FilesThatDoNotFitTheMeshAreNamed) {
  write_v2();
  write("s/s_vh_clean_2.0.010000.segs.json", R"({"segIndices":[1,2,3]})");
  EXPECT_TRUE(names(error(), {"segs.json", "3 vertices", "14"}));
  write_v2();
  PlyMesh less = strip();
  less.positions_m.resize(13);
  less.colors.resize(13);
  less.labels.assign(13, 1);
  less.triangles.resize(2);
  write("s/s_vh_clean_2.labels.ply", ply_bytes(less));
  EXPECT_TRUE(names(error(), {"labels.ply", "13 vertices", "14"}));
  write("s/s_vh_clean_2.labels.ply", ply_bytes(strip()));
  EXPECT_TRUE(names(error(), {"labels.ply", "'label'"}));
  write_v2();
  PlyMesh empty = strip();
  empty.triangles.clear();
  write("s/s_vh_clean_2.ply", ply_bytes(empty));
  EXPECT_TRUE(names(error(), {"s_vh_clean_2.ply", "no visible faces"}));
}

TEST_F(Scannet, DamagedFilesAreNamedWithTheirPlace) {
  write_v2();
  const std::string segments = kSegments, groups = kAggregation;
  for (std::size_t size = 0; size < segments.size(); size += 7) {
    write("s/s_vh_clean_2.0.010000.segs.json", segments.substr(0, size));
    EXPECT_TRUE(names(error(), {"segs.json"})) << size;
  }
  write("s/s_vh_clean_2.0.010000.segs.json", segments);
  for (std::size_t size = 0; size < groups.size(); size += 7) {
    write("s/s.aggregation.json", groups.substr(0, size));
    EXPECT_TRUE(names(error(), {"aggregation.json"})) << size;
  }
  write("s/s.aggregation.json", R"({"segGroups":[{"objectId":0,"segments":[1],"label":"x"},{}]})");
  EXPECT_TRUE(names(error(), {"aggregation.json", "segGroups[1]"}));
  write("s/s.aggregation.json", R"({"segGroups":[{"objectId":-1,"segments":[],"label":"x"}]})");
  EXPECT_TRUE(names(error(), {"segGroups[0]", "-1"}));
  write("s/s.aggregation.json", R"({"segGroups":[{"objectId":65535,"segments":[],"label":"x"}]})");
  EXPECT_TRUE(names(error(), {"65535"}));
  write("s/s.aggregation.json", R"({"segGroups":[{"objectId":3,"segments":[7],"label":"wall"},)"
                                R"({"objectId":3,"segments":[0],"label":"office chair"}]})");
  EXPECT_TRUE(names(error(), {"aggregation.json", "segGroups[1]", "objectId 3", "segGroups[0]"}));
  write_v2();
  for (const char* matrix : {"0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1",
                             "1 0 0 0 0 1 0 0 0 0 -1 0 0 0 0 1"}) {
    write("s/s.txt", std::string("axisAlignment = ") + matrix + "\n");
    EXPECT_TRUE(names(error(), {"s.txt:1", "axisAlignment", "not a rotation"})) << matrix;
  }
  write("s/s.txt", "a = b\naxisAlignment = 1 0 0\n");
  EXPECT_TRUE(names(error(), {"s.txt:2", "axisAlignment", "number 4"}));
  write("s/s.txt", "no scene's\nfacts\n");
  EXPECT_TRUE(names(error(), {"s.txt:1", "key = value"}));
  write("s/s.txt", "");
  write("scannetv2-labels.combined.tsv", "id\traw_category\tnyu40id\n1\twall\t41\n");
  EXPECT_TRUE(names(error(), {"combined.tsv:2", "41"}));
  write("scannetv2-labels.combined.tsv", "name\n");
  EXPECT_TRUE(names(error(), {"combined.tsv:1", "raw_category"}));
}

TEST(ScannetAnnotation, SegmentsAreWholeNumbersOfTheOutermostObject) {
  EXPECT_EQ(
      parse_segments(R"({"a":{"segIndices":[9]},"segIndices":[1,4294967295],"b":[-1.5]})", "f"),
      (std::vector<std::uint32_t>{1, 4294967295U}));
  const auto error = [](const char* json) { return error_of([&] { parse_segments(json, "f"); }); };
  EXPECT_TRUE(names(error(R"({"segIndices":[1,-2]})"), {"f: ", "-2"}));
  EXPECT_TRUE(names(error(R"({"segIndices":[1,4294967296]})"), {"32 bits"}));
  EXPECT_TRUE(names(error(R"({"segIndices":[1,[2]]})"), {"segIndices[1]"}));
  EXPECT_TRUE(names(error(R"({"segIndices":[1,"2"]})"), {"segIndices[1]"}));
  EXPECT_TRUE(names(error(R"({"other":[1]})"), {"no array segIndices"}));
}

TEST(ScannetLabelTable, WithoutIdsRowsCountFromOne) {
  const LabelTable table = parse_label_table("category\tnyu40id\nwall\t1\nlamp\t35\n", "t");
  EXPECT_EQ(table.release, ScannetRelease::kV1);
  EXPECT_EQ(table.class_of_id.at(2), 35);
}

TEST(ScannetLabelTable, ARowThatWasCutIsNamed) {
  const std::string table = kTableV2;
  const auto error = [](const std::string& text) {
    return error_of([&] { parse_label_table(text, "t.tsv"); });
  };
  EXPECT_EQ(error(table), "");
  EXPECT_EQ(error(table.substr(0, table.size() - 1)), "");  // the last line needs no newline
  const std::size_t last = table.rfind("35\tmonitor");
  for (std::size_t size = last + 1; size + 11 < table.size(); ++size)
    EXPECT_TRUE(names(error(table.substr(0, size)), {"t.tsv:5"})) << size;
  EXPECT_TRUE(names(error("id\traw_category\tcount\tnyu40id\n2\tchair\n1\twall\t9\t1\n"),
                    {"t.tsv:2", "2 cells", "4"}));
  // In a file of ours, an id is checked even if the modelhouse column overrides it.
  EXPECT_TRUE(names(error("id\traw_category\tnyu40id\tmodelhouse\n2\tchair\t99\tchair\n"),
                    {"t.tsv:2", "99"}));
}

TEST(ScannetLabelTable, ReadsItsOwnRowsBack) {
  const LabelTable table = parse_label_table(label_table_text(), "own");
  EXPECT_EQ(table.release, ScannetRelease::kV2);
  for (const ClassInfo& info : classes()) {
    if (info.id == kVoid || info.id == kBackground) continue;
    EXPECT_EQ(table.class_of_category.at(std::string(info.name)), info.id);
    EXPECT_EQ(table.class_of_id.at(info.id), info.id);
  }
}

/// Lit and textured pieces with shared vertices: two chairs, a plant (a class that NYU40 lacks) and
/// a floor that is not an object; one face of the second chair is labeled as a pillow.
Scene textured_scene() {
  Scene scene;
  scene.name = "pieces";
  scene.materials = {make_material({.name = "oak", .kind = "wood_grain"})};
  scene.instances = {{.id = 1, .class_id = 5, .name = "chair_a"},
                     {.id = 4, .class_id = 43, .name = "plant"},
                     {.id = 9, .class_id = 5, .name = "chair_b"}};
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 4; ++i) {
      scene.positions_m.emplace_back(0.2F * i, 0.2F * j, 0.01F * i * j);
      scene.uvs.emplace_back(0.25F * i, 0.25F * j);
      scene.light.emplace_back(0.5F, 0.6F, 0.7F);
    }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, int column) {
    constexpr std::array<InstanceId, 4> kInstance{1, 4, 9, 0};
    constexpr std::array<ClassId, 4> kClass{5, 43, 5, 2};
    scene.triangles.push_back({a, b, c});
    scene.instance_of.push_back(kInstance[column]);
    scene.class_of.push_back(kClass[column]);
    scene.material_of.push_back(0);
  };
  for (std::uint32_t j = 0; j < 4; ++j)
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t at = 5 * j + i;
      add(at, at + 1, at + 5, static_cast<int>(i));
      add(at + 1, at + 6, at + 5, static_cast<int>(i));
    }
  const auto chair_b = std::ranges::find(scene.instance_of, 9) - scene.instance_of.begin();
  scene.class_of[chair_b] = 18;
  validate(scene);
  return scene;
}

TEST_F(Scannet, AFolderReadBackHasTheSameFacesClassesAndInstances) {
  const Scene scene = textured_scene();
  save_scannet(scene, folder_ / "room", 0.0F);
  for (const char* part : {"_vh_clean_2.ply", "_vh_clean_2.labels.ply",
                           "_vh_clean_2.0.010000.segs.json", ".aggregation.json", ".txt"})
    EXPECT_TRUE(fs::exists(folder_ / "room" / (std::string("room") + part))) << part;
  std::vector<std::string> warnings;
  const Scene read = load_scannet(folder_ / "room", &warnings);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
  ASSERT_EQ(read.triangles.size(), scene.triangles.size());
  EXPECT_EQ(read.class_of, scene.class_of);
  EXPECT_EQ(read.instance_of, scene.instance_of);
  for (std::size_t f = 0; f < read.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(read.positions_m[read.triangles[f][k]], scene.positions_m[scene.triangles[f][k]]);
  ASSERT_EQ(read.instances.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read.instances[i].id, scene.instances[i].id);
    EXPECT_EQ(read.instances[i].class_id, scene.instances[i].class_id);
    EXPECT_EQ(read.instances[i].name, scene.instances[i].name);
  }
  EXPECT_EQ(read.name, "room");
  EXPECT_GT(read.positions_m.size(),
            scene.positions_m.size());  // vertices are duplicated where objects meet
}

TEST_F(Scannet, WhatAnyScannetToolReadsIsConsistent) {
  save_scannet(textured_scene(), folder_ / "room", 0.1F);
  const std::string stem = (folder_ / "room" / "room").string();
  const PlyMesh mesh = read_ply(stem + "_vh_clean_2.ply");
  const PlyMesh labels = read_ply(stem + "_vh_clean_2.labels.ply");
  EXPECT_EQ(mesh.positions_m, labels.positions_m);
  EXPECT_EQ(mesh.triangles, labels.triangles);
  EXPECT_GT(mesh.triangles.size(),
            2 * textured_scene().triangles.size());  // split to represent the texture
  const std::string json = read_file(stem + "_vh_clean_2.0.010000.segs.json");
  const auto segments = parse_segments(json, "segs");
  ASSERT_EQ(segments.size(), mesh.positions_m.size());
  const auto groups = parse_aggregation(read_file(stem + ".aggregation.json"), "aggregation");
  ASSERT_EQ(groups.size(), 3U);
  const LabelTable table = load_label_table(folder_ / "room" / "scannetv2-labels.combined.tsv");
  std::set<std::uint32_t> claimed;
  for (const SegmentGroup& group : groups) {
    ASSERT_TRUE(table.class_of_category.contains(group.category));
    for (const std::uint32_t segment : group.segments) {
      EXPECT_TRUE(claimed.insert(segment).second) << "two objects claim one segment";
      // A segment is part of one object and has one label, from NYU40.
      std::set<std::uint16_t> of_segment;
      for (std::size_t v = 0; v < segments.size(); ++v)
        if (segments[v] == segment) of_segment.insert(labels.labels[v]);
      EXPECT_EQ(of_segment.size(), 1U);
      EXPECT_LE(*of_segment.rbegin(), 40);
    }
  }
}

TEST_F(Scannet, AScanWrittenAgainKeepsItsTrianglesAsTheyAre) {
  write_v2();
  const Scene scene = load_scannet(folder_ / "s");
  save_scannet(scene, folder_ / "again");
  const Scene again = load_scannet(folder_ / "again");
  EXPECT_EQ(again.class_of, scene.class_of);
  EXPECT_EQ(again.instance_of, scene.instance_of);
  EXPECT_EQ(again.instances[1].name, "office chair_2");
}

}  // namespace
}  // namespace mh
