// SPDX-License-Identifier: Apache-2.0
// Systems in shared libraries: a small one in C99 that does as its settings file says.
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <clocale>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/protocol/mapping.hpp"
#include "bench/protocol/query.hpp"
#include "bench/systems/library.hpp"
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
            .mode = OutsideMode::kLibrary,
            .folder = TINY_FOLDER,
            .library = "lib" + name + ".so"};
  }
  std::unique_ptr<System> make(const OutsideProgram& program) const {
    return make_library_system(program, camera_, 0, folder_ / "log");
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
  /// Of loading it.
  std::string load_error(const std::string& name) const {
    return error_of([&] { make(library(name)); });
  }
  /// Of mapping a frame, freezing and a query with one word of misbehavior.
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
  EXPECT_EQ(report.inliers, 2) << "sessions";
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
  EXPECT_EQ(error("anew"), "gave up a map that must not change any more, in relocalize");
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
  EXPECT_EQ(load_error("nothing"), "cannot be loaded: no such file, in loading");
  EXPECT_EQ(load_error("tiny_nameless"),
            "has no function mh_make_system: is it extern \"C\"?, in loading");
  EXPECT_EQ(load_error("tiny_of_tomorrow"),
            "was built with version 99 of modelhouse/system.h, the bench has version 1, in "
            "mh_make_system");
  EXPECT_EQ(load_error("tiny_throwing"), "let an exception escape: no camera, in mh_make_system");
  std::ofstream(folder_ / "libtext.so") << "no library";
  OutsideProgram text = library("text");
  text.folder = folder_;
  const std::string what = error_of([&] { make(text); });
  EXPECT_TRUE(what.starts_with("cannot be loaded: ")) << what;
  EXPECT_EQ(what.find(folder_.string()), std::string::npos) << "the same in any folder: " << what;
  EXPECT_EQ(error("null"),
            fmt::format("made no system: no vocabulary for {} classes, in mh_make_system",
                        classes().size()));
  EXPECT_EQ(error("empty"), "left the function relocalize empty, in mh_make_system");
  text.library.clear();
  EXPECT_THROW(make(text), InputError);
}

TEST_F(LibrarySystems, ThatMisbehaveFailWithOneLine) {
  EXPECT_EQ(error(""), "no error");
  EXPECT_EQ(error("error"), "reported an error (7): no memory?left, in track");
  EXPECT_EQ(error("speechless"), "reported an error (7), in track");
  EXPECT_EQ(error("nan"),
            "gave a pose of [nan, 0, 0, 0, 0, 0, 1]: a number is not finite, in track");
  EXPECT_EQ(error("far"),
            "gave a pose more than 1e+08 m away: [-1000000000, 0, 0, 0, 0, 0, 1], in track");
  EXPECT_EQ(error("norm"), "gave a pose whose quaternion has norm 2, in track");
  EXPECT_EQ(error("count"), "gave inliers of -2: expected a count, in track");
  EXPECT_EQ(error("stage"),
            "gave a pose and the stage \"pnp\", which is one of failure, in relocalize");
  EXPECT_EQ(error("candidates"),
            "gave candidates of 2 after 1: a step cannot leave more than the one before it, in "
            "relocalize");
  EXPECT_EQ(error("trajectory twice"),
            "gave two poses at 0.000000007 in its trajectory, in trajectory");
  EXPECT_EQ(error("trajectory unseen"),
            "gave a pose at 0.000000099 in its trajectory, a frame that it never saw, in "
            "trajectory");
}

TEST_F(LibrarySystems, PrintToTheLogAndNotToTheBench) {
  testing::internal::CaptureStdout();
  {
    const auto system = tiny("print");
    system->track(fake_frame(7, RandomStream(1)), RandomStream(2));
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(read_file(folder_ / "log"), "0.5\n~nonsense\ngoodbye\n");
}

TEST_F(LibrarySystems, LeaveTheProcessAsItWas) {
  const auto before = std::filesystem::current_path();
  const std::string locale = std::setlocale(LC_ALL, nullptr);
  const mode_t mask = umask(022);
  const auto system = tiny("wander");
  system->track(fake_frame(7, RandomStream(1)), RandomStream(2));
  EXPECT_EQ(std::filesystem::current_path(), before);
  EXPECT_EQ(std::setlocale(LC_ALL, nullptr), locale);
  EXPECT_EQ(umask(mask), 022U);
}

TEST_F(LibrarySystems, LeaveTheFloatingPointModeAsItWas) {
  load_error("tiny_throwing");
  const volatile double least = std::numeric_limits<double>::min();
  EXPECT_GT(least / 2, 0) << "what is very small counts as zero";
}

TEST_F(LibrarySystems, AbortWithTheirProcess) {
  EXPECT_EXIT(error("crash"), testing::KilledBySignal(SIGABRT), "");
}

}  // namespace
}  // namespace mh
