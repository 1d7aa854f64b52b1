// SPDX-License-Identifier: Apache-2.0
// Real detectors as a user sees them, with artificial networks on a small textured room.
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/recordings/tum_folder.hpp"
#include "sim/sensors/config.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"
#include "tests/slam/detect/made_networks.hpp"
#include "tests/slam/pipeline/box_room_slam.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using testing_support::BoxRoom;

class DetectorCommands : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>(fs::temp_directory_path());
    TumWriter writer(path("room"), BoxRoom::camera());
    for (int i = 0; i < kFrames; ++i) writer.add(testing_support::box_room_frame(i));
    writer.finish();
    testing_support::box_room_vocabulary()->save(path("words.mhvoc"));
    // A network that finds a chair in every cell whose center is red enough.
    write_atomically(
        path("chairs.onnx"),
        test::onnx_detection(320, 256, {.box = {0.5F, 0.5F, 1, 1}, .classes = {1, 0.1F}}));
    write_atomically(path("two.names"), "chair\ntable\n");
    write_atomically(path("two.yaml"), "classes: two.names\nconfidence: 0.5\n");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  int run(const std::string& arguments) {
    const int status = std::system((std::string(MH_EXECUTABLE) + " " + arguments + " >" +
                                    path("stdout") + " 2>" + path("stderr"))
                                       .c_str());
    out_ = read_file(path("stdout"));
    err_ = read_file(path("stderr"));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << err_;
    EXPECT_NE(err_.find(part), std::string::npos) << err_;
    EXPECT_EQ(err_.find('\n'), err_.size() - 1) << err_;
  }
  static std::string path(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string network() {
    return "--detector " + path("chairs.onnx") + " --detector-settings " + path("two.yaml");
  }
  /// Runs `slam` on the room. @returns its trajectory and map
  std::string slam(const std::string& out, const std::string& more) {
    EXPECT_EQ(run("slam " + path("room") + " --vocabulary " + path("words.mhvoc") + " --out " +
                  path(out) + " --save-map " + path(out + ".mhmap") + " " + more),
              0)
        << err_;
    return read_file(path(out + "/estimate.tum")) + read_file(path(out + ".mhmap"));
  }

  static constexpr int kFrames = 30;
  static inline std::unique_ptr<TemporaryFolder> folder_;
  std::string out_, err_;
};

TEST_F(DetectorCommands, FoundBoxesServeAsAFile) {
  ASSERT_EQ(
      run("detector run " + path("room") + " " + network() + " --labels --out " + path("boxes")), 0)
      << err_;
  EXPECT_NE(out_.find("yolox, 2 classes, input 320 x 256\n30 images, "), out_.npos) << out_;
  EXPECT_NE(out_.find("  chair\n"), out_.npos) << out_;
  const auto found = nlohmann::json::parse(read_file(path("boxes/detections.json")));
  ASSERT_GT(found.size(), 30U);
  for (const auto& box : found) {
    EXPECT_EQ(box["category_id"], 1);
    EXPECT_GE(box["score"], 0.5);
  }
  for (int i = 0; i < kFrames; ++i)
    EXPECT_TRUE(fs::exists(path(fmt::format("boxes/{:06}.png", i)))) << i;

  const std::string own = slam("own", ""), by_network = slam("network", network());
  EXPECT_NE(own, by_network) << "labels leave no trace in the map";
  EXPECT_EQ(slam("again", network()), by_network);
  const std::string cached = network() + " --detector-cache " + path("cache");
  EXPECT_EQ(slam("cached", cached), by_network);
  EXPECT_FALSE(fs::is_empty(path("cache")));
  EXPECT_EQ(slam("from_cache", cached), by_network);
  // The file holds only the best class of each box, so the network that it is compared with must
  // output only the best class, too.
  write_atomically(path("sure.onnx"), test::onnx_detection(320, 256, {.box = {0.5F, 0.5F, 1, 1}}));
  const std::string sure =
      "--detector " + path("sure.onnx") + " --detector-settings " + path("two.yaml");
  ASSERT_EQ(run("detector run " + path("room") + " " + sure + " --out " + path("sure")), 0) << err_;
  EXPECT_EQ(slam("by_file", "--detector " + path("sure/detections.json") + " --detector-settings " +
                                path("two.yaml")),
            slam("by_network", sure));
}

