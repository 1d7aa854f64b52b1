// SPDX-License-Identifier: Apache-2.0
// Composed scenes: our own YAML of placed objects, and Gazebo worlds.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "scenes/gazebo.hpp"
#include "scenes/load.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/placed_objects.hpp"
#include "source_dir.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class Worlds : public TemporaryFolder {
 protected:
  /// Two triangles with two materials in one node, z up.
  fs::path write_mesh(const std::string& name) const {
    write("meshes/look.mtl", "newmtl Wood\nKd 0.5 0.25 0\nnewmtl Floor paint\nKd 0 0 1\n");
    return write("meshes/" + name,
                 "mtllib look.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\n"
                 "o wooden_table_02\nusemtl Wood\nf 1 2 4\nusemtl Floor paint\nf 1 2 3\n");
  }
  static const Instance& instance(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.instances, name, &Instance::name);
    if (found == scene.instances.end()) throw InputError("no object " + name);
    return *found;
  }
};

TEST_F(Worlds, ObjectsStandWhereTheYamlPutsThem) {
  write_mesh("a.obj");
  const auto file = write("room.yaml",
                          "name: room\n"
                          "objects:\n"
                          "  - {file: meshes/a.obj}\n"
                          "  - {file: meshes/a.obj, name: second, class: sofa, scale: 2,\n"
                          "     position_m: [10, 0, 1], rpy_deg: [0, 0, 90]}\n");
  const Scene scene = load_scene(file);
  EXPECT_EQ(scene.name, "room");
  ASSERT_EQ(scene.triangles.size(), 4U);
  const Instance& first = instance(scene, "a");
  EXPECT_EQ(first.class_id, *class_by_name("table"));
  EXPECT_TRUE(first.max_m.isApprox(Eigen::Vector3f(1, 2, 3)));
  const Instance& second = instance(scene, "second");
  EXPECT_EQ(second.class_id, *class_by_name("sofa"));
  // (x, y, z) -> (10 - 2 y, 2 x, 1 + 2 z)
  EXPECT_LT((second.min_m - Eigen::Vector3f(6, 0, 1)).norm(), 1e-5F);
  EXPECT_LT((second.max_m - Eigen::Vector3f(10, 2, 7)).norm(), 1e-5F);
  EXPECT_EQ(std::ranges::count(scene.class_of, *class_by_name("sofa")), 2);
}

TEST_F(Worlds, AnStlIsASceneAndAnObject) {
  const std::string text =
      "solid wooden chair\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 2 0 1\n"
      "vertex 0 3 1\nendloop\nendfacet\nendsolid\n";
  std::string binary(80, ' ');
  const std::uint32_t count = 1;
  const float numbers[] = {0, 0, 1, 0, 0, 1, 2, 0, 1, 0, 3, 1};
  binary.append(reinterpret_cast<const char*>(&count), sizeof count);
  binary.append(reinterpret_cast<const char*>(numbers), sizeof numbers).append(2, '\0');
  write("chair.stl", text);
  for (const fs::path& file : {write("a.STL", binary), folder_ / "chair.stl"}) {
    const Scene scene = load_scene(file);
    EXPECT_EQ(scene.positions_m, (std::vector<Eigen::Vector3f>{{0, 0, 1}, {2, 0, 1}, {0, 3, 1}}));
    ASSERT_EQ(scene.instances.size(), 1U);
  }
  const Scene scene = load_scene(
      write("room.yaml", "objects:\n  - {file: chair.stl, scale: 0.5, position_m: [0, 0, 1]}\n"));
  EXPECT_EQ(instance(scene, "chair").class_id, *class_by_name("chair"));
  EXPECT_EQ(instance(scene, "chair").max_m, Eigen::Vector3f(1, 1.5F, 1.5F));
  EXPECT_TRUE(names(error_of([&] { load_scene(write("a.step", "")); }), {"a.step", ".stl"}));
}

TEST_F(Worlds, LabelRulesTellNodesAndMaterialsApart) {
  write_mesh("a.obj");
  const auto file = write("room.yaml",
                          "labels: {'floor*': floor, 'WOODEN*': desk}\n"
                          "objects:\n  - {file: meshes/a.obj, name: hall}\n");
  const Scene scene = load_scene(file);
  EXPECT_EQ(std::ranges::count(scene.class_of, *class_by_name("floor")), 1);
  EXPECT_EQ(std::ranges::count(scene.class_of, *class_by_name("desk")), 1);
  EXPECT_EQ(scene.instances.size(), 2U);
  ASSERT_EQ(scene.rooms.size(), 1U);  // the bounding box of the floor
  EXPECT_EQ(scene.rooms[0].name, "hall");
  // The same with a side file next to the mesh, whose rules come after the scene's own.
  write("meshes/labels.yaml", "'floor*': floor\n'*': bed\n");
  const Scene mesh = load_mesh(folder_ / "meshes/a.obj");
  EXPECT_EQ(std::ranges::count(mesh.class_of, *class_by_name("bed")), 1);
  EXPECT_EQ(std::ranges::count(load_scene(file).class_of, *class_by_name("desk")), 1);
  write("meshes/a.labels.yaml", "x: nonsense\n");
  EXPECT_TRUE(names(error_of([&] { load_mesh(folder_ / "meshes/a.obj"); }),
                    {"a.labels.yaml:1", "nonsense"}));
}

