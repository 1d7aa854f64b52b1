// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/render_sequence.hpp"

#include <unistd.h>

#include <atomic>
#include <fstream>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "bench/suite/recorded_camera.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "scenes/recordings/scannet_folder.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "scenes/scannet/label_table.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/read_record.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// The content of every file below a folder, by relative path.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
  return files;
}

class RenderSequence : public testing::Test {
 protected:
  RenderSequence()
      : folder_(fs::temp_directory_path() / ("mh_render_" + std::to_string(getpid()))) {
    Scene scene = test::empty_room();
    test::add_box(scene, "box", {6, 4, 0}, {7, 6, 1});
    camera_.width_px = 64;
    camera_.height_px = 48;
    camera_.fx_px = camera_.fy_px = 50;
    camera_.cx_px = 31.5;
    camera_.cy_px = 23.5;
    sensors_.depth_noise.enabled = false;
    const Robot robot = test::pepper();
    Trajectory path;
    for (int i = 0; i < 12; ++i) {
      const SE3 world_from_base(
          Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {3, 5, 0});
      path.push_back({i * 33'333'333LL, world_from_base * robot.base_from_camera});
    }
    shutter_ = std::make_unique<Shutter>(
        std::shared_ptr<const Renderer>(make_embree_renderer(scene)), camera_, path, sensors_);
  }
  ~RenderSequence() override { fs::remove_all(folder_); }

  std::map<std::string, std::string> rendered(const char* layout, const char* name,
                                              RenderSequenceOptions options) {
    const auto writer = make_sequence_writer(layout, folder_ / name, camera_);
    result_ = render_sequence(*shutter_, sensors_, *writer, options, [](double) {});
    return contents(folder_ / name);
  }

  fs::path folder_;
  Camera camera_;
  SensorConfig sensors_;
  std::unique_ptr<Shutter> shutter_;
  RenderedSequence result_;
};

TEST_F(RenderSequence, TheBytesDoNotDependOnTheThreads) {
  for (const char* layout : {"tum", "scannet-frames"}) {
    const std::string name = layout;
    const auto one = rendered(layout, (name + "1").c_str(), {.threads = 1});
    const auto four = rendered(layout, (name + "4").c_str(), {.threads = 4});
    EXPECT_EQ(result_.frames, 12U);
    EXPECT_EQ(one, four) << layout;
    EXPECT_NE(one, rendered(layout, (name + "s").c_str(), {.seed = 1, .threads = 1}));
  }
}

TEST_F(RenderSequence, GoesOnWhereItWasStopped) {
  const auto whole = rendered("tum", "whole", {.every = 2, .threads = 1});
  EXPECT_EQ(result_.frames, 6U);
  {
    const auto writer = make_sequence_writer("tum", folder_ / "part", camera_);
    EXPECT_THROW(render_sequence(*shutter_, sensors_, *writer, {.every = 2, .threads = 2},
                                 [](double share) {
                                   if (share > 0.4) throw InputError("stopped");
                                 }),
                 InputError);
  }
  EXPECT_FALSE(fs::exists(folder_ / "part" / "rgb.txt")) << "an unfinished folder looks finished";
  const auto gone_on = rendered("tum", "part", {.every = 2, .threads = 2, .resume = true});
  EXPECT_GT(result_.resumed, 0U);
  EXPECT_EQ(result_.resumed + result_.frames, 6U);
  EXPECT_EQ(gone_on, whole);
}

TEST_F(RenderSequence, TimesItsStagesWhereItWritesFrames) {
  rendered("tum", "whole", {.threads = 1});
  EXPECT_GT(result_.render_s, 0);
  EXPECT_GT(result_.encode_s, 0);
  rendered("tum", "whole", {.threads = 1, .resume = true});
  EXPECT_EQ(result_.frames, 0U);
  EXPECT_EQ(result_.render_s, 0);
  EXPECT_EQ(result_.encode_s, 0);
}

TEST_F(RenderSequence, MakesAnewWhatWasCutOff) {
  for (const char* layout : {"tum", "scannet-frames"}) {
    const std::string name = layout;
    const auto whole = rendered(layout, name.c_str(), {});
    std::size_t k = 0;
    for (const auto& [file, bytes] :
         whole) {  // every fifth image, each truncated at a different length
      const std::string ending = fs::path(file).extension();
      if ((ending != ".png" && ending != ".jpg") || k++ % 5 != 0) continue;
      fs::resize_file(folder_ / name / file, bytes.size() * (k % 3) / 3);
    }
    if (name == "scannet-frames") fs::resize_file(folder_ / name / "pose" / "7.txt", 0);
    EXPECT_EQ(rendered(layout, name.c_str(), {.resume = true}), whole);
    EXPECT_GE(result_.frames, 4U) << layout;
  }
}

