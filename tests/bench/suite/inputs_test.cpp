// SPDX-License-Identifier: Apache-2.0
// The rule for keys: whatever was read, or looked for and not found, is in the key of every result
// that depends on it. For each kind of scene a folder is made, and every file in it is changed,
// hidden and moved elsewhere.
#include "bench/suite/inputs.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "bench/suite/run_key.hpp"
#include "scenes/image_file.hpp"
#include "scenes/load.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& file, const std::string& content) {
  fs::create_directories(file.parent_path());
  write_atomically(file, content);
}

std::string image(std::uint8_t shade) {
  Grid2d<Rgb8> colors(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      colors(x, y) = {static_cast<std::uint8_t>(16 * x), static_cast<std::uint8_t>(16 * y), shade};
  return encode_jpeg(colors, 90);
}

// ---- one mesh in each format -----------------------------------------------------------------

void put_obj(const fs::path& folder) {
  put(folder / "look.mtl",
      "newmtl Wood\nKd 0.9 0.8 0.7\nmap_Kd wood.jpg\nmap_d mask.jpg\nnewmtl Floor\nKd 0 0 1\n");
  put(folder / "wood.jpg", image(40));
  put(folder / "mask.jpg", image(90));
  put(folder / "a.obj",
      "mtllib look.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nvt 0 0\nvt 1 0\nvt 0 1\n"
      "o table_02\nusemtl Wood\nf 1/1 2/2 4/3\nusemtl Floor\nf 1/1 2/2 3/3\n");
}

void put_gltf(const fs::path& folder) {
  const float numbers[] = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 1};  // 3 positions, 3 uvs
  put(folder / "b.bin", {reinterpret_cast<const char*>(numbers), sizeof numbers});
  put(folder / "wall.jpg", image(120));
  put(folder / "b.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"name":"wall_1"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],
    "materials":[{"name":"m","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
    "textures":[{"source":0}],"images":[{"uri":"wall.jpg"}],
    "buffers":[{"uri":"b.bin","byteLength":60}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},
                   {"buffer":0,"byteOffset":36,"byteLength":24}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                  "min":[0,0,0],"max":[1,2,0]},
                 {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}]})");
}

void put_glb(const fs::path& folder) {
  put_gltf(folder / "source");
  save_glb(load_mesh(folder / "source" / "b.gltf"), folder / "c.glb");
  fs::remove_all(folder / "source");
}

void put_dae(const fs::path& folder) {
  put(folder / "cloth.jpg", image(200));
  put(folder / "d.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_images><image id="i"><init_from>cloth.jpg</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>
<technique sid="c"><lambert><diffuse><texture texture="t" texcoord="UV"/></diffuse></lambert>
</technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 2 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="u"><float_array id="ua" count="6">0 0 1 0 0 1</float_array><technique_common>
<accessor source="#ua" count="3" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="M"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#u" offset="1" set="0"/><p>0 0 1 1 2 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node id="curtain_1" name="curtain_1">
<instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="M" target="#m"><bind_vertex_input semantic="UV"
input_semantic="TEXCOORD" input_set="0"/></instance_material></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>)");
}

constexpr const char* kAsciiPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n";

void put_labeled_ply(const fs::path& folder) {
  put_obj(folder / "source");
  save_scannet_ply(load_mesh(folder / "source" / "a.obj"), folder / "e.ply", 10.0F);
  fs::remove_all(folder / "source");
}

// ---- scenes made from them -------------------------------------------------------------------

