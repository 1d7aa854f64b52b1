// SPDX-License-Identifier: Apache-2.0
// Gazebo worlds as they are published: with faults that do not matter for an image.
#include "scenes/gazebo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "scenes/gazebo/ogre_script.hpp"
#include "scenes/image_file.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

std::string box(double size, const std::string& material = "") {
  const std::string s = std::to_string(size);
  return "<visual name='v'><geometry><box><size>" + s + " " + s + " " + s +
         "</size></box></geometry>" + material + "</visual>";
}

std::string model(const std::string& name, const std::string& inside,
                  const std::string& pose = "0 0 0 0 0 0") {
  return "<model name='" + name + "'><pose>" + pose + "</pose>" + inside + "</model>";
}

std::string link(const std::string& inside) {
  return "<link name='l'>" + inside + "</link>";
}

class GazeboWorld : public TemporaryFolder {
 protected:
  fs::path write_world(const std::string& inside, const std::string& name = "w.world",
                       const std::string& version = "1.7") const {
    return write(name, "<?xml version='1.0'?>\n<sdf version='" + version +
                           "'><world name='world'>" + inside + "</world></sdf>");
  }
  void write_model(const std::string& folder, const std::string& inside) const {
    write(folder + "/model.config",
          "<?xml version='1.0'?><model><name>m</name><sdf version='1.6'>model.sdf</sdf></model>");
    write(folder + "/model.sdf", "<?xml version='1.0'?><sdf version='1.6'>" + inside + "</sdf>");
  }
  /// A triangle of half a square meter with an image on it, visible from one side.
  void write_textured_mesh(const std::string& folder, const std::string& texture) const {
    write(folder + "/m.obj",
          "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\n"
          "f 1/1 2/2 3/3\n");
    write(folder + "/m.mtl", "newmtl m\nKd 1 1 1\nmap_Kd " + texture + "\n");
  }
  static const Instance& instance(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.instances, name, &Instance::name);
    if (found == scene.instances.end()) throw InputError("no object " + name);
    return *found;
  }
  Scene load(const fs::path& world) { return load_gazebo_world(world, &warnings_); }
  bool collected(std::initializer_list<const char*> parts) const {
    return std::ranges::any_of(
        warnings_, [&](const std::string& w) { return static_cast<bool>(names(w, parts)); });
  }

  std::vector<std::string> warnings_;
};

/// An image of two by one texels, red and green.
std::string image() {
  return std::string("P6\n2 1\n255\n") + std::string("\xff\x00\x00\x00\xff\x00", 6);
}

TEST_F(GazeboWorld, LoadsWithWarningsWhatDoesNotMatterToAImage) {
  const std::string bad_mass =
      "<inertial><mass>-1</mass><inertia><ixx>0</ixx><iyy>-1</iyy><izz>0</izz></inertia></"
      "inertial>";
  const std::string gone =
      "<visual name='g'><geometry><mesh><uri>model://gone/a.dae</uri></mesh></geometry></visual>";
  const auto world = write_world(
      model("box",
            link(bad_mass + box(1) + "<sensor name='s' type='none'/>") +
                "<joint name='j' type='what'><parent>no</parent><child>one</child></joint>") +
      model("box", link(box(1) + gone + gone)) +  // the same name again
      model("a::b", link(box(1) + box(1))) +      // a name that SDF forbids; two equal visuals
      model("empty", "") + "<include><uri>model://absent</uri></include>" +
      "\n<include><uri>model://absent</uri></include>" +
      "<include><uri>https://fuel.gazebosim.org/1.0/someone/models/absent</uri></include>" +
      model("flat", link("<visual name='v'><geometry><box><size>1 1 0</size></box></geometry>"
                         "</visual><visual name='h'><geometry><heightmap><uri>x</uri></heightmap>"
                         "</geometry></visual>")));
  const Scene scene = load(world);
  EXPECT_EQ(scene.instances.size(), 3U);
  EXPECT_NO_THROW(instance(scene, "box_2"));
  EXPECT_TRUE(collected({"w.world", "model://gone/a.dae", "no such file", "(2 times)"}));
  EXPECT_TRUE(collected({"w.world:2", "model://absent", "no such model", "left out (2 times)"}));
  EXPECT_TRUE(collected({"fuel.gazebosim.org", "Fuel's cache"}));
  EXPECT_TRUE(collected({"a box of 1 x 1 x 0", "above 0", "left out"}));
  EXPECT_TRUE(collected({"visual h", "kind of shape is not shown"}));
}