TEST_F(DetectorCommands, RenderedFramesCarryItsLabels) {
  const std::string render =
      "render generated:bathroom:0 --motion handheld:0 --level ideal --frames 2 --out ";
  ASSERT_EQ(run(render + path("exact")), 0) << err_;
  ASSERT_EQ(run(render + path("detected") + " " + network()), 0) << err_;
  EXPECT_EQ(read_file(path("exact/rgb.txt")), read_file(path("detected/rgb.txt")));
  const std::string label = list_folder(path("exact/label"), "*.png").front();
  EXPECT_NE(read_file(path("exact/label/" + label)), read_file(path("detected/label/" + label)));
}

TEST_F(DetectorCommands, ScoreAndFitAgree) {
  const std::string rooms = network() + " --scenes generated:office:0 --frames 2 --level ideal";
  ASSERT_EQ(run("detector score " + rooms + " --json --out " + path("score")), 0) << err_;
  EXPECT_EQ(out_, read_file(path("score/score.json")));
  EXPECT_TRUE(fs::exists(path("score/missed.png")));
  const auto score = nlohmann::json::parse(out_);
  EXPECT_EQ(score["images"], 2);
  EXPECT_GT(score["classes"]["chair"]["truths"], 0);
  EXPECT_GT(score["dials"]["false_alarms"], 0) << "chairs where it is red";
  ASSERT_EQ(run("detector fit " + rooms + " --base ideal --out " + path("fitted.yaml")), 0) << err_;
  const DetectorConfig dials = load_sensor_config(path("fitted.yaml")).labels.detector;
  EXPECT_NEAR(dials.false_alarms, score["dials"]["false_alarms"], 1e-6);
  EXPECT_NEAR(dials.recall_large, score["dials"]["recall_large"], 1e-6);
}

TEST_F(DetectorCommands, RefuseWhatWouldHaveNoEffect) {
  const std::string image =
      path("room/" + std::string("rgb/") + list_folder(path("room/rgb"), "*.png").front());
  const std::string out = " " + network() + " --out " + path("no");
  expect_refused("detector run " + image + " " + path("none.png") + out, "none.png");
  expect_refused("detector run " + image + out + " --settings " + path("room/camera.yaml"),
                 "is for a recording, and the sources are images");
  EXPECT_NE(run("render generated:bathroom:0 --frames 1 --labels boxes" + out), 0)
      << "the detector's labels replace them";
  write_atomically(path("both.yaml"), "boxes: some.json\n");
  expect_refused("detector run " + image + " --detector " + path("chairs.onnx") +
                     " --detector-settings " + path("both.yaml") + " --out " + path("no"),
                 "some.json) are both given: name only one");
  write_atomically(path("head.yaml"), "head: yolov5\n");
  write_atomically(path("far.csv"), "500,-1,10,10,50,50,0.9,57\n");
  expect_refused("slam " + path("room") + " --detector " + path("far.csv") +
                     " --detector-settings " + path("head.yaml") + " --out " + path("no"),
                 "far.csv: `head` is a setting for networks, but this holds boxes");
  write_atomically(path("config.yaml"), "classes: two.names\nconfig: two.names\n");
  expect_refused("detector run " + image + " --detector " + path("chairs.onnx") +
                     " --detector-settings " + path("config.yaml") + " --out " + path("no"),
                 "chairs.onnx: is ONNX, which takes no `config`");
  EXPECT_EQ(run("render generated:bathroom:0 --motion handheld:0 --frames 2 --detector " +
                path("far.csv") + " --out " + path("no")),
            2);
  EXPECT_NE(err_.find("none of its 1 frame is one of the sequence's 2, the first is '500': frames "
                      "are named by number from 1"),
            std::string::npos)
      << err_;
  EXPECT_FALSE(fs::exists(path("no")));
}

TEST_F(DetectorCommands, OverwriteNeitherInputsNorForeignFiles) {
  fs::create_directories(path("mine"));
  write_atomically(path("mine/000001.png"), "mine");
  expect_refused("detector run " + path("room") + " " + network() + " --out " + path("mine"),
                 "000001.png: already exists");
  EXPECT_EQ(read_file(path("mine/000001.png")), "mine");
  const std::string image = path("room/rgb/" + list_folder(path("room/rgb"), "*.png").front());
  fs::copy_file(image, path("alone.png"));
  expect_refused("detector run " + path("alone.png") + " " + network() + " --out " +
                     fs::path(path("alone.png")).parent_path().string(),
                 "alone.png: is in the output folder");
  write_atomically(path("scene.yaml"), "mine");
  expect_refused("detector fit " + network() + " --scenes " + path("scene.yaml") + " --out " +
                     path("scene.yaml"),
                 "scene.yaml: is read by this command");
  expect_refused("detector fit " + network() + " --out " + path("two.yaml"),
                 "two.yaml: is read by this command");
  write_atomically(path("notes.yaml"), "mine: 1\n");
  expect_refused("detector fit " + network() + " --scenes office --out " + path("notes.yaml"),
                 "notes.yaml: is not a sensor level");
  expect_refused("detector score " + network() + " --scenes office office", "is named twice");
  write_atomically(path("named.yaml"), "network: " + path("chairs.onnx") + "\n");
  expect_refused("detector run " + path("room") + " --detector missing.onnx --detector-settings " +
                     path("named.yaml") + " --out " + path("none"),
                 "name only one");
}

