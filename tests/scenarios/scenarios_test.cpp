// SPDX-License-Identifier: Apache-2.0
// Each scenario of the gate exists to catch a fault. Here the fault is introduced, and the gate
// must fail on the measures that the suite judges, in the scenario named after it, while the same
// run without the fault passes.
#include <gtest/gtest.h>

#include <algorithm>

#include "bench/results/gate/from_runs.hpp"
#include "bench/results/gate/gate.hpp"
#include "bench/results/gate/report.hpp"
#include "bench/run/one/run_one.hpp"
#include "bench/systems/builtin.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "slam/config/slam.hpp"
#include "slam/core/labels.hpp"
#include "source_dir.hpp"
#include "tests/bench/changed_frames.hpp"

namespace mh {
namespace {

const Suite& ci() {
  static const Suite suite = load_suite(MH_SOURCE_DIR "/bench/suites/ci.yaml", {.trials = 1});
  return suite;
}

RunSpec first_run(const std::string& scenario, SystemKind system) {
  for (RunSpec& spec : expand(ci()))
    if (spec.environment.name == scenario && spec.system.kind == system) return spec;
  throw std::runtime_error("no such scenario: " + scenario);
}

struct Fault {
  std::function<void(SlamConfig&)> settings = [](SlamConfig&) {};
  testing_support::FrameChange frame = {};
};

RunFigures run(const RunSpec& spec, const World& world, const Fault& fault) {
  RunTools tools;
  tools.occupancy = false;  // no measure of the gate uses it
  tools.system = [&](const RunSpec&, const World&) {
    SlamConfig config;
    config = spec.slam;
    fault.settings(config);
    return make_builtin_system(world.mapping->camera(), config, world.vocabulary);
  };
  return figures(run_one(spec, testing_support::with_changed_frames(world, fault.frame), tools));
}

/// The gate's judgment of a fault: a run with one seed without the fault against the same run with
/// it.
GateResult judge(const std::string& scenario, const Fault& fault,
                 SystemKind system = SystemKind::kPlain) {
  const RunSpec spec = first_run(scenario, system);
  // Baked light is shared by all tests; its key covers scene and code.
  const World world = build_world(spec, 1, Cache(MH_TEST_CACHE), [](std::string_view) {});
  const std::vector before = {run(spec, world, {})};
  const std::vector after = {run(spec, world, fault)};
  GateResult result = compare(before, after, ci().gate, false);
  EXPECT_TRUE(compare(before, before, ci().gate, true).passed());
  EXPECT_EQ(result.runs, 1u);
  std::printf("%s", gate_report(result, scenario).c_str());
  return result;
}

bool worse(const GateResult& result, std::string_view measure) {
  for (const Change& c : result.changes)
    if (c.measure->name == measure) return c.verdict == ChangeVerdict::kWorse;
  return false;
}

// Accepts a match even if the second best is just as good, and even if it does not fit the pose.
void accept_everything(SlamConfig& c) {
  c.match.ratio = c.match.ratio_projection = 1.0;
  c.pose.chi2_mono = c.pose.chi2_stereo = 1e6;
}

// Where all things look the same, the second best match is as good as the best.
TEST(Scenario, WoodenRepetitionCatchesThatLookAlikesAreNotToldApart) {
  const GateResult result = judge("wooden_repetition", {.settings = accept_everything});
  EXPECT_FALSE(result.passed());
}

TEST(Scenario, BlankCorridorCatchesACornerThresholdThatIsTooHighForIt) {
  const GateResult result = judge("blank_corridor", {.settings = [](SlamConfig& c) {
                                    c.features.fast_threshold = c.features.fast_threshold_low = 60;
                                  }});
  EXPECT_FALSE(result.passed());
}

TEST(Scenario, FastTurnCatchesFramesThatDoNotArrive) {
  Fault fault;
  fault.frame = [](std::size_t index, RgbdFrame& frame) {
    if (index % 4 == 0) return;
    std::fill(frame.color.begin(), frame.color.end(), Rgb8{});
    std::fill(frame.depth_m.begin(), frame.depth_m.end(), 0.0F);
  };
  EXPECT_FALSE(judge("fast_turn", fault).passed());
}

TEST(Scenario, KidnappedRobotCatchesThatNothingRelocalizes) {
  const GateResult result = judge(
      "kidnapped_robot", {.settings = [](SlamConfig& c) { c.relocalize.min_inliers = 1'000'000; }});
  EXPECT_TRUE(worse(result, "completeness"));
}

TEST(Scenario, MovedFurnitureCatchesThatOutliersAreNotRejected) {
  const GateResult result = judge("moved_furniture", {.settings = [](SlamConfig& c) {
                                    accept_everything(c);
                                    c.bundle.chi2_mono = c.bundle.chi2_stereo = 1e6;
                                  }});
  EXPECT_FALSE(result.passed());
}

TEST(Scenario, LightsChangedCatchesThatExposureControlFails) {
  Fault fault;
  fault.frame = [](std::size_t, RgbdFrame& frame) {
    const auto dark = [](std::uint8_t v) { return static_cast<std::uint8_t>(v / 6); };
    for (Rgb8& c : frame.color) c = {dark(c.r), dark(c.g), dark(c.b)};
  };
  EXPECT_FALSE(judge("lights_changed", fault).passed());
}

TEST(Scenario, LabelNoiseCatchesScrambledLabels) {
  Fault fault;
  fault.frame = [](std::size_t index, RgbdFrame& frame) {
    auto& palette = frame.semantics.palette;
    if (!palette.empty())
      std::rotate(palette.begin(),
                  palette.begin() + static_cast<std::ptrdiff_t>(1 + 7 * index % palette.size()) %
                                        static_cast<std::ptrdiff_t>(palette.size()),
                  palette.end());
  };
  const GateResult result = judge("label_noise", fault, SystemKind::kSemantic);
  EXPECT_TRUE(worse(result, "penalized"));
}

// The error is too small to show up in a room; over a loop of 14 m, it adds up to some centimeters.
TEST(Scenario, LongLoopCatchesADepthThatReadsThreePercentTooLong) {
  Fault fault;
  fault.frame = [](std::size_t, RgbdFrame& frame) {
    for (float& depth_m : frame.depth_m) depth_m *= 1.03F;
  };
  EXPECT_TRUE(worse(judge("long_loop", fault), "ate_rmse_m"));
}

TEST(Scenario, WalkingPersonCatchesThatOutliersAreNotRejected) {
  const GateResult result =
      judge("walking_person",
            {.settings = [](SlamConfig& c) { c.pose.chi2_mono = c.pose.chi2_stereo = 1e6; }});
  EXPECT_FALSE(result.passed());
}

TEST(Scenario, APedestrianOfTheQueriesWalksInTheSecondTourAlone) {
  RunSpec spec = first_run("walking_person", SystemKind::kSemantic);
  Environment& e = spec.environment;
  e.query_tour = e.mapping_tour;
  std::swap(e.query_pedestrian, e.pedestrian);
  spec.max_frames = 90;
  const World world = build_world(spec, 1, Cache(MH_TEST_CACHE), [](std::string_view) {});
  const auto frames_with_a_person = [](const Sequence& sequence) {
    const ClassId person = class_by_name("person").value();
    int count = 0;
    for (std::size_t i = 0; i < sequence.size(); i += 5) {
      const Grid2d<ClassId> seen = class_image(sequence.frame(i, RandomStream(1)).semantics);
      count += std::find(seen.begin(), seen.end(), person) != seen.end() ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(frames_with_a_person(*world.mapping), 0);
  EXPECT_GT(frames_with_a_person(*world.query_tour), 1);
}

}  // namespace
}  // namespace mh
