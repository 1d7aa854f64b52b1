// SPDX-License-Identifier: Apache-2.0
// `modelhouse slam` as a user sees it, on a small textured room.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/io/files.hpp"
#include "tests/slam/pipeline/box_room_slam.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using testing_support::BoxRoom;

class SlamCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / ("mh_slam_cli_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    TumWriter writer(folder_ / "room", BoxRoom::camera());
    Trajectory truth;
    for (int i = 0; i < 50; ++i) {
      writer.add(testing_support::box_room_frame(i));
      truth.push_back(
          {i * testing_support::kFrame_ns, BoxRoom::round_trip(i, testing_support::kTurnFrames)});
    }
    writer.finish();
    write_tum(folder_ / "room/groundtruth.txt", truth);
    testing_support::box_room_vocabulary()->save(folder_ / "words.mhvoc");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  /// Runs `modelhouse slam ARGUMENTS` with the vocabulary. @returns its exit code
  int run(const std::string& arguments) {
    const fs::path out = folder_ / "stdout", err = folder_ / "stderr";
    const int status =
        std::system((std::string(MH_EXECUTABLE) + " slam " + arguments + " --vocabulary " +
                     path("words.mhvoc") + " >" + out.string() + " 2>" + err.string())
                        .c_str());
    out_ = read_file(out);
    err_ = read_file(err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << err_;
    EXPECT_NE(err_.find("modelhouse: error: "), std::string::npos) << err_;
    EXPECT_NE(err_.find(part), std::string::npos) << err_;
  }
  static std::string path(const std::string& name) { return (folder_ / name).string(); }
  static nlohmann::json summary(const std::string& folder) {
    return nlohmann::json::parse(read_file(folder_ / folder / "summary.json"));
  }

  static inline fs::path folder_;
  std::string out_, err_;
};

TEST_F(SlamCommand, MapsAFolderAndSaysWhatCameOfIt) {
  ASSERT_EQ(run(path("room") + " --out " + path("a") + " --save-map " + path("a.mhmap")), 0)
      << err_;
  EXPECT_NE(out_.find("50 of 50 frames tracked (100.0 %)"), std::string::npos) << out_;
  EXPECT_NE(out_.find("ATE 0.0"), std::string::npos) << out_;
  EXPECT_NE(out_.find("peak memory"), std::string::npos) << out_;
  EXPECT_NE(err_.find("keyframes"), std::string::npos) << "no live figures: " << err_;
  for (const char* file : {"estimate.tum", "estimate.kitti", "frames.csv", "landmarks.ply",
                           "keyframes.ply", "keyframes.json", "summary.json", "settings.yaml"})
    EXPECT_TRUE(fs::exists(folder_ / "a" / file)) << file;

  const auto json = summary("a");
  EXPECT_EQ(json["tracked"], 50);
  EXPECT_LT(json["truth"]["ate_rmse_m"], 0.02);
  EXPECT_GT(json["times"]["features"]["median_ms"], 0);
  const auto graph = nlohmann::json::parse(read_file(folder_ / "a/keyframes.json"));
  EXPECT_EQ(graph["keyframes"].size(), json["keyframes"]);
  EXPECT_FALSE(graph["edges"].empty());
  std::map<int, int> landmarks;
  for (const auto& k : graph["keyframes"]) landmarks[k["id"]] = k["landmarks"];
  for (const auto& e : graph["edges"]) {
    EXPECT_GT(e["shared"], 0);
    EXPECT_LE(e["shared"], std::min(landmarks.at(e["a"]), landmarks.at(e["b"]))) << e;
  }
  EXPECT_EQ(read_trajectory(folder_ / "a/estimate.tum").size(), 50U);
  EXPECT_EQ(read_kitti(folder_ / "a/estimate.kitti").size(), 50U);
  EXPECT_EQ(load_settings(folder_ / "a/settings.yaml").camera,
            load_settings(folder_ / "room/camera.yaml").camera);

  // tum:FOLDER names the same source: the run is repeated, with the settings file that the first
  // run wrote.
  ASSERT_EQ(run("tum:" + path("room") + " --out " + path("b") + " --save-map " + path("b.mhmap") +
                " --settings " + path("a/settings.yaml")),
            0)
      << err_;
  EXPECT_EQ(read_file(folder_ / "a.mhmap"), read_file(folder_ / "b.mhmap"));
  EXPECT_EQ(read_file(folder_ / "a/estimate.tum"), read_file(folder_ / "b/estimate.tum"));
  EXPECT_EQ(summary("b")["map_digest"], json["map_digest"]);
}

TEST_F(SlamCommand, PicksUpAMapToGoOnOrToLocalize) {
  ASSERT_EQ(run(path("room") + " --out " + path("whole") + " --save-map " + path("whole.mhmap")), 0)
      << err_;
  ASSERT_EQ(run(path("room") + " --out " + path("half") + " --frames 30 --save-map " +
                path("half.mhmap")),
            0)
      << err_;
  ASSERT_EQ(run(path("room") + " --out " + path("rest") + " --map " + path("half.mhmap") +
                " --resume --save-map " + path("rest.mhmap")),
            0)
      << err_;
  EXPECT_EQ(read_file(folder_ / "rest.mhmap"), read_file(folder_ / "whole.mhmap"));
  EXPECT_EQ(read_file(folder_ / "rest/estimate.tum"), read_file(folder_ / "whole/estimate.tum"));

  ASSERT_EQ(run(path("room") + " --out " + path("found") + " --map " + path("whole.mhmap") +
                " --localize"),
            0)
      << err_;
  const auto found = summary("found");
  EXPECT_EQ(found["tracked"], 50);
  EXPECT_EQ(found["relocalized"], 1);
  EXPECT_EQ(found["map_digest"], summary("whole")["map_digest"]);
  EXPECT_NE(read_file(folder_ / "found/frames.csv").find(",verified,"), std::string::npos);

  const std::string again = path("room") + " --out " + path("no") + " --map ";
  expect_refused(again + path("whole.mhmap") + " --resume",
                 "nothing is left to resume: it ends at 1.633333317 s");
  EXPECT_NE(err_.find("whole.mhmap"), std::string::npos) << err_;
  EXPECT_NE(run(again + path("whole.mhmap") + " --resume --localize"), 0);

  // The map's settings apply: requested settings that differ are reported.
  std::string other = format_settings(load_settings(folder_ / "room/camera.yaml"));
  other.replace(other.find("count: 1000"), 11, "count: 1500");
  write_atomically(folder_ / "other.yaml", other);
  ASSERT_EQ(run(path("room") + " --out " + path("told") + " --map " + path("half.mhmap") +
                " --resume --frames 2 --settings " + path("other.yaml")),
            0)
      << err_;
  EXPECT_NE(err_.find("other.yaml: the map's own settings are used: features.count: 1000\n"),
            std::string::npos)
      << err_;
}

TEST_F(SlamCommand, AMapIsSearchedByTheSettingsOfRelocalizationThatAreGiven) {
  ASSERT_EQ(run(path("room") + " --frames 30 --out " + path("mapped") + " --save-map " +
                path("mapped.mhmap")),
            0)
      << err_;
  // No frame has a thousand inliers, so no frame is localized.
  const std::string camera = format_settings(load_settings(folder_ / "room/camera.yaml"));
  write_atomically(folder_ / "strict.yaml", camera.substr(0, camera.find("features:")) +
                                                "relocalize:\n  min_inliers: 1000\n");
  const auto localized = [&](const std::string& map, const std::string& out,
                             const std::string& settings) {
    EXPECT_EQ(run(path("room") + " --map " + path(map) + " --localize --frames 5 --out " +
                  path(out) + settings),
              0)
        << err_;
    return summary(out)["tracked"];
  };
  EXPECT_EQ(localized("mapped.mhmap", "by_map", ""), 5);
  EXPECT_EQ(localized("mapped.mhmap", "strictly", " --settings " + path("strict.yaml")), 0);
  EXPECT_EQ(err_.find("the map's own settings are used"), std::string::npos) << err_;
  EXPECT_EQ(load_settings(folder_ / "strictly/settings.yaml").slam.relocalize.min_inliers, 1000);
  // Settings that the file does not mention stay those of the map.
  EXPECT_EQ(
      run(path("room") + " --map " + path("mapped.mhmap") + " --resume --save-map " +
          path("strict.mhmap") + " --out " + path("on") + " --settings " + path("strict.yaml")),
      0)
      << err_;
  EXPECT_EQ(localized("strict.mhmap", "kept", " --settings " + path("room/camera.yaml")), 0);
}

TEST_F(SlamCommand, AMapAnswersByTheFactorsThatAreGiven) {
  // Candidates are chosen by labels alone. In a map made with gamma 0, labels have no weight, so
  // they must be weighted anew.
  std::string settings = format_settings(load_settings(folder_ / "room/camera.yaml"));
  settings.replace(settings.find("overlap: augmented"), 18, "overlap: labels");
  write_atomically(folder_ / "labels.yaml", settings);
  ASSERT_EQ(run(path("room") + " --settings " + path("labels.yaml") + " --gamma 0 --out " +
                path("g0") + " --save-map " + path("g0.mhmap")),
            0)
      << err_;
  ASSERT_EQ(run(path("room") + " --map " + path("g0.mhmap") + " --localize --gamma 1 --out " +
                path("g1")),
            0)
      << err_;
  EXPECT_EQ(summary("g1")["tracked"], 50);
  EXPECT_NE(run(path("room") + " --map " + path("g0.mhmap") + " --localize --save-map " +
                path("g2.mhmap") + " --out " + path("g2")),
            0)
      << "there is nothing to save";
}

TEST_F(SlamCommand, RefusesWhatItCannotUse) {
  const std::string out = " --out " + path("no");
  expect_refused(path("nowhere") + out,
                 "does not exist; a recording is a folder, or " + sequence_forms());
  fs::create_directories(folder_ / "ros2");
  write_atomically(folder_ / "ros2/a_0.db3", "SQLite format 3");
  expect_refused(path("ros2") + out, "is a ROS 2 bag in SQLite: `ros2 bag convert`");
  expect_refused(path("ros2/a_0.db3") + out, "is a ROS 2 bag in SQLite: `ros2 bag convert`");
  fs::create_directories(folder_ / "two");
  write_atomically(folder_ / "two/a.bag", "");
  write_atomically(folder_ / "two/a.mcap", "");
  expect_refused(path("two") + out, "holds bags and MCAP files: name one of them");
  expect_refused("mcap:" + path("two") + out, "a.mcap: is not an MCAP file");
  EXPECT_NE(run(path("room") + out + " --plain --detector boxes.json"), 0) << "looks at no labels";
  expect_refused(path("room") + out + " --detector-cache " + path("cache"),
                 "--detector-cache " + path("cache") + ": no detector is named");
  fs::create_directories(folder_ / "empty");
  expect_refused(path("empty") + out, "holds neither rgb.txt nor associations.txt");
  expect_refused(path("room") + out + " --localize", "--localize needs a map");
  expect_refused(path("room") + out + " --settings " + path("room/rgb.txt"), "rgb.txt");
  expect_refused("scene:house.yaml" + out, "source 'scene:house.yaml' needs --tour");
  expect_refused(path("room") + out + " --robot pepper.yaml",
                 "--robot pepper.yaml: is for scene:FILE");
  EXPECT_NE(run(path("room") + out + " --plain --gamma 2"), 0) << "the one undoes the other";
  std::ofstream(folder_ / "cut.mhmap") << "MHMAP\n";
  expect_refused(path("room") + out + " --map " + path("cut.mhmap"), "truncated");
  std::ofstream(folder_ / "bare.yaml") << "track: {min_inliers: 30}\n";
  expect_refused(path("room") + out + " --settings " + path("bare.yaml"), "'camera' is missing");
}

TEST_F(SlamCommand, FindsBadFilesBeforeTheWork) {
  const std::string start = path("room") + " --out " + path("no");
  const auto refused_at_once = [&](const std::string& more, const std::string& part) {
    expect_refused(start + more, part);
    EXPECT_EQ(err_.find("keyframes"), std::string::npos) << "it worked first: " << err_;
  };
  refused_at_once(" --truth " + path("nowhere.txt"), "nowhere.txt: cannot be read: no such file");
  refused_at_once(" --truth " + path("room/camera.yaml"), "camera.yaml:");
  refused_at_once(" --save-map " + path("room"), "room: cannot be written: it is a folder");
  refused_at_once(" --save-map " + path("no/../no/summary.json"), "is the name of another result");
  fs::create_directories(folder_ / "taken/frames.csv");
  expect_refused(path("room") + " --out " + path("taken"), "frames.csv: already exists");
  refused_at_once(" --save-map " + path("words.mhvoc/map"),
                  "words.mhvoc: cannot be created as a folder");
}

TEST_F(SlamCommand, WithoutDepthNothingIsMappedAndThatIsReported) {
  TumWriter writer(folder_ / "flat", BoxRoom::camera());
  for (int i = 0; i < 5; ++i) {
    RgbdFrame frame = testing_support::box_room_frame(i);
    std::fill(frame.depth_m.begin(), frame.depth_m.end(), 0.0F);
    writer.add(frame);
  }
  writer.finish();
  expect_refused(path("flat") + " --out " + path("no"),
                 "nothing could be mapped: none of 5 frames showed 100 keypoints with depth to "
                 "start with (the first image has no depth)");
  EXPECT_FALSE(fs::exists(folder_ / "no/summary.json"));
}

// Both commands use one runner: on a recording, `slam` gives the same results as `bench`, to the
// bit.
TEST_F(SlamCommand, RunsTheProtocolOfTheBench) {
  const auto by_bench = [&](const std::string& name, const std::string& protocol) {
    const fs::path suite = folder_ / (name + ".yaml"), out = folder_ / (name + "_suite");
    std::ofstream(suite) << "environments: [{category: room, sequence: 'tum:room'}]\n"
                            "vocabulary: words.mhvoc\nlabels: [recorded]\nsystems: [semantic]\n"
                            "slam: {keyframe: {close_depth_m: 3}}  # as camera.yaml has it\n"
                            "seed: 3\nprotocol: "
                         << protocol << "\n";
    EXPECT_EQ(std::system((std::string(MH_EXECUTABLE) + " bench " + suite.string() + " --out " +
                           out.string() + " --jobs 1 --cache " + path("cache") + " >" +
                           path("bench.log") + " 2>&1")
                              .c_str()),
              0)
        << read_file(folder_ / "bench.log");
    for (const auto& entry : fs::recursive_directory_iterator(out))
      if (entry.path().filename() == "estimate.tum") return read_file(entry.path());
    return std::string("no estimate");
  };
  ASSERT_EQ(run(path("room") + " --seed 3 --out " + path("live")), 0) << err_;
  EXPECT_EQ(read_file(folder_ / "live/estimate.tum"),
            by_bench("as_live", "{test_interval: 0, on_failure: continue}"));
  ASSERT_EQ(run(path("room") + " --seed 3 --protocol --out " + path("held")), 0) << err_;
  EXPECT_EQ(read_file(folder_ / "held/estimate.tum"), by_bench("as_paper", "{}"));
  EXPECT_NE(out_.find("49 of 49 frames tracked (100.0 %)"), std::string::npos) << out_;
  EXPECT_NE(out_.find("0 restarts, 0 frames dropped; held-out queries: 1 frame, 100.0 % "
                      "answered, 100.0 % correct, 0.0 % false"),
            std::string::npos)
      << out_;
  EXPECT_EQ(summary("held")["held_out"]["queries"], 1);
  EXPECT_NE(read_file(folder_ / "held/frames.csv").find(",held_out,"), std::string::npos);
  expect_refused(path("room") + " --protocol --resume --map x --out " + path("no"),
                 "--protocol and --resume");
}

TEST_F(SlamCommand, PrintsItsSettings) {
  ASSERT_EQ(run("--print-settings"), 0) << err_;
  EXPECT_EQ(out_, format_slam_config({}, true));
}

}  // namespace
}  // namespace mh