TEST_F(GazeboWorld, DeclarationMayStandBelowAComment) {
  const auto world = write("w.world",
                           "<!-- made\nby hand -->\n<?xml version='1.0'?>\n<sdf version='1.5'>"
                           "<world name='w'>" +
                               model("box", link(box(1))) + "<what></world></sdf>");
  EXPECT_TRUE(names(error_of([&] { load(world); }),
                    {"w.world:4: "}));  // line numbers are those of the original file
  EXPECT_EQ(load(write("v.world", "<!-- -->\n<?xml version='1.0'?>\n<sdf version='1.5'>" +
                                      model("box", link(box(1))) + "</sdf>"))
                .instances.size(),
            1U);
}

TEST_F(GazeboWorld, AnElementThatIsRefusedTakesNoOtherWithIt) {
  std::string inside =
      "<scene><ambient>none</ambient></scene><light type='point' name='bad'><diffuse>nan "
      "x</diffuse>"
      "</light>";
  for (const char* name : {"a", "b", "c", "d", "e"})
    inside += model(name, link("<visual name='v'><geometry><box><size>1 1 1</size></box></geometry>"
                               "</visual>"));
  const Scene scene = load(write_world(inside));
  EXPECT_EQ(scene.instances.size(), 5U);
  EXPECT_TRUE(collected({"w.world", "diffuse"}));
  EXPECT_TRUE(collected({"w.world", "ambient"}));
}

TEST_F(GazeboWorld, ThousandsOfOneNameAreNamedAtOnce) {
  std::string lamps;  // trying names one at a time would take 4.5 million attempts
  for (int i = 0; i < 3000; ++i) lamps += "<light name='l' type='point'/>";
  const Scene scene = load(write_world(model("box", link(box(1))) + lamps));
  EXPECT_EQ(std::ranges::count(scene.lights, Light::Kind::kSphere, &Light::kind), 3000);
}