void put_scannet(const fs::path& folder) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float "
      "y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar "
      "blue\nproperty uchar alpha\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const float corners[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  const std::int32_t face[] = {0, 1, 2};
  const auto ply = [&](bool labels) {
    std::string bytes = head + (labels ? "property ushort label\n" : "") + faces;
    for (const auto& corner : corners) {
      bytes.append(reinterpret_cast<const char*>(corner), sizeof corner);
      bytes += "\x10\x20\x30";
      bytes += '\xff';
      if (labels) bytes += std::string("\x05\x00", 2);
    }
    bytes += '\x03';
    return bytes.append(reinterpret_cast<const char*>(face), sizeof face);
  };
  put(folder / "scannetv2-labels.combined.tsv",
      "id\traw_category\tcategory\tcount\tnyu40id\teigen13id\tnyuClass\tnyu40class\n"
      "2\tchair\tchair\t4646\t5\t4\tchair\tchair\n");
  const fs::path scene = folder / "scans/s";
  put(scene / "s_vh_clean_2.ply", ply(false));
  put(scene / "s_vh_clean_2.labels.ply", ply(true));
  put(scene / "s_vh_clean_2.0.010000.segs.json", R"({"sceneId":"s","segIndices":[7,7,7]})");
  put(scene / "s.aggregation.json",
      R"({"sceneId":"scannet.s","segGroups":[{"id":0,"objectId":0,"segments":[7],"label":"chair"}]})");
  put(scene / "s.txt", "axisAlignment = 0 -1 0 10 1 0 0 20 0 0 1 30 0 0 0 1 \n");
}

