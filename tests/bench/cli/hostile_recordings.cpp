// SPDX-License-Identifier: Apache-2.0
// Recordings, trajectories, vocabularies, maps, results, robots, plans.
#include <array>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "source_dir.hpp"
#include "tests/bench/cli/hostile_files.hpp"

namespace mh {
namespace {

const std::string kRoot = MH_SOURCE_DIR;
const std::string kSlam = " --vocabulary " + kRoot + "/assets/vocabulary.mhvoc --out {}/out";

std::string content(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(kRoot + "/" + file, std::ios::binary).rdbuf();
  return text.str();
}

const std::string kCamera =
    "%YAML:1.0\nCamera.fx: 60\nCamera.fy: 60\nCamera.cx: 31.5\nCamera.cy: 23.5\nCamera.width: 64\n"
    "Camera.height: 48\nCamera.fps: 30\nCamera.bf: 40\nDepthMapFactor: 5000\n";

/// A TUM sequence of three blank frames, with some of its files replaced.
HostileCase tum(const std::string& name, std::map<std::string, std::string> files,
                const std::string& says) {
  HostileCase c{name, std::move(files), "slam {}" + kSlam, says};
  std::string colors, depths;
  for (int i = 1; i <= 3; ++i) {
    colors += fmt::format("{0}.0 rgb/{0}.png\n", i);
    depths += fmt::format("{0}.0 depth/{0}.png\n", i);
    c.files.try_emplace(fmt::format("rgb/{}.png", i),
                        png(64, 48, 8, 2, std::string(193 * 48, '\0')));
    c.files.try_emplace(fmt::format("depth/{}.png", i),
                        png(64, 48, 16, 0, std::string(129 * 48, '\0')));
  }
  c.files.try_emplace("rgb.txt", colors);
  c.files.try_emplace("depth.txt", depths);
  c.files.try_emplace("camera.yaml", kCamera);
  return c;
}

void add_tum(std::vector<HostileCase>& cases) {
  const std::string bmp = "BM" + raw(std::array<std::uint32_t, 3>{100, 0, 54}) +
                          raw(std::array<std::int32_t, 3>{40, 65'000, 65'000}) +
                          raw(std::uint16_t{1}) + raw(std::uint16_t{24}) + std::string(60, '\0');
  cases.push_back(tum("tum_frame_of_1e10_pixels", {{"rgb/2.png", png(100'000, 100'000, 8, 2, "")}},
                      "nothing could be mapped"));
  cases.push_back(
      tum("tum_frame_is_a_bmp_of_4e9_pixels", {{"rgb/2.png", bmp}}, "nothing could be mapped"));
  cases.push_back(tum("tum_frame_is_empty", {{"depth/2.png", ""}}, "nothing could be mapped"));
  cases.push_back(tum("tum_frame_is_a_pipe", {{"rgb/4.png|", ""}, {"rgb.txt", "1.0 rgb/4.png\n"}},
                      "4.png: cannot be read: it is not a file"));
  cases.push_back(tum("tum_list_in_utf16",
                      {{"rgb.txt", std::string("\xff\xfe"
                                               "1\0 \0",
                                               6)}},
                      "UTF-16"));
  cases.push_back(tum("tum_list_of_zeros", {{"rgb.txt", std::string(1000, '\0')}}, "rgb.txt:1: "));
  cases.push_back(tum("tum_stamp_of_1e999", {{"rgb.txt", "1e999 rgb/1.png\n"}}, "1e999"));
  cases.push_back(
      tum("tum_truth_is_not_finite", {{"groundtruth.txt", "1.0 nan 0 0 0 0 0 1\n"}}, "not finite"));
  cases.back().passes = true;  // runs without the truth
  std::string many_colors, many_depths;
  for (int i = 1; i <= 60'000; ++i) {
    many_colors += fmt::format("{}.0 rgb/1.png\n", i);
    many_depths += fmt::format("{}.0 depth/1.png\n", i);
  }
  HostileCase many =
      tum("tum_of_60000_frames", {{"rgb.txt", many_colors}, {"depth.txt", many_depths}},
          "nothing could be mapped");
  many.arguments += " --frames 3";
  cases.push_back(many);
  const std::string keys = kCamera + "ORBextractor.nFeatures: ";
  cases.push_back(tum("settings_of_1e20_features",
                      {{"camera.yaml", keys + "1" + std::string(20, '0')}}, "camera.yaml:11: "));
  cases.push_back(tum("settings_of_a_camera_of_no_length",
                      {{"camera.yaml", "Camera.fx: .nan\n" + kCamera.substr(10)}}, "camera.yaml:"));
  for (const char* which : {"empty", "of_ones"}) {
    HostileCase map =
        tum(fmt::format("map_{}", which),
            {{"m.mhmap", std::string(which[0] == 'e' ? 0 : 5000, '\xff')}}, "m.mhmap: ");
    map.arguments += " --map {}/m.mhmap";
    cases.push_back(map);
  }
  const auto evaluate = [&](const std::string& name, const std::string& estimate,
                            const std::string& says) {
    cases.push_back({name,
                     {{"a.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n"}, {"b.txt", estimate}},
                     "evaluate {}/a.txt {}/b.txt",
                     says});
  };
  evaluate("trajectory_in_utf16",
           std::string("\xfe\xff\0"
                       "0",
                       4),
           "UTF-16");
  evaluate("trajectory_with_a_word", "0 0 0 zero 0 0 0 1\n", "'zero' is not a number");
}

void add_scannet(std::vector<HostileCase>& cases) {
  const auto scan = [&](const std::string& name, const std::string& aggregation,
                        const std::string& says, std::map<std::string, std::string> more = {}) {
    const std::string stem = "scene0000_00/scene0000_00";
    more[stem + "_vh_clean_2.ply"] = triangle_ply();
    more.try_emplace(stem + "_vh_clean_2.0.010000.segs.json", "{\"segIndices\":[0,0,0]}");
    more[stem + ".aggregation.json"] = aggregation;
    cases.push_back({name, std::move(more), "scene info {}/scene0000_00", says});
  };
  const auto object = [](const char* id) {
    return fmt::format("{{\"segGroups\":[{{\"objectId\":{},\"segments\":[0],\"label\":\"x\"}}]}}",
                       id);
  };
  scan("scannet_object_4294967296", object("4294967296"), "4294967296 is not an id");
  scan("scannet_object_5_9", object("5.9"), "5.9 is not an id");
  scan("scannet_object_65535", object("65535"), "more than 65534");
  scan("scannet_aggregation_nested", repeated("[", 1 << 20), "aggregation.json: ");
  scan("scannet_segments_nested", object("0"), "segs.json: ",
       {{"scene0000_00/scene0000_00_vh_clean_2.0.010000.segs.json",
         "{\"segIndices\":" + repeated("[", 1 << 20)}});
  scan("scannet_table_of_tabs", object("0"), "combined.tsv:2: ",
       {{"scene0000_00/scannetv2-labels.combined.tsv",
         "id\traw_category\tnyu40id\n" + std::string(1 << 20, '\t')}});
  scan(
      "scannet_alignment_of_words", object("0"), ".txt:1: ",
      {{"scene0000_00/scene0000_00.txt", "axisAlignment = " + repeated("nan ", 12) + "0 0 0 1\n"}});

  const auto sens = [&](const std::string& name, std::uint64_t name_size, std::uint32_t width,
                        std::uint64_t frames, std::uint64_t color_bytes, const std::string& says) {
    const std::array<float, 16> unit{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const std::array<float, 16> lens{50, 0, 31, 0, 0, 50, 23, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const std::string head = raw(std::uint32_t{4}) + raw(name_size) + "name" + raw(lens) +
                             raw(unit) + raw(lens) + raw(unit) +
                             raw(std::array<std::int32_t, 2>{2, 1}) +
                             raw(std::array<std::uint32_t, 4>{width, 48, width, 48}) + raw(1000.0F);
    cases.push_back({name,
                     {{"a.sens", head + raw(frames) + raw(unit) +
                                     raw(std::array<std::uint64_t, 4>{1, 1, color_bytes, 10}) +
                                     std::string(20, '\0')}},
                     "slam scannet:{}/a.sens" + kSlam,
                     says});
  };
  sens("sens_of_2e62_frames", 4, 64, std::uint64_t{1} << 62, 10, "truncated");
  sens("sens_of_4e9_columns", 4, 0xffffffff, 1, 10, "sides must be");
  sens("sens_of_a_image_of_2e63_bytes", 4, 64, 1, std::uint64_t{1} << 63, "truncated");
  sens("sens_of_a_name_of_2e63_bytes", std::uint64_t{1} << 63, 64, 1, 10, "a sensor's name");
  sens("sens_of_zeros_for_images", 4, 64, 1, 10, "neither JPEG nor PNG");
}

void add_messages(std::vector<HostileCase>& cases) {
  const auto slam = [&](const std::string& name, const std::string& file, const std::string& bytes,
                        const std::string& says) {
    cases.push_back({name, {{file, bytes}}, "slam {}/" + file + kSlam, says});
  };
  const std::string seeds = "tests/fuzz/seeds/";
  const std::string bag = content(seeds + "bag/bz2.bag"), mcap = content(seeds + "mcap/none.mcap");
  slam("bag_of_ones", "a.bag", std::string(5000, '\xff'), "a.bag: is not a ROS 1 bag");
  slam("bag_of_version_1", "a.bag", "#ROSBAG V1.2\n" + std::string(100, '\0'), "of version 1.2");
  slam("bag_cut_in_its_first_chunk", "a.bag", bag.substr(0, 4300),
       "a.bag: holds no messages: at byte 4117: a record is cut short");
  std::string encrypted = bag;
  encrypted.replace(13, 4096,
                    raw(std::uint32_t{33}) + raw(std::uint32_t{4}) + "op=\3" +
                        raw(std::uint32_t{21}) + "encryptor=rosbag/None" + raw(std::uint32_t{0}));
  slam("bag_encrypted", "a.bag", encrypted, "is an encrypted bag");
  slam("bag_of_a_record_of_4_gb", "a.bag", "#ROSBAG V2.0\n" + std::string(8, '\xff'),
       "a record is cut short");
  slam("mcap_of_its_magic_alone", "a.mcap", mcap.substr(0, 8), "a.mcap: holds no messages");
  std::string endless = mcap;
  endless.replace(9, 8, std::string(8, '\xff'));
  slam("mcap_of_a_record_of_2e64_bytes", "a.mcap", endless, "a record is cut short");
  slam("mcap_of_frames_of_2_pixels", "a.mcap", mcap, "nothing could be mapped");
}

void add_vocabularies(std::vector<HostileCase>& cases) {
  const auto info = [&](const std::string& name, const std::string& text, const std::string& says) {
    cases.push_back({"vocabulary_" + name, {{"v", text}}, "vocabulary info {}/v", says});
  };
  const std::string ours = content("assets/vocabulary.mhvoc");
  info("cut", ours.substr(0, 1000), "truncated");
  std::string counts = ours.substr(0, 64);
  counts.replace(16, 48, std::string(48, '\xff'));
  info("of_2e32_words", counts, "v: ");
  info("empty", "", "v: ");
  cases.push_back({"vocabulary_of_100_gigabytes",
                   {{"v+", ours.substr(0, 64)}},
                   "vocabulary info {}/v",
                   "it has 107.4 GB"});
  info("of_20_to_the_10_words", "20 10 0 0\n99999999999 1 " + repeated("1 ", 32) + "1\n", "v:2: ");
  info("with_byte_999", "10 6 0 0\n0 1 " + repeated("999 ", 32) + "1\n", "v:2: ");
  info("in_utf16",
       std::string("\xff\xfe"
                   "1\0",
                   4),
       "UTF-16");
}

}  // namespace

std::vector<HostileCase> hostile_recordings() {
  std::vector<HostileCase> cases;
  add_tum(cases);
  add_scannet(cases);
  add_messages(cases);
  add_vocabularies(cases);
  return cases;
}

std::vector<HostileCase> hostile_settings() {
  std::vector<HostileCase> cases;
  cases.push_back({"results_of_ones",
                   {{"results.sqlite", "SQLite format 3" + std::string(5000, '\xff')}},
                   "export {}/results.sqlite --format json",
                   "results.sqlite: "});
  cases.push_back(
      {"results_empty", {{"results.sqlite", ""}}, "export {} --format csv", "results.sqlite: "});
  cases.push_back({"suite_nested",
                   {{"s.yaml", repeated("{a: ", 100'000)}},
                   "bench {}/s.yaml --out {}/o",
                   "s.yaml:1: "});
  cases.push_back({"suite_of_1e20_trials",
                   {{"s.yaml", "name: x\ntrials: 99999999999999999999\n"}},
                   "bench {}/s.yaml --out {}/o",
                   "s.yaml:"});
  const std::string house = kRoot + "/scenes/rooms/office.yaml",
                    yaml = content("robots/pepper/pepper.yaml");
  const auto drive = [&](const std::string& name, std::map<std::string, std::string> files,
                         const std::string& motion, const std::string& says) {
    const std::string robot =
        files.contains("r.yaml") ? "{}/r.yaml" : kRoot + "/robots/pepper/pepper.yaml";
    cases.push_back({name, std::move(files),
                     fmt::format("drive {} {} --robot {}", house, motion, robot), says});
  };
  std::string links, children;
  for (int i = 0; i < 5000; ++i) links += fmt::format("<link name=\"link_{}\"/>", i);
  const auto urdf = [](const std::string& text) {
    return "<robot name=\"r\">" + text + "</robot>";
  };
  for (int i = 0; i < 4999; ++i)
    children += fmt::format(
        "<joint name=\"j{:04}\" type=\"fixed\"><parent link=\"link_{}\"/><child "
        "link=\"link_{}\"/></joint>",
        4999 - i, i, i + 1);
  drive("urdf_chain_of_5000_links", {{"r.yaml", yaml}, {"pepper.urdf", urdf(links + children)}},
        "--motion auto", "has no joint");
  std::string materials;
  for (int i = 0; i < 5000; ++i)
    materials += fmt::format("<material name=\"m{}\"><color rgba=\"1 1 1 1\"/></material>", i);
  drive("urdf_of_5000_materials_and_a_fault",
        {{"r.yaml", yaml},
         {"pepper.urdf",
          urdf(materials + links + children +
               "<link name=\"bad\"><inertial><mass value=\"nan\"/></inertial></link>")}},
        "--motion auto", "pepper.urdf: ");
  drive("urdf_nested",
        {{"r.yaml", yaml}, {"pepper.urdf", urdf(repeated("<link name=\"a\">", 100'000))}},
        "--motion auto", "pepper.urdf:1: ");
  drive("robot_in_utf16", {{"r.yaml", std::string("\xff\xfen\0", 4)}}, "--motion auto", "UTF-16");
  drive(
      "tour_at_infinity",
      {{"t.yaml",
        "name: x\nstart: {position: [1e300, 0], heading_deg: 0}\nwaypoints:\n  - {to: [0, 0]}\n"}},
      "{}/t.yaml", "t.yaml:2: ");
  drive("replay_of_285_years", {{"t.tum", "0 1 1 1 0 0 0 1\n9e9 1 1 1 0 0 0 1\n"}},
        "--motion replay:{}/t.tum", "t.tum: ");
  drive("replay_at_infinity", {{"t.tum", "0 1e300 1 1 0 0 0 1\n1 1 1 1 0 0 0 1\n"}},
        "--motion replay:{}/t.tum", "line 1: position");
  drive("motion_of_2e9_frames", {}, "--motion handheld:0:2000000000", "2000000000");
  cases.push_back(
      {"floor_of_18000_km",
       {{"a.obj", "o floor\nv -9e6 -9e6 0\nv 9e6 -9e6 0\nv 9e6 9e6 0\nv -9e6 9e6 0\nf 1 2 3 4\n"}},
       "drive {}/a.obj --motion auto --robot " + kRoot + "/robots/pepper/pepper.yaml",
       "too large"});
  std::string level = content("sim/sensors/levels/handheld.yaml");
  level.replace(level.find("max_range_m: 8.0"), 16, "max_range_m: .inf");
  cases.push_back({"level_of_infinite_range",
                   {{"l.yaml", level}},
                   fmt::format("render {} --motion handheld:0 --robot {}/robots/pepper/pepper.yaml "
                               "--level {{}}/l.yaml --out {{}}/o",
                               house, kRoot),
                   "l.yaml:"});
  return cases;
}

}  // namespace mh