TEST_F(Worlds, BadYamlIsNamedByLineAndValue) {
  write_mesh("a.obj");
  const auto error = [&](const std::string& objects) {
    const auto file = write("room.yaml", "objects:\n" + objects);
    return error_of([&] { load_scene(file); });
  };
  EXPECT_TRUE(names(error("  - {file: gone.obj}\n"), {"gone.obj", "no such file"}));
  EXPECT_TRUE(
      names(error("  - {file: meshes/a.obj, class: hat stand}\n"), {"room.yaml:2", "'hat stand'"}));
  EXPECT_TRUE(names(error("  - {file: meshes/a.obj, scale: 0}\n"), {"room.yaml:2", "scale"}));
  EXPECT_TRUE(names(error("  - {file: meshes/a.obj, color: red}\n"), {"room.yaml", "color"}));
  EXPECT_TRUE(
      names(error("  - {file: meshes/a.obj}\n  - {file: meshes/a.obj}\n"), {"room.yaml:3", "'a'"}));
  EXPECT_TRUE(names(error("  []\n"), {"nothing visible"}));
}

TEST_F(Worlds, GazeboModelsAreFoundPlacedAndNamed) {
  write_mesh("a.obj");
  fs::rename(folder_ / "meshes", folder_ / "models_of_mine");
  write("models/stand/model.config",
        "<?xml version='1.0'?><model><name>stand</name><sdf version='1.6'>model.sdf</sdf></model>");
  write("models/stand/model.sdf", R"(<?xml version='1.0'?><sdf version='1.6'><model name='stand'>
    <link name='l'><pose>0 0 1 0 0 0</pose>
      <visual name='v'><geometry><mesh><uri>file://../../models_of_mine/a.obj</uri>
        <scale>2 1 1</scale></mesh></geometry></visual>
      <visual name='w'><pose>0 0 5 0 0 0</pose><geometry><box><size>2 4 6</size></box></geometry>
        <material><diffuse>1 0 0 1</diffuse></material></visual>
    </link></model></sdf>)");
  const auto world = write("world.sdf", R"(<?xml version='1.0'?><sdf version='1.6'>
    <world name='w'>
      <include><uri>model://stand</uri><name>desk_1</name>
        <pose>10 20 0 0 0 1.5707963267948966</pose></include>
      <include><uri>model://stand</uri><name>nameless</name></include>
      <model name='ground'><static>true</static><link name='l'>
        <visual name='v'><geometry><plane><normal>0 0 1</normal><size>8 6</size></plane></geometry>
        </visual></link></model>
      <light name='sun' type='directional'/>
    </world></sdf>)");
  write("labels.yaml", "ground: floor\n");
  std::vector<std::string> warnings;
  const Scene scene = load_scene(world, &warnings);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
  const Instance& desk = instance(scene, "desk_1");
  EXPECT_EQ(desk.class_id, *class_by_name("desk"));
  // The box is 2 x 4 x 6 around (0, 0, 6), turned by 90 degrees; the mesh extends to x = 2 before
  // that.
  EXPECT_NEAR(desk.min_m.x(), 10 - 2, 1e-4);
  EXPECT_NEAR(desk.max_m.x(), 10 + 2, 1e-4);
  EXPECT_NEAR(desk.max_m.y(), 20 + 2, 1e-4);
  EXPECT_NEAR(desk.min_m.z(), 1, 1e-4);
  EXPECT_NEAR(desk.max_m.z(), 9, 1e-4);
  // A model without a class of its own gets the classes of its meshes' nodes.
  EXPECT_TRUE(std::ranges::any_of(scene.instances, [](const Instance& i) {
    return i.name.starts_with("nameless/") && i.class_id == *class_by_name("table");
  }));
  EXPECT_EQ(instance(scene, "ground").class_id, *class_by_name("floor"));
  EXPECT_NEAR(scene.floor_area_m2(), 48, 1e-3);
  EXPECT_TRUE(std::ranges::any_of(scene.materials, [](const Material& m) {
    return m.base_color == Rgb8{255, 0, 0};
  }));
}