TEST_F(GazeboWorld, LightOnARoadOfAHundredKilometersIsCoarse) {
  const Scene scene = load(write_world(
      "<include><uri>model://sun</uri></include>" +
      model("road", link("<visual name='v'><geometry><plane><normal>0 0 1</normal><size>100000 100"
                         "</size></plane></geometry></visual>"))));
  EXPECT_GT(scene.triangles.size(), 100'000U);
  EXPECT_LT(scene.triangles.size(), 4'000'000U);
}

TEST_F(GazeboWorld, SunAndGroundPlaneAreBuiltInWhereTheyAreNotThere) {
  const auto world = write_world(
      "<include><uri>model://sun</uri></include><include><uri>model://ground_plane</uri></include>"
      "<include><uri>https://fuel.gazebosim.org/1.0/OpenRobotics/models/Sun</uri></include>");
  const Scene scene = load(world);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  EXPECT_NEAR(instance(scene, "ground_plane").max_m.x(), 50, 1e-3);
  ASSERT_EQ(std::ranges::count(scene.lights, Light::Kind::kSun, &Light::kind), 2);
  EXPECT_NEAR(scene.lights[0].direction.z(), -0.87, 0.01);
  // If the world's folder has a model with one of these names, it takes precedence over the
  // built-in one.
  write_model("models/ground_plane", model("ground_plane", link(box(2))));
  EXPECT_NEAR(instance(load(world), "ground_plane").max_m.x(), 1, 1e-6);
}

TEST_F(GazeboWorld, IncludesAreSeenFromTheFileThatIncludesThem) {
  // Two models, each of which includes the "part" next to it.
  for (const auto& [name, size] : {std::pair{"small", 1.0}, std::pair{"large", 4.0}}) {
    const std::string folder = std::string("kinds/") + name;
    write_model(folder, model(name, "<include><uri>part</uri></include>"));
    write_model(folder + "/part", model("part", link(box(size))));
  }
  const auto world = write_world(
      "<include><uri>kinds/small</uri></include>"
      "<include><uri>kinds/large</uri><name>big</name><pose>10 0 0 0 0 0</pose></include>");
  const Scene scene = load(world);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  EXPECT_NEAR(instance(scene, "small").max_m.x(), 0.5, 1e-6);
  EXPECT_NEAR(instance(scene, "big").max_m.x(), 12, 1e-6);
  // The result is the same from any working folder, even from one that has a different "part".
  const fs::path before = fs::current_path();
  for (const char* place : {"", "kinds/small", "kinds/large"}) {
    fs::current_path(folder_ / place);
    const std::uint64_t seen = digest(load(fs::relative(world)));
    fs::current_path(before);
    EXPECT_EQ(seen, digest(scene)) << place;
  }
}

TEST_F(GazeboWorld, ModelsWithinModelsAreShownInTheirPlace) {
  write_model("models/leaf", model("leaf", link(box(1)), "0 0 5 0 0 0"));
  write_model("models/branch", model("branch",
                                     "<include><uri>model://leaf</uri>"
                                     "<pose>0 2 0 0 0 0</pose></include>"));
  const auto world = write_world(model(
      "tree", "<static>1</static><include><uri>model://branch</uri></include>", "1 0 0 0 0 0"));
  const Scene scene = load(world);
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  const Instance& tree = instance(scene, "tree");
  EXPECT_TRUE(tree.min_m.isApprox(Eigen::Vector3f(0.5F, 1.5F, -0.5F))) << tree.min_m.transpose();
}

// Like green_ball in pal_gazebo_worlds: a single model whose file is damaged.
TEST_F(GazeboWorld, AModelThatCannotBeReadIsLeftOut) {
  write_model("models/ball", model("ball", "<link name='l'>"));
  const Scene scene = load(
      write_world(model("box", link(box(1))) + "\n<include><uri>model://ball</uri></include>"));
  EXPECT_EQ(scene.instances.size(), 1U);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_TRUE(names(warnings_[0], {"w.world:3", "model.sdf:1", "not SDF", "left out"}));
}

TEST_F(GazeboWorld, PosesCountFromTheFramesThatTheyName) {
  const std::string inside = "<frame name='f'><pose>0 0 3 0 0 0</pose></frame>" + link(box(1)) +
                             "<link name='k'><pose relative_to='f'>1 0 0 0 0 0</pose>" + box(2) +
                             "</link>";
  const Scene scene = load(write_world(model("m", inside)));
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  EXPECT_NEAR(instance(scene, "m").max_m.z(), 4, 1e-6);
  // Before version 1.7 the attribute had no meaning; a frame that does not exist is replaced by the
  // parent.
  const std::string odd = "<pose frame='what'>0 0 7 0 0 0</pose>";
  EXPECT_NEAR(instance(load(write_world("<model name='m'>" + odd + link(box(2)) + "</model>",
                                        "old.world", "1.5")),
                       "m")
                  .max_m.z(),
              8, 1e-6);
}

TEST_F(GazeboWorld, FilesAreFoundWhateverTheCaseOfTheirLetters) {
  write_model("Models/Big_Box", model("b",
                                      "<link name='l'><visual name='v'><geometry><mesh><uri>"
                                      "model://big_box/meshes/m.OBJ</uri></mesh></geometry>"
                                      "</visual></link>"));
  write_textured_mesh("Models/Big_Box/Meshes", "textures/Paint.PPM");
  write("Models/Big_Box/materials/Textures/paint.ppm", image());
  const Scene scene = load(write_world("<include><uri>model://big_box</uri></include>"));
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  ASSERT_EQ(scene.triangles.size(), 1U);
  EXPECT_EQ(scene.materials[scene.material_of[0]].texture.width(), 2);
}

TEST_F(GazeboWorld, UrisMayHavePercentCodes) {
  write_model("models/Big Box", model("b",
                                      "<link name='l'><visual name='v'><geometry><mesh><uri>"
                                      "model://Big%20Box/my%20meshes/m.obj</uri></mesh></geometry>"
                                      "</visual></link>"));
  write("models/Big Box/my meshes/m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene = load(write_world("<include><uri>model://Big%20Box</uri></include>"));
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  EXPECT_EQ(scene.triangles.size(), 1U);
}

TEST_F(GazeboWorld, AColladaMeshHasZUpWhateverItsAxisIs) {
  const std::string mesh =
      R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 0 3</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh>
</geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  write("up.dae", mesh);
  const Scene scene = load(write_world(
      model("m", link("<visual name='v'><geometry><mesh><uri>file://up.dae</uri></mesh></geometry>"
                      "</visual>"))));
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  EXPECT_TRUE(instance(scene, "m").max_m.isApprox(Eigen::Vector3f(1, 0, 3)));
}

TEST_F(GazeboWorld, OgreScriptsAndAlbedoMapsDressShapesAndMeshes) {
  write("models/wall/materials/scripts/wall.material",
        "// a comment\nmaterial Base\n{ technique { pass { diffuse 0.5 0.5 0.5 1\n"
        "texture_unit\n{\ntexture wall.ppm\n} } } }\nmaterial Brick/Wall : Base { }\n");
  write("models/wall/materials/textures/wall.ppm", image());
  const std::string script =
      "<material><script><uri>model://wall/materials/scripts</uri>"
      "<uri>model://wall/materials/textures</uri><name>Brick/Wall</name></script></material>";
  const std::string albedo =
      "<material><diffuse>1 1 1 1</diffuse><pbr><metal><albedo_map>"
      "model://wall/materials/textures/wall.ppm</albedo_map></metal></pbr></material>";
  const std::string stock = "<material><script><name>Gazebo/Red</name></script></material>";
  const Scene scene =
      load(write_world(model("a", link(box(1, script))) + model("b", link(box(1, albedo))) +
                       model("c", link(box(1, stock)))));
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_EQ(scene.materials[0].texture(1, 0), (Rgb8{0, 255, 0}));
  EXPECT_EQ(scene.materials[0].base_color, (Rgb8{128, 128, 128}));
  // A single image that is decoded only once.
  EXPECT_EQ(scene.materials[0].texture.identity(), scene.materials[1].texture.identity());
  EXPECT_EQ(scene.materials[2].base_color, (Rgb8{255, 0, 0}));
  // Each side of the box shows the image once.
  const auto [least, most] =
      std::ranges::minmax(scene.uvs, {}, [](const auto& uv) { return uv.x(); });
  EXPECT_EQ(least.x(), 0);
  EXPECT_EQ(most.x(), 1);
  load(write_world(model("a", link(box(1,
                                       "<material><script><uri>x</uri><name>No/Such</name>"
                                       "</script></material>")))));
  EXPECT_TRUE(collected({"material No/Such"}));
}

TEST_F(GazeboWorld, NamesOfMaterialsMayHaveBlanksAround) {
  write("wall.material", "material Wall { technique { pass { diffuse 0 0 1 1 } } }");
  const auto script = [](const std::string& name) {
    return "<material><script><uri>\n file://wall.material </uri><name>" + name +
           "</name></script></material>";
  };
  const Scene scene = load(write_world(model("a", link(box(1, script("Gazebo/Red ")))) +
                                       model("b", link(box(1, script("\n  Wall\n"))))));
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  ASSERT_EQ(scene.materials.size(), 2U);
  load(write_world(model("a", link(box(1, script(""))))));
  EXPECT_TRUE(warnings_.empty()) << "an empty name is none";
  EXPECT_EQ(scene.materials[0].base_color, (Rgb8{255, 0, 0}));
  EXPECT_EQ(scene.materials[1].base_color, (Rgb8{0, 0, 255}));
}

TEST(OgreScript, ReadsFirstDiffuseAndTextureAndInheritsThem) {
  const auto materials = gazebo::parse_ogre_script(
      "material A\n{\n technique\n {\n pass\n {\n  diffuse 1 0.5 0\n"
      "  texture_unit { texture a b.png }\n  texture_unit\n { texture second.png\n } } } }\n"
      "/* material No { } */ material B : A {\n technique { pass { diffuse vertexcolour\n"
      "texture_unit { texture \"b c.jpg\" } } } }\nvertex_program P glsl { source p.vert }\n");
  ASSERT_EQ(materials.size(), 2U);
  EXPECT_EQ(materials[0].texture, "a");
  EXPECT_EQ(materials[0].diffuse, (std::array<float, 4>{1, 0.5F, 0, 1}));
  EXPECT_EQ(materials[1].name, "B");
  EXPECT_EQ(materials[1].texture, "b c.jpg");
  EXPECT_EQ(materials[1].diffuse, materials[0].diffuse);
  EXPECT_NO_THROW(gazebo::parse_ogre_script("material {{{ } \" \n texture"));
  EXPECT_EQ(gazebo::stock_material("Gazebo/GreyTransparent")->diffuse->at(3), 0.5F);
  EXPECT_FALSE(gazebo::stock_material("Gazebo/NoSuch"));
}

TEST_F(GazeboWorld, LightsOfWorldsAndLinksAreTaken) {
  const std::string lamp =
      "<light name='lamp' type='point'><pose>0 0 2 0 0 0</pose><diffuse>1 0.5 0 1</diffuse>"
      "<attenuation><constant>0</constant><linear>0</linear><quadratic>1</quadratic></attenuation>"
      "</light>";
  const Scene scene =
      load(write_world("<scene><ambient>0.25 0.25 0.25 1</ambient></scene>"
                       "<light name='sun' type='directional'><pose>0 0 9 3.14159265 0 0</pose>"
                       "<diffuse>1 1 1 1</diffuse><direction>0 0 1</direction></light>" +
                       model("m", link(box(1) + lamp), "5 0 0 0 0 0")));
  EXPECT_TRUE(warnings_.empty()) << warnings_[0];
  ASSERT_EQ(scene.lights.size(), 3U);
  const auto of = [&](Light::Kind kind) {
    return *std::ranges::find(scene.lights, kind, &Light::kind);
  };
  EXPECT_NEAR(of(Light::Kind::kSun).direction.z(), -1, 1e-5);  // its own z axis, reversed
  const Light point = of(Light::Kind::kSphere);
  EXPECT_TRUE(point.position_m.isApprox(Eigen::Vector3f(5, 0, 2)));
  EXPECT_NEAR(point.color.x(), 3.14159, 1e-4);  // 1 / d^2 attenuation, as in the file
  EXPECT_NEAR(point.color.y(), 0.5 * 3.14159, 1e-4);
  EXPECT_NEAR(of(Light::Kind::kAmbient).color.x(), 0.25, 1e-6);
  // Without any light there is no ambient light either: the scene is shown in its full colors.
  EXPECT_TRUE(load(write_world(model("m", link(box(1))))).lights.empty());
}

TEST_F(GazeboWorld, WhatCannotBeMeantIsRefusedInOneLine) {
  EXPECT_TRUE(names(error_of([&] { load(write_world("\n" + model("m", link(box(1)), "1 2 x"))); }),
                    {"w.world:3", "'1 2 x' is not a pose"}));
  std::string deep = link(box(1));
  for (int i = 0; i < 80; ++i) deep = model("m", deep);
  EXPECT_TRUE(names(error_of([&] { load(write_world(deep)); }), {"w.world", "nested"}));
  // A chain of includes that grows by a factor of ten at each step.
  for (int i = 0; i < 9; ++i) {
    std::string includes;
    for (int k = 0; k < 10; ++k)
      includes += "<include><uri>model://m" + std::to_string(i + 1) + "</uri></include>";
    write_model("models/m" + std::to_string(i), model("m", includes));
  }
  write_model("models/m9", model("m", link(box(1))));
  EXPECT_TRUE(
      names(error_of([&] { load(write_world("<include><uri>model://m0</uri></include>")); }),
            {"more than 10000 includes"}));
}

}  // namespace
}  // namespace mh