TEST_F(RenderSequence, MakesAnewWhatShowsSomethingElse) {
  const auto whole = rendered("tum", "room", {});
  const auto name = [](std::size_t i) {
    return fmt::format("{}.png", format_stamp(33'333'333LL * i));
  };
  fs::copy_file(folder_ / "room/rgb" / name(0), folder_ / "room/rgb" / name(5),
                fs::copy_options::overwrite_existing);
  EXPECT_EQ(rendered("tum", "room", {.resume = true}), whole);
  EXPECT_EQ(result_.frames, 1U);
  // A frame that changes while others are rendered is noticed at the end.
  const auto writer = make_sequence_writer("tum", folder_ / "changed", camera_);
  EXPECT_THROW(render_sequence(*shutter_, sensors_, *writer, {.threads = 1},
                               [&](double share) {
                                 if (share == 1)
                                   fs::resize_file(folder_ / "changed/rgb" / name(3), 100);
                               }),
               InputChanged);
  EXPECT_FALSE(fs::exists(folder_ / "changed" / "rgb.txt"));
}

TEST_F(RenderSequence, DroppedFramesAreLeftOutAndTheOthersAreTheSame) {
  const auto whole = rendered("tum", "whole", {});
  sensors_.dropped_frames = {.enabled = true, .share = 0.4};
  const auto part = rendered("tum", "part", {});
  EXPECT_LT(result_.frames, 12U);
  EXPECT_GT(result_.frames, 2U);
  for (const auto& [file, bytes] : part)
    if (file.ends_with(".png")) {
      EXPECT_EQ(bytes, whole.at(file)) << file;
    }
}

TEST_F(RenderSequence, LabelsAreThoseThatArrive) {
  const RenderedFrame truth = shutter_->expose(3).seen;
  const auto labels = [&](const RenderSequenceOptions& options) {
    return exact_frame(*shutter_, sensors_, options, 3).classes;
  };
  EXPECT_EQ(labels({}), truth.classes);
  EXPECT_EQ(labels({.labels = LabelMode::kBoxes}),
            class_image(label_image(truth, LabelMode::kBoxes)));
  sensors_.labels.noise = {.enabled = true, .dropout = 1.0};  // no instance is labeled
  const Grid2d<ClassId> without = labels({});
  for (int y = 0; y < camera_.height_px; ++y)
    for (int x = 0; x < camera_.width_px; ++x)
      if (truth.instances(x, y) != 0) {
        ASSERT_EQ(without(x, y), kVoid);
      }
  sensors_.blank_frames = {.enabled = true, .share = 1.0};
  const ExactFrame blank = exact_frame(*shutter_, sensors_, {}, 3);
  EXPECT_EQ(blank.classes, Grid2d<ClassId>(camera_.width_px, camera_.height_px, kVoid));
  EXPECT_EQ(blank.instances, truth.instances);
}

TEST_F(RenderSequence, EveryNthFrameComesAtAnNthOfTheRate) {
  EXPECT_EQ(recorded_camera(camera_, {}), camera_);
  const RenderSequenceOptions options{.every = 5, .threads = 1};
  {
    const auto writer =
        make_sequence_writer("tum", folder_ / "fifth", recorded_camera(camera_, options));
    render_sequence(*shutter_, sensors_, *writer, options, [](double) {});
  }
  EXPECT_DOUBLE_EQ(load_recorded_camera(folder_ / "fifth" / "camera.yaml").camera.rate_hz,
                   camera_.rate_hz / 5);
}

TEST_F(RenderSequence, ScanNetsLayoutHoldsWhatWasSeen) {
  rendered("scannet-frames", "s", {.threads = 2});
  const RenderedFrame exact = shutter_->expose(5).seen;
  const auto read = [&](const char* file) {
    return cv::imread((folder_ / "s" / file).string(), cv::IMREAD_UNCHANGED);
  };
  const cv::Mat depth = read("depth/5.png"), label = read("label-filt/5.png"),
                instance = read("instance-filt/5.png"), color = read("color/5.jpg");
  ASSERT_EQ(depth.type(), CV_16UC1);
  ASSERT_EQ(label.type(), CV_16UC1);
  ASSERT_EQ(color.size(), cv::Size(64, 48));
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(label.at<std::uint16_t>(y, x), exact.classes(x, y));
      ASSERT_EQ(instance.at<std::uint16_t>(y, x), exact.instances(x, y));
      ASSERT_NEAR(depth.at<std::uint16_t>(y, x) / 1000.0, exact.depth_m(x, y), 0.00051);
    }
  std::ifstream pose(folder_ / "s" / "pose" / "5.txt");
  const SE3& truth = shutter_->path()[5].world_from_camera;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      double value = 0;
      ASSERT_TRUE(pose >> value);
      const double wanted = row == 3      ? (column == 3 ? 1.0 : 0.0)
                            : column == 3 ? truth.translation()[row]
                                          : truth.rotation()(row, column);
      EXPECT_NEAR(value, wanted, 1e-8);
    }
  double fx = 0;
  std::ifstream(folder_ / "s" / "intrinsic" / "intrinsic_depth.txt") >> fx;
  EXPECT_EQ(fx, 50);
  EXPECT_EQ(read_file(folder_ / "s" / "scannetv2-labels.combined.tsv"), label_table_text());
  std::vector<std::string> notes;
  const auto back = open_scannet(folder_ / "s", notes);
  EXPECT_TRUE(notes.empty()) << notes[0];
  const SemanticImage seen = back->frame(5, RandomStream()).semantics;
  ASSERT_FALSE(seen.index.empty());
  EXPECT_EQ(seen.at(32, 24).most_probable(), exact.classes(32, 24));
  EXPECT_THROW(make_sequence_writer("kitti", folder_, camera_), InputError);
}

}  // namespace
}  // namespace mh
