// SPDX-License-Identifier: Apache-2.0
// Systems in shared libraries: a small one in C99 that does what its settings file says.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/protocol/mapping.hpp"
#include "bench/protocol/query.hpp"
#include "bench/systems/conversation.hpp"
#include "bench/systems/outside_error.hpp"
#include "slam/core/labels.hpp"
#include "slam/io/files.hpp"
#include "tests/bench/protocol/fake_system.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class LibrarySystems : public testing::Test {
 protected:
  LibrarySystems()
      : folder_(fs::temp_directory_path() / ("mh_library_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    camera_.width_px = camera_.height_px = 2;
    camera_.cx_px = camera_.cy_px = 0.5;
  }
  ~LibrarySystems() override { fs::remove_all(folder_); }

  OutsideProgram library(const std::string& name) const {
    return {.name = "theirs",
            .mode = OutsideMode::kConversation,
            .folder = TINY_FOLDER,
            .library = "lib" + name + ".so"};
  }
  std::unique_ptr<System> make(const OutsideProgram& program) const {
    return make_conversation_system(program, camera_, 0, folder_ / "log");
  }
  std::unique_ptr<System> tiny(const std::string& words = "") const {
    OutsideProgram program = library("tiny");
    std::ofstream(folder_ / "settings") << words;
    program.settings = (folder_ / "settings").string();
    return make(program);
  }

  static std::string error_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const OutsideError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      const std::string whose = "outside library 'theirs' (lib";
      EXPECT_EQ(what.substr(0, whose.size()), whose);
      return what.substr(what.find(") ") + 2);
    } catch (const std::exception& error) {
      return std::string("another kind of error: ") + error.what();
    }
    return "no error";
  }
  /// The error of loading a library.
  std::string load_error(const std::string& name) const {
    return error_of([&] { make(library(name)); });
  }
  /// The error of mapping a frame, freezing and querying with this misbehavior.
  std::string error(const std::string& word) const {
    return error_of([&] {
      const auto system = tiny(word);
      system->track(fake_frame(7, RandomStream(1)), RandomStream(2));
      system->freeze();
      query(*system, 0, fake_frames(1), {}, RandomStream(3));
      system->finish();
    });
  }

  fs::path folder_;
  Camera camera_;
};