TEST_F(DetectorCommands, AShorterRunLeavesNothingOfALongerOne) {
  const std::string cached = " " + network() + " --detector-cache " + path("cache_of_runs");
  const std::string command = "detector run " + path("room") + cached + " --out " + path("shorter");
  ASSERT_EQ(run(command + " --frames 3"), 0) << err_;
  EXPECT_NE(out_.find("ms an image"), out_.npos) << out_;
  write_atomically(path("shorter/foreign.png"), "mine");
  write_atomically(path("shorter/000900.png"), "mine");
  ASSERT_EQ(run(command + " --frames 1"), 0) << err_;
  EXPECT_NE(out_.find("1 from the cache"), out_.npos) << out_;
  EXPECT_TRUE(fs::exists(path("shorter/000000.png")));
  EXPECT_FALSE(fs::exists(path("shorter/000001.png")));
  EXPECT_EQ(read_file(path("shorter/foreign.png")), "mine");
  EXPECT_EQ(read_file(path("shorter/000900.png")), "mine");
  write_atomically(path("shorter/000002.png"), "mine");
  expect_refused(command + " --frames 3", "000002.png: already exists");
  EXPECT_EQ(read_file(path("shorter/000002.png")), "mine");
  // The command does not accept its own result as input.
  expect_refused("detector run " + path("room") + " --detector " + path("shorter/detections.json") +
                     " --out " + path("shorter"),
                 "detections.json: is in the output folder");
}

TEST_F(DetectorCommands, AnInterruptedRunLeavesTheResultBeforeIt) {
  const std::string command =
      "detector run " + path("room") + " " + network() + " --frames 2 --out " + path("kept");
  ASSERT_EQ(run(command), 0) << err_;
  const std::string before = read_file(path("kept/detections.json"));
  // One frame has fewer bytes than this limit, but the images of a run have more, so writing fails
  // midway.
  const std::string limited = "sh -c 'ulimit -f 1; " MH_EXECUTABLE " " + command + "'";
  EXPECT_EQ(std::system((limited + " >/dev/null 2>&1").c_str()) / 256, 3);
  EXPECT_EQ(read_file(path("kept/detections.json")), before);
  EXPECT_TRUE(fs::exists(path("kept/000001.png")));
}

TEST_F(DetectorCommands, ACacheThatKeepsNothingIsTold) {
  write_atomically(path("no_folder"), "a file");
  slam("uncached", network() + " --detector-cache " + path("no_folder"));
  EXPECT_NE(err_.find("warning: the cache keeps nothing"), err_.npos) << err_;
}

TEST_F(DetectorCommands, NothingIsFittedToNothing) {
  write_atomically(path("floor.obj"), "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n");
  const std::string floor =
      network() + " --scenes " + path("floor.obj") + " --frames 2 --level ideal";
  ASSERT_EQ(run("detector score " + floor + " --json"), 0) << err_;
  EXPECT_TRUE(nlohmann::json::parse(out_)["dials"]["recall_small"].is_null()) << out_;
  EXPECT_EQ(run("detector fit " + floor + " --out " + path("nothing.yaml")), 2);
  EXPECT_NE(err_.find("nothing is measured"), err_.npos) << err_;
  EXPECT_FALSE(fs::exists(path("nothing.yaml")));
}

TEST_F(DetectorCommands, RefuseInOneLine) {
  const std::string to = " --out " + path("refused");
  expect_refused("detector run " + path("room") + to, "no detector is given");
  expect_refused("detector run " + path("room") + " --network " + path("two.names") + to,
                 "two.names");
  expect_refused("detector run " + path("room") + " --network " + path("chairs.onnx") + to,
                 "has 2 classes, not COCO's 80");
  write_atomically(path("far.csv"), "1,-1,10,10,20,20,nan,1\n");
  expect_refused("slam " + path("room") + " --detector " + path("far.csv") + to, "far.csv:1: ");
  write_atomically(path("one.csv"), "1,-1,10,10,20,20,0.9,1\n");
  expect_refused("detector score --network " + path("one.csv") + to, "name a network");
  EXPECT_FALSE(fs::exists(path("refused")));
}

}  // namespace
}  // namespace mh