void put_gazebo(const fs::path& folder) {
  put_obj(folder / "models/stand/meshes");
  const auto config = [](const std::string& name) {
    return "<?xml version='1.0'?><model><name>" + name +
           "</name><sdf version='1.6'>model.sdf</sdf></model>";
  };
  put(folder / "models/stand/model.config", config("stand"));
  put(folder / "models/stand/model.sdf", R"(<?xml version='1.0'?><sdf version='1.6'>
    <model name='stand'><link name='l'><visual name='v'><geometry><mesh>
    <uri>model://stand/meshes/a.obj</uri></mesh></geometry></visual></link></model></sdf>)");
  put(folder / "models/room/model.config", config("room"));
  put(folder / "models/room/model.sdf", R"(<?xml version='1.0'?><sdf version='1.6'>
    <model name='room'><include><uri>model://stand</uri></include><link name='l'>
    <visual name='v'><geometry><box><size>2 4 6</size></box></geometry></visual></link></model>
    </sdf>)");
  put(folder / "w.world", R"(<?xml version='1.0'?><sdf version='1.6'><world name='w'>
    <include><uri>model://stand</uri><name>desk_1</name></include>
    <include><uri>model://room</uri></include></world></sdf>)");
}

struct Kind {
  const char* name;
  const char* scene;                          ///< inside its folder
  std::function<void(const fs::path&)> make;  ///< puts the scene into a folder
  std::set<std::string> read = {};            ///< files that must be read, at least
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kAll = {
      {"House",
       "room.yaml",
       [](const fs::path& f) {
         put(f / "room.yaml", read_file(MH_SOURCE_DIR "/bench/scenarios/room.yaml"));
       },
       {"room.yaml"}},
      {"PlacedObjects",
       "scene.yaml",
       [](const fs::path& f) {
         put_obj(f / "m"), put_gltf(f / "m"), put_glb(f / "m"), put_dae(f / "m");
         put_labeled_ply(f / "m");
         put(f / "scene.yaml",
             "name: room\nobjects: [{file: m/a.obj}, {file: m/b.gltf}, {file: m/c.glb}, "
             "{file: m/d.dae}, {file: m/e.ply}]\n");
       },
       {"scene.yaml", "m/a.obj", "m/look.mtl", "m/wood.jpg", "m/mask.jpg", "m/b.gltf", "m/b.bin",
        "m/wall.jpg", "m/c.glb", "m/d.dae", "m/cloth.jpg", "m/e.ply", "m/e.labels.json"}},
      {"PlyWithLabelsJson", "e.ply", put_labeled_ply, {"e.ply", "e.labels.json"}},
      {"PlyInText", "f.ply", [](const fs::path& f) { put(f / "f.ply", kAsciiPly); }, {"f.ply"}},
      {"ObjWithLabelsYaml",
       "a.obj",
       [](const fs::path& f) {
         put_obj(f);
         put(f / "labels.yaml", "'Floor*': floor\n'*': bed\n");
       },
       {"a.obj", "look.mtl", "wood.jpg", "mask.jpg", "labels.yaml"}},
      {"Gltf", "b.gltf", put_gltf, {"b.gltf", "b.bin", "wall.jpg"}},
      {"Glb", "c.glb", put_glb, {"c.glb"}},
      {"Dae", "d.dae", put_dae, {"d.dae", "cloth.jpg"}},
      {"Scannet",
       "scans/s",
       put_scannet,
       {"scans/s/s_vh_clean_2.ply", "scans/s/s_vh_clean_2.labels.ply",
        "scans/s/s_vh_clean_2.0.010000.segs.json", "scans/s/s.aggregation.json", "scans/s/s.txt",
        "scannetv2-labels.combined.tsv"}},
      {"Gazebo",
       "w.world",
       put_gazebo,
       {"w.world", "models/stand/model.config", "models/stand/model.sdf",
        "models/stand/meshes/a.obj", "models/stand/meshes/look.mtl", "models/stand/meshes/wood.jpg",
        "models/room/model.config", "models/room/model.sdf"}}};
  return kAll;
}

/// A loaded scene: what can be seen, the names, and what was read for it.
struct Loaded {
  std::uint64_t seen = 0;
  std::vector<std::string> names;
  ReadRecord record;
  std::string run_key, map_key;
};

/// nullopt if it cannot be loaded: then no result can be outdated.
std::optional<Loaded> load(const fs::path& file) {
  Loaded loaded;
  const ReadScope scope;
  try {
    const Scene scene = load_scene(file);
    loaded.seen = digest(scene);
    loaded.names.push_back(scene.name);
    for (const Instance& instance : scene.instances) loaded.names.push_back(instance.name);
  } catch (const InputError&) {
    return std::nullopt;
  }
  loaded.record = scope.record();
  const std::vector<InputDigest> inputs = {input_of("scene", file, loaded.record)};
  RunSpec spec;
  spec.points.emplace_back();
  spec.environment.scene = file;
  loaded.run_key = run_key(spec, inputs);
  loaded.map_key = map_key(spec, inputs);
  return loaded;
}

class SceneKeys : public testing::TestWithParam<Kind> {
 protected:
  SceneKeys()
      : folder_(fs::temp_directory_path() / ("mh_keys_" + std::to_string(getpid())) /
                GetParam().name) {
    fs::remove_all(folder_.parent_path());
    GetParam().make(folder_);
  }
  ~SceneKeys() override { fs::remove_all(folder_.parent_path()); }

  fs::path scene() const { return folder_ / GetParam().scene; }

  std::vector<fs::path> files() const {
    std::vector<fs::path> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (entry.is_regular_file()) all.push_back(entry.path());
    std::ranges::sort(all);
    return all;
  }

  /// Paths of all observations of a kind, relative to the folder.
  std::set<std::string> observed(const ReadRecord& record, FileObservation::Kind kind) const {
    std::set<std::string> paths;
    for (const FileObservation& o : record.observations) {
      const fs::path path = o.path.lexically_normal().lexically_relative(folder_);
      if (o.kind == kind && !path.native().starts_with("..")) paths.insert(path.string());
    }
    return paths;
  }

  fs::path folder_;
};

TEST_P(SceneKeys, EveryByteThatWasReadIsInThem) {
  const auto before = load(scene());
  ASSERT_TRUE(before);
  const std::set<std::string> read = observed(before->record, FileObservation::Kind::kRead);
  for (const std::string& file : GetParam().read) EXPECT_TRUE(read.contains(file)) << file;
  constexpr std::size_t kFlips = 12;
  std::size_t reported = 0;
  for (const std::string& file : read) {
    const std::string content = read_file(folder_ / file);
    const std::size_t step = std::max<std::size_t>(1, content.size() / kFlips);
    std::vector<std::string> others = {content + '\n'};
    for (std::size_t at = 0; at < content.size(); at += step) {
      others.push_back(content);
      others.back()[at] = static_cast<char>(content[at] ^ 1);
    }
    for (std::size_t i = 0; i < others.size(); ++i) {
      put(folder_ / file, others[i]);
      const auto after = load(scene());
      if (!after) continue;
      ++reported;
      EXPECT_NE(after->run_key, before->run_key) << file << " change " << i;
      EXPECT_NE(after->map_key, before->map_key) << file << " change " << i;
    }
    put(folder_ / file, content);
  }
  EXPECT_GT(reported, 0U);
  EXPECT_EQ(load(scene())->run_key, before->run_key);
}

TEST_P(SceneKeys, NoFileDecidesTheSceneUnseen) {
  const auto before = load(scene());
  ASSERT_TRUE(before);
  const std::set<std::string> read = observed(before->record, FileObservation::Kind::kRead);
  for (const fs::path& file : files()) {
    const fs::path hidden = folder_.parent_path() / "hidden";
    fs::rename(file, hidden);
    const auto after = load(scene());
    fs::rename(hidden, file);
    const std::string name = file.lexically_relative(folder_).string();
    const bool other = !after || after->seen != before->seen || after->names != before->names;
    EXPECT_TRUE(!other || read.contains(name)) << name << " decides the scene and was not noted";
    EXPECT_TRUE(!after || !read.contains(name) || after->run_key != before->run_key) << name;
  }
}

TEST_P(SceneKeys, WhatWasLookedForInVainIsInThem) {
  const auto before = load(scene());
  ASSERT_TRUE(before);
  for (const std::string& name : observed(before->record, FileObservation::Kind::kAbsent)) {
    for (const char* content : {"'*': lamp\n", "{}", "newmtl Wood\nKd 0 1 0\n"}) {
      put(folder_ / name, content);
      const auto after = load(scene());
      EXPECT_TRUE(!after || after->run_key != before->run_key) << name << ": " << content;
    }
    fs::remove(folder_ / name);
  }
  EXPECT_EQ(load(scene())->run_key, before->run_key);
}

TEST_P(SceneKeys, AreTheSameForTheSameFolderElsewhere) {
  const auto before = load(scene());
  ASSERT_TRUE(before);
  const fs::path elsewhere = folder_.parent_path() / "quite/another/place";
  fs::create_directories(elsewhere.parent_path());
  fs::copy(folder_, elsewhere, fs::copy_options::recursive);
  const auto after = load(elsewhere / GetParam().scene);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->run_key, before->run_key);
  EXPECT_EQ(after->map_key, before->map_key);
}

INSTANTIATE_TEST_SUITE_P(Of, SceneKeys, testing::ValuesIn(kinds()),
                         [](const auto& kind) { return std::string(kind.param.name); });

// ---- everything else that a run reads ----------------------------------------------------------

class RunInputs : public TemporaryFolder {
 protected:
  RunInputs() {
    const fs::path root = MH_SOURCE_DIR;
    const auto copy = [&](const char* from, const char* to) { write(to, read_file(root / from)); };
    copy("robots/pepper/pepper.yaml", "pepper.yaml");
    copy("robots/pepper/pepper.urdf", "pepper.urdf");
    copy("sim/sensors/levels/pepper.yaml", "level.yaml");
    copy("sim/sensors/levels/ideal.yaml", "sensors.yaml");
    copy("bench/scenarios/pedestrian.yaml", "pedestrian.yaml");
    copy("bench/scenarios/tours/room.yaml", "mapping.yaml");
    copy("bench/scenarios/tours/room_query.yaml", "kidnapped.yaml");
    copy("assets/vocabulary.mhvoc", "words.mhvoc");
    write("replay.tum", "0 1 1 1 0 0 0 1\n0.1 1 1 1 0 0 0 1\n");
    write("program", "#!/bin/sh\n");
    put_obj(folder_ / "here");
    put_gltf(folder_ / "there");
    spec_.name = "run";
    spec_.environment = {.name = "room",
                         .category = "room",
                         .scene = folder_ / "here/a.obj",
                         .robot = folder_ / "pepper.yaml",
                         .mapping_tour = folder_ / "mapping.yaml",
                         .query_tour = "generated:replay:" + (folder_ / "replay.tum").string(),
                         .query_scene = folder_ / "there/b.gltf",
                         .kidnapped_tour = folder_ / "kidnapped.yaml",
                         .sensors = folder_ / "sensors.yaml",
                         .pedestrian = folder_ / "pedestrian.yaml"};
    spec_.level.file = folder_ / "level.yaml";
    spec_.vocabulary = folder_ / "words.mhvoc";
    spec_.system = {
        .kind = SystemKind::kOutside,
        .name = "vo",
        .outside = OutsideProgram{.name = "vo", .command = "./program", .folder = folder_}};
    spec_.points.emplace_back();
  }

  std::vector<InputDigest> inputs() const { return InputReader().inputs_of(spec_); }

  RunSpec spec_;
};

TEST_F(RunInputs, EachIsInItsKeys) {
  const std::vector<InputDigest> before = inputs();
  std::vector<std::string> names;
  for (const InputDigest& input : before) names.push_back(input.name);
  EXPECT_EQ(names, (std::vector<std::string>{"kidnapped_tour", "level", "mapping_tour",
                                             "pedestrian", "query_scene", "query_tour", "robot",
                                             "scene", "sensors", "vo: ./program", "vocabulary"}));
  const std::string run = run_key(spec_, before), map = map_key(spec_, before);
  const auto change = [&](const std::string& file, const std::string& more) {
    const std::string content = read_file(folder_ / file);
    write(file, content + more);
    const std::vector<InputDigest> after = inputs();
    write(file, content);
    EXPECT_NE(run_key(spec_, after), run) << file;
    return map_key(spec_, after) != map;
  };
  for (const char* file :
       {"pepper.yaml", "level.yaml", "sensors.yaml", "pedestrian.yaml", "mapping.yaml",
        "kidnapped.yaml", "program", "here/a.obj", "here/look.mtl"})
    EXPECT_TRUE(change(file, "# more\n")) << file;
  EXPECT_TRUE(change("pepper.urdf", "<!-- more -->\n"));
  EXPECT_TRUE(change("here/wood.jpg", "x"));
  // A map does not depend on its queries.
  EXPECT_FALSE(change("replay.tum", "# more\n"));
  EXPECT_FALSE(change("there/b.bin", "x"));
  EXPECT_EQ(run_key(spec_, inputs()), run);
}

TEST_F(RunInputs, TellTheFilesThatWereReadAndWhatTheyHeld) {
  for (const InputDigest& input : inputs()) {
    std::vector<std::string> files;
    for (const FileDigest& file : input.files) files.push_back(file.file);
    std::vector<std::string> wanted = files;
    if (input.name == "robot") wanted = {"pepper.urdf", "pepper.yaml"};
    if (input.name == "scene") wanted = {"a.obj", "look.mtl", "mask.jpg", "wood.jpg"};
    if (input.name == "pedestrian") wanted = {"pedestrian.yaml"};
    EXPECT_EQ(files, wanted) << input.name;
  }
}

TEST_F(RunInputs, AGeneratedSceneIsItsName) {
  spec_.environment.scene = "generated:bathroom:0";
  const std::string before = run_key(spec_, inputs());
  EXPECT_EQ(run_key(spec_, inputs()), before);
  spec_.environment.scene = "generated:bathroom:1";
  EXPECT_NE(run_key(spec_, inputs()), before);
}

}  // namespace
}  // namespace mh
