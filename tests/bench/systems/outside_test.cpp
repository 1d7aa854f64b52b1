// SPDX-License-Identifier: Apache-2.0
// The example odometry as an outside system, in both modes, over a rendered room.
#include <unistd.h>

#include <filesystem>
#include <map>
#include <utility>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "bench/protocol/metrics/trajectory_score.hpp"
#include "bench/protocol/query.hpp"
#include "bench/protocol/score.hpp"
#include "bench/protocol/streams.hpp"
#include "bench/systems/conversation.hpp"
#include "bench/systems/recorded_run.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "scenes/vocabulary_rooms/vocabulary_rooms.hpp"
#include "sim/sensors/sense.hpp"
#include "slam/core/digest.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/files.hpp"
#include "tests/slam/core/made_sequence.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A camera that looks around and sways in a furnished room, with sensor noise.
class OutsideOdometry : public testing::Test {
 protected:
  static constexpr std::size_t kCount = 90;  // test frames are 29, 59, 89: 87 are offered

  static void SetUpTestSuite() {
    const Scene scene = make_training_room(3);
    renderer_ = make_embree_renderer(scene);
    const SE3 middle = training_views(scene, 5, 1).front();
    for (std::size_t i = 0; i < kCount; ++i) {
      const double t = 2 * 3.14159265358979 * static_cast<double>(i) / kCount;
      const SE3 sway(
          so3_exp({0.05 * std::sin(2 * t), 0.4 * std::sin(t), 0}),
          Eigen::Vector3d(0.2 * std::sin(t), 0.03 * std::sin(2 * t), 0.1 * (1 - std::cos(t))));
      path_.push_back({static_cast<Stamp>(i) * 33'333'333, middle * sway});
    }
  }
  static void TearDownTestSuite() {
    renderer_.reset();
    made_.clear();
  }

