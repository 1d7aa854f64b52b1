// SPDX-License-Identifier: Apache-2.0
// A run gives the same results on a simulated tour and on a recording of that tour.
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/run/one/run_one.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/recordings/class_map.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "slam/core/digest.hpp"
#include "source_dir.hpp"
#include "tests/bench/changed_frames.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFrames = 62;

World built(const RunSpec& spec) {
  return build_world(spec, 1, Cache(MH_TEST_CACHE), [](std::string_view) {});
}

/// How a recording changes a frame: depth is rounded to a 16-bit file, and an image of classes does
/// not distinguish objects of the same class.
void as_recorded(RgbdFrame& frame) {
  for (float& depth_m : frame.depth_m)
    depth_m = static_cast<float>(depth_units(depth_m) / kDepthPerMeter);
  const Grid2d<ClassId> classes = class_image(frame.semantics);
  Grid2d<std::uint16_t> ids(classes.width(), classes.height());
  std::ranges::copy(classes.data(), classes.data() + classes.size(), ids.data());
  frame.semantics = one_hot(ids, nullptr);
}

TEST(RecordedTour, GivesTheBitsOfTheSimulationWhereThatHasNoNoise) {
  const Suite ci = load_suite(MH_SOURCE_DIR "/bench/suites/ci.yaml", {.trials = 1});
  RunSpec spec = expand(ci).front();
  spec.system = {SystemKind::kSemantic, "semantic", {}};
  spec.labels = LabelMode::kExact;
  spec.level.file = MH_SOURCE_DIR "/sim/sensors/levels/ideal.yaml";
  spec.max_frames = kFrames;
  spec.environment.query_tour.reset();
  const World simulated = built(spec);
  const RunTools tools = {.occupancy = false};
  const RunResult drawn =
      run_one(spec,
              testing_support::with_changed_frames(
                  simulated, [](std::size_t, RgbdFrame& frame) { as_recorded(frame); }),
              tools);

  const fs::path folder = fs::temp_directory_path() / fmt::format("mh_recorded_tour_{}", getpid());
  TumWriter writer(folder, simulated.mapping->camera());
  for (std::size_t i = 0; i < kFrames; ++i) {
    ExactFrame frame{.seen = simulated.mapping->frame(i, RandomStream(5).fork(i)),
                     .classes = {},
                     .instances = {},
                     .world_from_camera = (*simulated.mapping->truth())[i].world_from_camera};
    frame.classes = class_image(frame.seen.semantics);
    frame.instances = Grid2d<InstanceId>(frame.classes.width(), frame.classes.height());
    writer.add(i, frame);
  }
  writer.finish();
  RunSpec of_recording = spec;
  of_recording.environment = {};
  of_recording.environment.name = "recorded";
  of_recording.environment.sequence = "tum:" + folder.string();
  of_recording.level = {.file = kRecordedLevel, .of_recordings = true};
  of_recording.labels = LabelMode::kRecorded;
  const RunResult read = run_one(of_recording, built(of_recording), {.occupancy = false});
  fs::remove_all(folder);

  EXPECT_EQ(digest(read.estimate), digest(drawn.estimate));
  EXPECT_EQ(read.estimate.size(), drawn.estimate.size());
  ASSERT_EQ(read.mapping.calls.size(), drawn.mapping.calls.size());
  for (std::size_t i = 0; i < read.mapping.calls.size(); ++i) {
    EXPECT_EQ(read.mapping.calls[i].image_digest, drawn.mapping.calls[i].image_digest) << i;
    EXPECT_EQ(read.mapping.calls[i].pose_digest, drawn.mapping.calls[i].pose_digest) << i;
  }
  EXPECT_NEAR(read.trajectory.ate_rmse_m.value(), drawn.trajectory.ate_rmse_m.value(), 1e-6);
  const auto& asked = read.points.front().held_out;
  ASSERT_EQ(asked.size(), test_frames(kFrames, spec.protocol).size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    EXPECT_EQ(asked[i].answer.pose_digest, drawn.points.front().held_out[i].answer.pose_digest);
    EXPECT_EQ(asked[i].correct, drawn.points.front().held_out[i].correct);
  }
}

}  // namespace
}  // namespace mh