TEST_F(LibrarySystems, AreAskedFrameByFrame) {
  const auto system = tiny();
  RgbdFrame frame = fake_frame(7, RandomStream(1));
  frame.color(0, 0) = {5, 0, 0};
  frame.depth_m(0, 0) = 0.002F;  // 10 units
  SystemReport report = system->track(frame, RandomStream(2));
  EXPECT_EQ(report.status, TrackStatus::kTracked);
  EXPECT_EQ(report.world_from_camera->translation(), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(report.keypoints, 10'005);
  EXPECT_FALSE(report.inliers) << "the frame has no labels";
  EXPECT_TRUE(report.keyframe_added);
  EXPECT_FALSE(report.relocalization);
  EXPECT_EQ(report.candidates, Candidates{});
  frame.semantics = {Grid2d<std::uint8_t>(2, 2), {{{{5, 0.3F}, {7, 0.6F}}}}};
  frame.stamp_ns = 8;
  EXPECT_EQ(system->track(frame, RandomStream(2)).inliers, 7) << "the most probable class";
  frame.lasers = {{.name = "a",
                   .camera_from_laser = SE3(Eigen::Matrix3d::Identity(), {0, 2, 0}),
                   .max_range_m = 3,
                   .ranges_m = {0, 1.5F}}};
  EXPECT_EQ(system->track(frame, RandomStream(2)).keypoints, 'a' + 1500 + 20 + 3);
  EXPECT_EQ(system->trajectory().size(), 2U);
  system->reset();
  EXPECT_TRUE(system->trajectory().empty());
  report = system->track(frame, RandomStream(2));
  EXPECT_EQ(report.world_from_camera->translation().x(), 1);

  system->freeze();
  const auto first = system->open_session(), second = system->open_session();
  RgbdFrame blank = frame;
  blank.color = Grid2d<Rgb8>(2, 2);
  blank.depth_m = Grid2d<float>(2, 2);
  report = second->feed(blank, RandomStream(3));
  EXPECT_EQ(report.status, TrackStatus::kLost) << "it has no function for that";
  report = second->feed(frame, RandomStream(3));
  EXPECT_EQ(report.status, TrackStatus::kRelocalized);
  EXPECT_EQ(report.inliers, 1) << "a query begins with its first frame";
  EXPECT_EQ(report.relocalization, RelocalizationStage::kVerified);
  EXPECT_EQ(report.candidates.keyframes, 1);
  EXPECT_EQ(report.candidates.final, 1);
  EXPECT_FALSE(report.candidates.c1);
  system->finish();
}

TEST_F(LibrarySystems, GoThroughTheProtocolLostOrNot) {
  const auto tracked = [&](const std::string& words) {
    const auto system = tiny(words);
    EXPECT_EQ(map_sequence(*system, fake_frames(10), {}, RandomStream(1)).offered, 10U);
    system->freeze();
    EXPECT_EQ(query(*system, 0, fake_frames(1), {}, RandomStream(3)).world_from_camera.has_value(),
              words.empty());
    return system->trajectory().size();
  };
  EXPECT_EQ(tracked(""), 10U);
  EXPECT_EQ(tracked("lost"), 0U);
}

TEST_F(LibrarySystems, OfOneLibraryAreMadeAnewEachTime) {
  const auto first = tiny();
  first->track(fake_frame(7, RandomStream(1)), RandomStream(2));
  const auto second = tiny();
  EXPECT_EQ(second->track(fake_frame(7, RandomStream(1)), RandomStream(2))
                .world_from_camera->translation()
                .x(),
            1);
}

TEST_F(LibrarySystems, PosesInAMapThatWasGivenUpAreVoid) {
  const auto system = tiny("anew");
  for (const std::size_t i : {3, 5}) system->track(fake_frame(i, RandomStream(1)), RandomStream(2));
  ASSERT_EQ(system->trajectory().size(), 1U);
  EXPECT_EQ(system->trajectory()[0].stamp_ns, 5);
  EXPECT_EQ(error("anew"),
            "dropped a map that must not change any more, replying to relocalize (request 5)");
}

TEST_F(LibrarySystems, MayTellTheFinishedTrajectory) {
  const auto system = tiny("trajectory");
  for (const std::size_t i : {3, 5}) system->track(fake_frame(i, RandomStream(1)), RandomStream(2));
  system->freeze();
  const Trajectory t = system->trajectory();
  ASSERT_EQ(t.size(), 2U);
  EXPECT_EQ(t[1].stamp_ns, 5);
  EXPECT_EQ(t[1].world_from_camera.translation().x(), 4);
}

TEST_F(LibrarySystems, ThatCannotBeLoadedSayWhy) {
  const auto hello = [](const std::string& fault) {
    return "reported an error: \"" + fault + "\", replying to hello (request 1)";
  };
  EXPECT_TRUE(load_error("nothing").starts_with("reported an error: \"cannot be loaded: "));
  EXPECT_EQ(load_error("tiny_nameless"),
            hello("has no function mh_make_system: is it extern \\\"C\\\"?"));
  EXPECT_EQ(load_error("tiny_of_tomorrow"),
            hello("was built with version 99 of modelhouse/system.h, the bench has version 1"));
  EXPECT_EQ(load_error("tiny_throwing"), hello("let an exception escape: no camera"));
  std::ofstream(folder_ / "libtext.so") << "no library";
  OutsideProgram text = library("text");
  text.folder = folder_;
  const std::string what = error_of([&] { make(text); });
  EXPECT_TRUE(what.starts_with("reported an error: \"cannot be loaded: ")) << what;
  EXPECT_EQ(what.find(folder_.string()), std::string::npos) << "the same in any folder: " << what;
  EXPECT_EQ(error("null"), hello(fmt::format("created no system: no vocabulary for {} classes",
                                             classes().size())));
  EXPECT_EQ(error("empty"), hello("left the function relocalize empty"));
}

TEST_F(LibrarySystems, ThatMisbehaveFailWithOneLine) {
  EXPECT_EQ(error(""), "no error");
  EXPECT_EQ(error("error"),
            "reported an error: \"reported an error (7): no memory\\nleft\", replying to track "
            "(request 2)");
  EXPECT_EQ(error("speechless"),
            "reported an error: \"reported an error (7)\", replying to track (request 2)");
  EXPECT_EQ(
      error("nan"),
      "reported an error: \"gave a pose of [nan, 0, 0, 0, 0, 0, 1]: a number is not finite\", "
      "replying to track (request 2)");
  EXPECT_EQ(
      error("far"),
      "gave a pose more than 1e+08 m away: [-1000000000, 0, 0, 0, 0, 0, 1], replying to track "
      "(request 2)");
  EXPECT_EQ(error("norm"),
            "gave a pose whose quaternion has norm 2, replying to track (request 2)");
  EXPECT_EQ(error("count"), "gave inliers of -2: expected a count, replying to track (request 2)");
  EXPECT_EQ(error("stage"),
            "gave a pose and the stage \"pnp\", which is one of failure, replying to relocalize "
            "(request 5)");
  EXPECT_EQ(error("candidates"),
            "gave candidates of 2 after 1: a step cannot leave more than the one before it, "
            "replying to relocalize (request 5)");
  EXPECT_EQ(
      error("trajectory twice"),
      "gave a bad trajectory: trajectory:2: stamp: 0.000000007 does not come after 0.000000007, "
      "replying to freeze (request 3)");
  EXPECT_EQ(error("trajectory unseen"),
            "gave a pose at 0.000000099 in its trajectory, a frame that it never saw, replying to "
            "freeze (request 3)");
}

TEST_F(LibrarySystems, PrintToTheLogAndNotToTheBench) {
  testing::internal::CaptureStdout();
  {
    const auto system = tiny("print");
    system->track(fake_frame(7, RandomStream(1)), RandomStream(2));
    system->finish();
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_TRUE(read_file(folder_ / "log").ends_with("0.5\n~nonsense\ngoodbye\n"));
}

TEST_F(LibrarySystems, HaveAProcessAndLimitsOfTheirOwn) {
  EXPECT_EQ(error("crash"), "was killed by signal 6 during track (request 2)");
  EXPECT_EQ(error("exit"), "exited with code 0 during track (request 2)");
  OutsideProgram program = library("tiny");
  std::ofstream(folder_ / "settings") << "sleep";
  program.settings = (folder_ / "settings").string();
  program.reply_limit_s = 0.2;
  EXPECT_EQ(
      error_of([&] { make(program)->track(fake_frame(7, RandomStream(1)), RandomStream(2)); }),
      "did not reply to track (request 2) within 0.2 s");
}

}  // namespace
}  // namespace mh