  OutsideOdometry() : folder_(fs::temp_directory_path() / ("mh_vo_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~OutsideOdometry() override { fs::remove_all(folder_); }

  static Camera camera() {
    Camera c;
    c.width_px = 320;
    c.height_px = 240;
    c.fx_px = c.fy_px = 280;
    c.cx_px = 159.5;
    c.cy_px = 119.5;
    return c;
  }
  /// A frame; frames are made once for all tests.
  static RgbdFrame frame(std::size_t index, RandomStream noise) {
    RgbdFrame& made = made_[{index, noise.key()}];
    if (made.color.empty()) made = make_frame(index, noise);
    return made;
  }
  static RgbdFrame make_frame(std::size_t index, RandomStream noise) {
    const RenderedFrame exact = renderer_->render(camera(), path_[index].world_from_camera);
    RgbdFrame seen = sense(exact, camera(), {}, noise.fork(index), path_[index].stamp_ns);
    seen.semantics = label_image(exact, LabelMode::kExact);
    return seen;
  }
  static MadeSequence frames() { return {kCount, frame, camera()}; }
  std::unique_ptr<System> converse() const {
    return make_conversation_system(
        {.name = "vo", .command = "exec " VO_CONVERSE, .mode = OutsideMode::kConversation},
        camera(), 0, folder_ / "log");
  }
  std::unique_ptr<System> load() const {
    return make_conversation_system(
        {.name = "vo", .mode = OutsideMode::kConversation, .library = VO_LIBRARY}, camera(), 0,
        folder_ / "log");
  }
  static std::unique_ptr<System> mapped(std::unique_ptr<System> system) {
    map_sequence(*system, frames(), {}, RandomStream(1));
    system->freeze();
    return system;
  }

  static inline std::unique_ptr<Renderer> renderer_;
  static inline Trajectory path_;
  static inline std::map<std::pair<std::size_t, std::uint64_t>, RgbdFrame> made_;
  fs::path folder_;
};

TEST(FrameFiles, AreReadByOpenCvPixelForPixel) {
  const fs::path folder = fs::temp_directory_path() / ("mh_frame_" + std::to_string(getpid()));
  fs::create_directories(folder);
  RgbdFrame frame;
  frame.color = Grid2d<Rgb8>(3, 2, Rgb8{1, 2, 3});
  frame.color(2, 1) = {200, 100, 50};
  frame.depth_m = Grid2d<float>(3, 2, 0.0F);
  frame.depth_m(1, 0) = 1.2345F;  // 6172.5 units
  frame.depth_m(2, 1) = 20.0F;    // beyond what 16 bits hold
  EXPECT_TRUE(image_files(frame).labels.empty());
  frame.semantics = {Grid2d<std::uint8_t>(3, 2), {{}, {{{5, 0.3F}, {7, 0.6F}}}}};
  frame.semantics.index(0, 1) = 1;
  const FrameFiles files = image_files(frame);
  const auto read = [&](const char* name, const std::string& content) {
    write_atomically(folder / name, content);
    return cv::imread((folder / name).string(), cv::IMREAD_UNCHANGED);
  };
  const cv::Mat color = read("color.ppm", files.color), depth = read("depth.pgm", files.depth),
                labels = read("labels.pgm", files.labels);
  fs::remove_all(folder);
  ASSERT_EQ(color.type(), CV_8UC3);
  EXPECT_EQ(color.at<cv::Vec3b>(1, 2), cv::Vec3b(50, 100, 200));
  ASSERT_EQ(depth.type(), CV_16UC1);
  EXPECT_NEAR(depth.at<std::uint16_t>(0, 1), 6172.5, 0.6);
  EXPECT_EQ(depth.at<std::uint16_t>(1, 2), 65535);
  EXPECT_EQ(depth.at<std::uint16_t>(1, 1), 0);
  ASSERT_EQ(labels.type(), CV_8UC1);
  EXPECT_EQ(labels.at<std::uint8_t>(1, 0), 7);  // the most probable class
  EXPECT_EQ(labels.at<std::uint8_t>(0, 0), kVoid);
}

/// Two small frames with the other data that systems get besides images.
class OtherSenses : public testing::Test {
 protected:
  OtherSenses() {
    fs::create_directories(folder_);
    camera_.width_px = 64, camera_.height_px = 48, camera_.cx_px = 31.5, camera_.cy_px = 23.5;
    camera_.fx_px = camera_.fy_px = 52;
    first_.stamp_ns = 1'000'000'000;
    first_.color = Grid2d<Rgb8>(64, 48);
    first_.depth_m = Grid2d<float>(64, 48);
    second_ = first_;
    second_.stamp_ns = 1'010'000'000;
  }
  ~OtherSenses() override { fs::remove_all(folder_); }

  /// All requests to a program that always answers that it is lost.
  std::string asked() const {
    const std::string program =
        "n=0; while read -r line; do n=$((n+1)); printf '%s\\n' \"$line\" >>" +
        (folder_ / "asked").string() +
        "; if [ $n = 1 ]; then echo '{\"id\":1,\"protocol\":1}'; else echo "
        "\"{\\\"id\\\":$n,\\\"pose\\\":null}\"; fi; done";
    {
      const auto system = make_conversation_system(
          {.name = "told", .command = program, .mode = OutsideMode::kConversation}, camera_, 0,
          folder_ / "log");
      EXPECT_FALSE(system->track(first_, RandomStream(1)).world_from_camera);
      system->track(second_, RandomStream(2));
    }
    return read_file(folder_ / "asked");
  }
  /// Writes a data set with only the first frame or with both.
  fs::path dataset(std::size_t frames) const {
    const fs::path folder = folder_ / std::to_string(frames);
    write_dataset(folder, camera_, frames,
                  [&](std::size_t i) { return std::optional(i == 0 ? first_ : second_); });
    return folder;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("mh_senses_" + std::to_string(getpid()));
  Camera camera_;
  RgbdFrame first_, second_;
};

TEST_F(OtherSenses, OdometryIsToldInAConversationAndWrittenIntoADataset) {
  second_.odom_from_camera =
      SE3(Eigen::Quaterniond(0.6, 0, 0, 0.8), Eigen::Vector3d(0.5, -0.25, 1));
  const std::string said = asked();
  const std::size_t told = said.find(R"("odometry":[0.5,-0.25,1.0,0.0,0.0,0.8)");
  ASSERT_NE(told, std::string::npos) << said;
  EXPECT_EQ(said.find("odometry"), told + 1) << "the first frame has none";
  const Trajectory odometry =
      parse_trajectory(read_file(dataset(2) / "odometry.txt"), "odometry.txt");
  ASSERT_EQ(odometry.size(), 1U);
  EXPECT_EQ(odometry[0].stamp_ns, second_.stamp_ns);
  EXPECT_LT((odometry[0].world_from_camera.inverse() * *second_.odom_from_camera).log().norm(),
            1e-6);
  EXPECT_FALSE(fs::exists(dataset(1) / "odometry.txt"));
}

TEST_F(OtherSenses, InertialReadingsAreToldInAConversationAndWrittenIntoADataset) {
  second_.imu = {{1'005'000'000, {0.5, -0.25, 0}, {0, -9.75, 0.125}},
                 {1'010'000'000, {0.25, 0, 1}, {1, -9.5, 0}}};
  const std::string said = asked();
  EXPECT_NE(said.find(R"("imu":[["1.005000000",0.5,-0.25,0.0,0.0,-9.75,0.125],)"
                      R"(["1.010000000",0.25,0.0,1.0,1.0,-9.5,0.0]])"),
            std::string::npos)
      << said;
  EXPECT_EQ(read_file(dataset(2) / "imu.csv"),
            "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
            "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
            "1005000000,0.5,-0.25,0,0,-9.75,0.125\n1010000000,0.25,0,1,1,-9.5,0\n");
  EXPECT_FALSE(fs::exists(dataset(1) / "imu.csv"));
}

TEST_F(OtherSenses, ScansAreToldInAConversationAndWrittenIntoADataset) {
  second_.lasers = {{.name = "front",
                     .camera_from_laser = SE3(Eigen::Matrix3d::Identity(), {0.5, -0.25, 0}),
                     .first_rad = -0.5,
                     .step_rad = 0.25,
                     .min_range_m = 0.125,
                     .max_range_m = 3.5,
                     .ranges_m = {1.5F, 0, 3.25F}}};
  const std::string said = asked();
  EXPECT_NE(said.find(R"("lasers":[{"name":"front","camera_from_laser":[0.5,-0.25,0.0,0.0,0.0,0.0,)"
                      R"(1.0],"first_rad":-0.5,"step_rad":0.25,"limits_m":[0.125,3.5],)"
                      R"("ranges_m":[1.5,0.0,3.25]}])"),
            std::string::npos)
      << said;
  const std::string lines = read_file(dataset(2) / "lasers.txt");
  EXPECT_EQ(lines.substr(lines.find('\n') + 1),
            "1.010000000 front 0.5 -0.25 0 0 0 0 1 -0.5 0.25 0.125 3.5 1.5 0 3.25\n");
  EXPECT_FALSE(fs::exists(dataset(1) / "lasers.txt"));
}

TEST(SettingsText, HasRealNumbersWhereReadersInsistOnThem) {
  const cv::FileStorage settings(settings_text(Camera{}), cv::FileStorage::READ |
                                                              cv::FileStorage::MEMORY |
                                                              cv::FileStorage::FORMAT_YAML);
  for (const char* key : {"Camera.fx", "Camera.cy", "Camera.k1", "Camera.bf", "DepthMapFactor",
                          "ThDepth", "ORBextractor.scaleFactor"})
    EXPECT_TRUE(settings[key].isReal()) << key;
  EXPECT_EQ(settings["Camera.fx"].real(), Camera{}.fx_px);
  EXPECT_TRUE(settings["Camera.width"].isInt());
  EXPECT_EQ(static_cast<int>(settings["ORBextractor.nFeatures"]), 1000);
}

TEST_F(OutsideOdometry, GoesThroughTheWholeProtocol) {
  const auto system = converse();
  const MappingOutcome mapping = map_sequence(*system, frames(), {}, RandomStream(1));
  system->freeze();
  EXPECT_EQ(mapping.failures, 0);
  const Trajectory estimate = system->trajectory();
  const TrajectoryScore score = score_trajectory(estimate, path_, mapping.offered);
  EXPECT_EQ(score.completeness, 1.0);
  ASSERT_TRUE(score.ate_rmse_m);
  EXPECT_LT(*score.ate_rmse_m,
            0.05);  // odometry drifts: it never corrects earlier poses; the camera sways by 0.4 m
  EXPECT_GT(*score.ate_rmse_m, 1e-6);  // there is noise: no system can be this accurate

  for (const std::size_t index : test_frames(kCount, {})) {
    const QueryAnswer answer = query(*system, index, frames(), {}, RandomStream(2));
    EXPECT_EQ(answer.blank_frames, 1);
    EXPECT_GE(answer.candidates.keyframes, 2);
    EXPECT_GE(answer.candidates.final, 1);
    const QueryScore q =
        mh::score(answer, path_[index],
                  nearest_mapped(estimate, path_, path_[index], NearestBy::kTime), SE3(), {});
    EXPECT_TRUE(q.correct) << index << ": " << q.distance_m.value_or(-1);
  }
}

TEST_F(OutsideOdometry, AnswersDependOnNoOtherQuery) {
  const auto system = mapped(converse());
  const auto ask = [&](std::initializer_list<std::size_t> order) {
    std::map<std::size_t, std::uint64_t> poses;
    for (const std::size_t index : order)
      poses[index] = query(*system, index, frames(), {}, RandomStream(2)).pose_digest;
    return poses;
  };
  const auto forwards = ask({29, 59, 89});
  EXPECT_EQ(forwards, ask({89, 29, 59}));
  EXPECT_NE(forwards.at(29), forwards.at(59));
}

TEST_F(OutsideOdometry, ALibraryAnswersWithTheBitsOfTheConversation) {
  const auto asked = converse(), called = load();
  const MappingOutcome a = map_sequence(*asked, frames(), {}, RandomStream(1));
  const MappingOutcome b = map_sequence(*called, frames(), {}, RandomStream(1));
  ASSERT_EQ(a.calls.size(), 87U);
  for (std::size_t i = 0; i < a.calls.size(); ++i) {
    EXPECT_EQ(a.calls[i].pose_digest, b.calls[i].pose_digest) << i;
    EXPECT_EQ(a.calls[i].matching_digest, b.calls[i].matching_digest) << i;
    EXPECT_EQ(a.calls[i].keyframe_added, b.calls[i].keyframe_added) << i;
  }
  asked->freeze();
  called->freeze();
  EXPECT_EQ(digest(asked->trajectory()), digest(called->trajectory()));
  for (const std::size_t index : test_frames(kCount, {})) {
    const QueryAnswer x = query(*asked, index, frames(), {}, RandomStream(2)),
                      y = query(*called, index, frames(), {}, RandomStream(2));
    EXPECT_TRUE(x.world_from_camera);
    EXPECT_EQ(x.pose_digest, y.pose_digest) << index;
    EXPECT_EQ(x.matching_digest, y.matching_digest) << index;
    EXPECT_EQ(x.candidates, y.candidates) << index;
  }
  asked->finish();
  called->finish();
}

TEST_F(OutsideOdometry, RewindKeepsTheMapAndResetForgetsIt) {
  const auto system = converse();
  const RandomStream stream(1);
  for (std::size_t i = 0; i < 20; ++i) system->track(frame(i, stream), stream);
  system->rewind();
  const auto again = system->track(frame(12, stream), stream);
  ASSERT_TRUE(again.world_from_camera);
  EXPECT_NE(again.candidates, Candidates{}) << "it was lost, so that it had to relocalize";
  EXPECT_GT(again.world_from_camera->translation().norm(), 0.05);
  EXPECT_EQ(system->trajectory().size(), 20u);
  system->reset();
  EXPECT_TRUE(system->trajectory().empty());
  const auto anew = system->track(frame(12, stream), stream);
  ASSERT_TRUE(anew.world_from_camera);
  EXPECT_EQ(anew.world_from_camera->translation().norm(), 0.0);
}

TEST_F(OutsideOdometry, BothModesGiveOneTrajectoryAndTheTruthStaysOutside) {
  // What mapping shows if nothing fails: every frame except the test frames, once.
  std::vector<std::size_t> offered;
  for (std::size_t i = 0; i < kCount; ++i)
    if (!is_test_frame(i, {})) offered.push_back(i);
  const RandomStream noise = mapping_noise(RandomStream(1), 0);
  const std::vector<Stamp> stamps =
      write_dataset(folder_ / "given" / "dataset", camera(), offered.size(),
                    [&](std::size_t k) { return frame(offered[k], noise); });
  OutsideProgram program{.name = "vo"};
  // `find` prints the names of all files that the program gets; its standard output becomes the
  // log.
  program.command =
      "find {dataset} && " VO_RUN_DATASET " {dataset} {associations} {settings} {trajectory}";
  std::size_t read = 0;
  const Trajectory recorded =
      run_on_dataset(program, folder_ / "given", stamps, 0, folder_ / "outside.log",
                     [&](std::size_t so_far) { read = so_far; });
  EXPECT_EQ(read, 87u) << "how far it is, in frames";
  EXPECT_EQ(recorded.size(), 87u);
  EXPECT_LT(*score_trajectory(recorded, path_, offered.size()).ate_rmse_m, 0.05);
  EXPECT_EQ(digest(recorded), digest(mapped(converse())->trajectory()));

  const std::string given = read_file(folder_ / "outside.log");
  for (const char* part : {"/rgb.txt", "/depth.txt", "/label.txt", "/associations.txt",
                           "/camera.yaml", "/rgb/0.000000000.png", "/label/0.000000000.png"})
    EXPECT_NE(given.find(part), std::string::npos) << part;
  for (const char* part :
       {"truth", "instance", "/0.966666657.png"})  // the last one is a test frame
    EXPECT_EQ(given.find(part), std::string::npos) << part;
}

// The camera sees nothing for 15 frames, so wheel odometry that drifts by 1 % has to give its pose.
// The odometry runs as a library, in conversation and on a data set.
TEST_F(OutsideOdometry, FallsBackOnTheWheels) {
  const auto wheeled = [](std::size_t i, RandomStream noise) {
    RgbdFrame shown = frame(i, noise);
    if (i >= 40 && i < 55) {
      shown.color = Grid2d<Rgb8>(camera().width_px, camera().height_px, {90, 90, 90});
      shown.depth_m = Grid2d<float>(camera().width_px, camera().height_px);
    }
    Vector6d drift = Vector6d::Zero();
    drift[0] = 0.01 * path_[i].world_from_camera.translation().norm();
    shown.odom_from_camera = SE3::exp(Vector6d::Constant(0.3)) *
                             path_.front().world_from_camera.inverse() *
                             path_[i].world_from_camera * SE3::exp(drift);
    return shown;
  };
  const auto digest_of = [&](std::unique_ptr<System> system) {
    ProtocolConfig config;
    config.on_failure = OnFailure::kContinue;
    const MappingOutcome mapping =
        map_sequence(*system, MadeSequence(kCount, wheeled, camera()), config, RandomStream(1));
    EXPECT_EQ(std::ranges::count(mapping.calls, 0, &MappedFrame::inliers), 1 + 15)
        << "the first frame, and those that show nothing";
    system->freeze();
    const Trajectory estimate = system->trajectory();
    const TrajectoryScore score = score_trajectory(estimate, path_, 87);
    EXPECT_EQ(score.completeness, 1.0);
    EXPECT_LT(score.ate_rmse_m.value_or(1), 0.06);
    return digest(estimate);
  };
  EXPECT_EQ(digest_of(load()), digest_of(converse()));

  std::vector<std::size_t> offered;
  for (std::size_t i = 0; i < kCount; ++i)
    if (!is_test_frame(i, {})) offered.push_back(i);
  const std::vector<Stamp> stamps = write_dataset(
      folder_ / "given" / "dataset", camera(), offered.size(),
      [&](std::size_t k) { return wheeled(offered[k], mapping_noise(RandomStream(1), 0)); });
  OutsideProgram program{.name = "vo"};
  program.command = VO_RUN_DATASET " {dataset} {associations} {settings} {trajectory}";
  const Trajectory recorded = run_on_dataset(program, folder_ / "given", stamps, 0,
                                             folder_ / "outside.log", [](std::size_t) {});
  EXPECT_EQ(recorded.size(), 87U);
  EXPECT_LT(score_trajectory(recorded, path_, 87).ate_rmse_m.value_or(1), 0.06);
}

}  // namespace
}  // namespace mh