TEST_F(Worlds, IncludesThatLeadInACircleAreAnError) {
  const auto model = [&](const std::string& name, const std::string& other) {
    write("models/" + name + "/model.config",
          "<?xml version='1.0'?><model><name>" + name +
              "</name><sdf version='1.7'>model.sdf</sdf></model>");
    write("models/" + name + "/model.sdf", "<?xml version='1.0'?><sdf version='1.7'><model name='" +
                                               name + "'><link name='l'/><include><uri>model://" +
                                               other + "</uri></include></model></sdf>");
  };
  model("a", "b");
  model("b", "a");
  const auto world =
      write("w.sdf",
            "<?xml version='1.0'?><sdf version='1.7'><world name='w'><include><uri>model://a</uri>"
            "</include></world></sdf>");
  testing::internal::CaptureStderr();
  const std::string error = error_of([&] { load_gazebo_world(world); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // libsdformat prints nothing
  EXPECT_TRUE(names(error, {"w.sdf includes", "a/model.sdf", "b/model.sdf", "cycle"}));
}

TEST_F(Worlds, BadWorldsAreNamedWithTheirPlace) {
  const auto error = [&](const std::string& inside) {
    const auto world = write("w.sdf", "<?xml version='1.0'?>\n<sdf version='1.7'>" + inside);
    return error_of([&] { load_gazebo_world(world); });
  };
  EXPECT_TRUE(names(error("<world name='w'>"), {"w.sdf:", "not SDF"}));
  EXPECT_TRUE(names(error("<world name='w'>\n<include><uri>model://gone</uri></include>"
                          "</world></sdf>"),
                    {"w.sdf:3", "model://gone"}));
  EXPECT_TRUE(names(error("<model name='m'><link name='l'><visual name='v'><geometry><mesh>"
                          "<uri>model://gone/a.dae</uri></mesh></geometry></visual></link>"
                          "</model></sdf>"),
                    {"w.sdf", "visual v", "model://gone/a.dae"}));
  const auto shape = [&](const std::string& inside) {
    return error("<model name='m'><link name='l'><visual name='v'><geometry>" + inside +
                 "</geometry></visual></link></model></sdf>");
  };
  for (const char* bad :
       {"<box><size>-1 1 1</size></box>", "<box><size>1 0 1</size></box>",
        "<cylinder><radius>0</radius><length>1</length></cylinder>",
        "<cylinder><radius>1</radius><length>-1</length></cylinder>",
        "<sphere><radius>-2</radius></sphere>", "<sphere><radius>nan</radius></sphere>",
        "<plane><normal>0 0 1</normal><size>0 4</size></plane>"})
    EXPECT_TRUE(names(shape(bad), {"w.sdf", "link m/l", "visual v", "above 0"})) << bad;
  EXPECT_TRUE(names(shape("<box><size>-1 1 1</size></box>"), {"a box of -1 x 1 x 1"}));
  EXPECT_TRUE(names(error("<model name='m'><link name='l'/></model></sdf>"), {"nothing"}));
  const auto world = write("e.world", "<sdf version='1.7'><world name='w'/></sdf>");
  EXPECT_TRUE(names(error_of([&] { load_scene(world); }), {"e.world", "nothing visible"}));
  EXPECT_TRUE(names(error("<model name='m'><link name='l'><pose>1 2 x</pose></link></model></sdf>"),
                    {"w.sdf"}));
}

/// Real glTF with separate buffers and textures, one of them missing; the data are not part of this
/// project.
TEST_F(Worlds, DrakesLivingRoomLoadsByOurYamlAndByItsSdf) {
  const fs::path data = fs::path(MH_SOURCE_DIR) / "../shared/data/drake_living_room";
  if (!fs::exists(data)) GTEST_SKIP() << data << " is not there";
  fs::create_directory_symlink(fs::absolute(data / "models"), folder_ / "models");
  fs::copy_file(fs::path(MH_SOURCE_DIR) / "tests/scenes/drake_living_room.yaml",
                folder_ / "room.yaml");
  std::vector<std::string> warnings;
  const Scene scene = load_scene(folder_ / "room.yaml", &warnings);
  for (const std::string& warning : warnings) EXPECT_TRUE(names(warning, {"missing"}));
  EXPECT_EQ(instance(scene, "sofa").class_id, *class_by_name("sofa"));
  // A room of about 6 m x 6 m x 3 m, with its furniture inside and on the floor.
  ASSERT_EQ(scene.rooms.size(), 1U);
  EXPECT_GT(scene.floor_area_m2(), 20);
  EXPECT_LT(scene.floor_area_m2(), 60);
  const double floor_z =
      std::ranges::find(scene.instances, *class_by_name("floor"), &Instance::class_id)->max_m.z();
  for (const char* name : {"cabinet", "bookshelves", "tall_cabinet", "sofa", "stool"}) {
    const Instance& piece = instance(scene, name);
    EXPECT_NEAR(piece.min_m.z(), floor_z, 0.05) << name;
    EXPECT_GT(piece.max_m.z(), 0.3) << name;
    EXPECT_LT(piece.max_m.z(), 2.6) << name;
  }
  EXPECT_GT(
      std::ranges::count_if(scene.materials, [](const Material& m) { return !m.texture.empty(); }),
      6);
  const Scene sofa = load_scene(folder_ / "models/sofa.sdf");
  ASSERT_EQ(sofa.instances.size(), 1U);
  EXPECT_EQ(sofa.instances[0].class_id, *class_by_name("sofa"));
}

}  // namespace
}  // namespace mh
