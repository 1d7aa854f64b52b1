// SPDX-License-Identifier: Apache-2.0
// Meshes, worlds and the files that belong to them.
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tests/bench/cli/hostile_files.hpp"

namespace mh {
namespace {

HostileCase scene(const std::string& name, const std::string& file, const std::string& content,
                  const std::string& says, std::map<std::string, std::string> more = {}) {
  more[file] = content;
  return {name, std::move(more), "scene info {}/" + file, says};
}

HostileCase passing(HostileCase c) {
  c.passes = true;
  return c;
}

const std::string kMesh = "{\"mesh\":0}", kGeometry = "<instance_geometry url=\"#g\"/>";
const std::string kPoints = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kTextured = "mtllib a.mtl\n" + kPoints + "vt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
const std::string kMaterial = "newmtl m\nmap_Kd t.png\n";

void add_ply(std::vector<HostileCase>& cases) {
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    cases.push_back(scene(fmt::format("ply_cut_in_header_{}", format), "a.ply",
                          ply_header(format).substr(0, 60), "a.ply:"));
  const std::string ascii = ply_header("ascii"), big = ply_header("binary_big_endian");
  const std::string points = raw(std::array<float, 9>{});
  cases.push_back(scene("ply_ascii_cut", "a.ply", ascii + "0 0 0\n1 0 0\n0 1", "a.ply: "));
  cases.push_back(
      passing(scene("ply_ascii_cut_in_face", "a.ply", ascii + "0 0 0\n1 0 0\n0 1 0\n3 0", "")));
  cases.push_back(scene("ply_big_endian_cut", "a.ply", big + points.substr(0, 16), "truncated"));
  cases.push_back(scene("ply_big_endian_list_without_end", "a.ply",
                        big + points + '\xff' + std::string(12, '\0'), "a.ply: "));
  cases.push_back(
      scene("ply_ascii_of_words", "a.ply", ascii + "x y z\n1 0 0\n0 1 0\n3 0 1 2\n", "a.ply: "));
  cases.push_back(scene("ply_ascii_of_4e9_vertices", "a.ply",
                        ply_header("ascii", "4000000000") + "0 0 0\n", "a.ply: "));
  cases.push_back(scene("ply_of_2e64_faces", "a.ply",
                        ply_header("binary_little_endian", "3", "18446744073709551615") + points,
                        "truncated"));
  cases.push_back(scene("ply_of_100_gigabytes", "a.ply+", triangle_ply(),
                        "it has 107.4 GB, at most 4.3 GB can be read"));
  cases.back().arguments.pop_back();
  std::string obeyed = ascii;  // contains an escape sequence that a terminal would execute
  obeyed.replace(obeyed.find("property float z"), 16, "property \x1b[2J\xff z");
  cases.push_back(scene("ply_that_clears_the_screen", "a.ply", obeyed, "a.ply:6: '?[2J?'"));
  std::string lists = ascii;
  lists.replace(lists.find("property float z"), 16, "property list uchar float z");
  cases.push_back(scene("ply_of_lists_for_positions", "a.ply", lists + "0 0 2 1 1\n", "a.ply: "));
  const auto labels = [](const std::string& id) {
    return std::map<std::string, std::string>{
        {"a.labels.json",
         "{\"format\":\"modelhouse-labels\",\"version\":1,\"name\":\"x\","
         "\"vertices\":3,\"faces\":1,\"instances\":[[" +
             id + ",\"chair\",\"c\"]],\"runs\":[[1," + id + ",\"chair\"]],\"rooms\":[]}"}};
  };
  for (const char* id : {"65541", "5.9", "-1", "1e30", "null", "[5]"})
    cases.push_back(scene(fmt::format("labels_of_instance_case_{}", cases.size()), "a.ply",
                          triangle_ply(), "not an integer from 0 to 65535", labels(id)));
  cases.push_back(scene("labels_nested", "a.ply", triangle_ply(),
                        "a.labels.json: ", {{"a.labels.json", repeated("[", 1 << 20)}}));
  cases.push_back(scene("label_rules_nested", "a.obj", kPoints + "f 1 2 3\n",
                        "labels.yaml:1: ", {{"labels.yaml", repeated("{a: ", 100'000)}}));
}

void add_obj(std::vector<HostileCase>& cases) {
  std::string circle, face = "f";
  for (int i = 0; i < 60'000; ++i) {
    circle +=
        fmt::format("v {} {} 0\n", std::cos(i * 2 * M_PI / 60e3), std::sin(i * 2 * M_PI / 60e3));
    face += fmt::format(" {}", i + 1);
  }
  cases.push_back(passing(
      scene("obj_polygon_of_60000_corners", "a.obj", circle + face + "\n", "60000 corners")));
  cases.push_back(passing(scene("obj_mtllib_is_a_pipe", "a.obj",
                                "mtllib x.mtl\n" + kPoints + "f 1 2 3\n", "", {{"x.mtl|", ""}})));
  cases.push_back(
      passing(scene("obj_texture_is_a_device", "a.obj", kTextured, "/dev/zero is missing",
                    {{"a.mtl", "newmtl m\nmap_Kd /dev/zero\n"}})));
  cases.push_back(scene(
      "obj_of_70000_objects", "a.obj",
      [] {
        std::string text = kPoints;
        for (int i = 0; i < 70'000; ++i) text += fmt::format("o n{}\nf 1 2 3\n", i);
        return text;
      }(),
      "a.obj: "));
  HostileCase unreadable = passing(scene("obj_of_names_that_are_no_text", "a.obj",
                                         "o \xff\xfe\x1b[31mchair\n" + kPoints + "f 1 2 3\n", ""));
  unreadable.arguments = "scene convert {}/a.obj --out {}/b.ply";
  cases.push_back(unreadable);
  cases.push_back(scene("obj_of_zeros", "a.obj", std::string(100'000, '\0'), "a.obj: "));
  cases.push_back(
      scene("obj_names_vertex_1e19", "a.obj", kPoints + "f 99999999999999999999 2 3\n", "a.obj: "));
  cases.push_back(
      scene("obj_at_infinity", "a.obj", "v 1e999 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"));
  cases.push_back(scene("obj_in_utf16", "a.obj", std::string("\xff\xfev\0 \0", 6), "UTF-16"));
  const auto texture = [&](const std::string& name, const std::string& content) {
    cases.push_back(passing(scene("texture_" + name, "a.obj", kTextured, "texture t.png",
                                  {{"a.mtl", kMaterial}, {"t.png", content}})));
  };
  texture("of_1e10_pixels", png(100'000, 100'000, 8, 2, ""));
  texture("of_2_gigabytes", png(16'000, 16'000, 16, 6, std::string(16'000 * 8 * 100, '\0')));
  texture("of_a_bmp_of_4e9_pixels", "BM" + raw(std::array<std::uint32_t, 3>{100, 0, 54}) +
                                        raw(std::array<std::int32_t, 3>{40, 65'000, 65'000}) +
                                        raw(std::uint16_t{1}) + raw(std::uint16_t{24}) +
                                        std::string(60, '\0'));
  texture("of_a_jpeg_without_data",
          std::string(
              "\xff\xd8\xff\xc0\0\x11\x08\xff\xff\xff\xff\3\1\x22\0\2\x11\1\3\x11\1\xff\xd9", 23));
}

void add_gltf(std::vector<HostileCase>& cases) {
  const auto chain = [](int depth, int children) {
    std::string nodes;
    for (int i = 1; i <= depth; ++i)
      nodes += children == 1 ? fmt::format("{{\"children\":[{}]}},", i)
                             : fmt::format("{{\"children\":[{},{}]}},", i, i);
    return nodes + kMesh;
  };
  cases.push_back(passing(scene("gltf_nested_20000_deep", "a.gltf", gltf(chain(20'000, 1)), "")));
  cases.push_back(scene("gltf_that_doubles_30_times", "a.gltf", gltf(chain(30, 2)), "a.gltf: "));
  cases.push_back(
      scene("gltf_of_a_megabyte_of_brackets", "a.gltf", repeated("[", 1 << 20), "a.gltf: "));
  cases.push_back(
      scene("gltf_of_objects_in_objects", "a.gltf", repeated("{\"a\":", 300'000), "a.gltf: "));
  std::string same, all;
  for (int i = 0; i < 30'000; ++i) {
    same += std::string(i > 0 ? "," : "") + R"({"mesh":0,"name":"chair"})";
    all += fmt::format("{}{}", i > 0 ? "," : "", i);
  }
  cases.push_back(passing(scene("gltf_of_30000_nodes_of_one_name", "a.gltf", gltf(same, all), "")));
  cases.push_back(scene("gltf_circle", "a.gltf",
                        gltf(R"({"children":[1]},{"children":[0],"mesh":0})"), "a.gltf: "));
  cases.push_back(scene("gltf_buffer_is_a_device", "a.gltf",
                        gltf(kMesh, "0", R"(,"buffers":[{"byteLength":36,"uri":"/dev/zero"}])"),
                        ""));
  cases.push_back(scene(
      "gltf_of_4e9_vertices", "a.gltf",
      gltf(kMesh, "0", R"(,"accessors":[{"componentType":5126,"count":4000000000,"type":"VEC3"}])"),
      "a.gltf: "));
  cases.push_back(scene("gltf_far_away", "a.gltf", gltf(R"({"mesh":0,"scale":[1e38,1e38,1e38]})"),
                        "from the origin"));
  std::string cut = glb(gltf(kMesh));
  cut.replace(8, 8, std::string(8, '\xff'));
  cases.push_back(scene("glb_of_4_gigabytes", "a.glb", cut, "a.glb: "));
  cases.push_back(scene("glb_cut", "a.glb", glb(gltf(kMesh)).substr(0, 19), "a.glb: "));
}

void add_dae(std::vector<HostileCase>& cases) {
  cases.push_back(passing(
      scene("dae_nested_50000_deep", "a.dae",
            dae(repeated("<node>", 50'000) + kGeometry + repeated("</node>", 50'000)), "")));
  cases.push_back(scene("dae_node_in_itself", "a.dae",
                        dae("<node id=\"n\">" + kGeometry + "<instance_node url=\"#n\"/></node>"),
                        "a.dae: "));
  std::string nodes;
  for (int i = 0; i < 32; ++i)
    nodes += fmt::format(
        "<node id=\"n{0}\"><instance_node url=\"#n{1}\"/><instance_node "
        "url=\"#n{1}\"/></node>",
        i, i + 1);
  cases.push_back(scene(
      "dae_that_doubles_32_times", "a.dae",
      dae("<node><instance_node url=\"#n0\"/></node>",
          "<library_nodes>" + nodes + "<node id=\"n32\">" + kGeometry + "</node></library_nodes>"),
      "a.dae: "));
  cases.push_back(scene("dae_skin_of_itself", "a.dae",
                        dae("<node><instance_controller url=\"#c\"/></node>",
                            "<library_controllers><controller id=\"c\"><skin source=\"#c\"/>"
                            "</controller></library_controllers>"),
                        "a.dae: "));
  std::string stride = dae("<node>" + kGeometry + "</node>");
  stride.replace(stride.find("stride=\"3\""), 10, "stride=\"4000000000\"");
  cases.push_back(scene("dae_of_steps_of_4e9", "a.dae", stride, "a.dae: "));
  cases.push_back(scene("dae_cut", "a.dae", dae("<node/>").substr(0, 700), "a.dae: "));
}

}  // namespace

std::vector<HostileCase> hostile_scenes() {
  std::vector<HostileCase> cases;
  add_ply(cases);
  add_obj(cases);
  add_gltf(cases);
  add_dae(cases);
  return cases;
}

std::vector<HostileCase> hostile_worlds() {
  const auto model = [](const std::string& geometry) {
    return "<model name=\"m\"><link name=\"l\"><visual name=\"v\"><geometry>" + geometry +
           "</geometry></visual></link></model>";
  };
  const std::string self = dae("<node id=\"n\"><instance_node url=\"#n\"/></node>");
  std::vector<HostileCase> cases = {
      scene("sdf_nested_20000_deep", "a.sdf", world(repeated("<model name=\"m\">", 20'000)),
            "a.sdf:"),
      scene("sdf_of_infinite_boxes", "a.world", world(model("<box><size>inf 1 nan</size></box>")),
            "a.world: "),
      scene("sdf_frames_in_a_circle", "a.world",
            world("<frame name=\"a\" attached_to=\"b\"/><frame name=\"b\" attached_to=\"a\"/>"),
            "a.world: "),
      scene("sdf_includes_a_device", "a.world", world("<include><uri>/dev/zero</uri></include>"),
            ""),
      passing(scene(
          "sdf_script_is_a_pipe", "a.world",
          world("<model name=\"m\"><link name=\"l\"><visual name=\"v\"><geometry><box><size>1 1 1"
                "</size></box></geometry><material><script><uri>m.material</uri><name>X</name>"
                "</script></material></visual></link></model>"),
          "m.material: cannot be read: it is not a file", {{"m.material|", ""}})),
      scene("sdf_of_20001_boxes", "a.world",
            world("<model name=\"m\"><link name=\"l\">" +
                  repeated("<visual><geometry><box/></geometry></visual>", 20'001) +
                  "</link></model>"),
            "a model of more than 20000 visuals"),
      scene("sdf_of_zeros", "a.sdf", std::string(1000, '\0'), "a.sdf:"),
      scene("placed_alias_of_itself", "a.yaml", "objects: &a [*a]\n", "a.yaml:1: "),
      scene("placed_at_infinity", "a.yaml", "objects:\n  - {file: t.obj, scale: 1e300}\n",
            "not finite", {{"t.obj", kPoints + "f 1 2 3\n"}}),
      scene("placed_device", "a.yaml", "objects:\n  - {file: /dev/zero}\n", "/dev/zero: "),
      scene("placed_mesh_that_crashes", "a.yaml", "objects:\n  - {file: b.dae}\n",
            "b.dae: ", {{"b.dae", self}}),
      scene("house_nested", "a.yaml", repeated("[", 1 << 20), "a.yaml:1: "),
      scene("house_of_30_megabytes", "a.yaml", "name: " + std::string(30 << 20, 'x'), "a.yaml: "),
      scene("house_in_utf16", "a.yaml", std::string("\xff\xfen\0", 4), "UTF-16"),
      scene(
          "house_of_aliases_of_aliases", "a.yaml",
          [] {
            std::string text = "a: &a [x,x,x,x,x,x,x,x,x]\n";
            for (char c = 'b'; c < 'm'; ++c)
              text += fmt::format("{0}: &{0} [*{1},*{1},*{1},*{1},*{1},*{1}]\n", c,
                                  static_cast<char>(c - 1));
            return text;
          }(),
          "500000 values"),
  };
  return cases;
}

}  // namespace mh
