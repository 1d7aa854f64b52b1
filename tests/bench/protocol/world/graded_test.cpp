// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/world/graded.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "bench/protocol/world/visible_surface.hpp"
#include "scenes/load.hpp"
#include "sim/motion/handheld_scan.hpp"
#include "sim/motion/motion.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/travel.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

const std::string kScenarios = std::string(MH_SOURCE_DIR) + "/bench/scenarios/";

/// A furnished room, a robot, and the poses from which it mapped the room.
struct Room {
  Scene scene = load_scene(kScenarios + "room.yaml");
  std::shared_ptr<const Renderer> renderer = make_embree_renderer(scene);
  Robot robot = load_robot(kScenarios + "robot.yaml");
  Trajectory mapped;

  Room() {
    const Trajectory path = travel(scene, robot, kScenarios + "tours/room.yaml").camera;
    for (std::size_t i = 0; i < path.size(); i += 5) mapped.push_back(path[i]);
  }
  GradedPlace place(bool handheld = false) const {
    return {.queried = scene,
            .mapped_renderer = renderer,
            .queried_renderer = renderer,
            .robot = robot,
            .offered = mapped,
            .handheld = handheld};
  }
};
const Room& room() {
  static const Room room;
  return room;
}

const GradedSpec kSpec{.distance_m = {0, 0.5, 1}, .angle_deg = {0, 20, 45}, .per_bin = 3};

TEST(Graded, EachCellGetsItsNumberOfViewsThatAreSoFarAway) {
  const GradedQueries drawn = draw_graded(kSpec, room().place());
  ASSERT_EQ(drawn.cells.size(), 4u);
  std::size_t asked = 0;
  for (const GradedCell& cell : drawn.cells) asked += cell.asked;
  EXPECT_EQ(drawn.list.size(), asked);
  EXPECT_EQ(drawn.cells[0].asked, 3u);
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> found;
  for (const GradedQuery& query : drawn.list) {
    ASSERT_EQ(query.clip.size(), 1u) << "a robot at rest";
    const QueryGrade grade = grade_of(room().mapped, query.clip[0].world_from_camera);
    EXPECT_EQ(grade.mapped_m, query.grade.mapped_m);
    EXPECT_EQ(grade.mapped_deg, query.grade.mapped_deg);
    EXPECT_GE(*query.grade.shown, kSpec.least_shown);
    EXPECT_FALSE(query.grade.speed);
    ++found[{bin_of(kSpec.distance_m, *grade.mapped_m),
             bin_of(kSpec.angle_deg, *grade.mapped_deg)}];
  }
  for (const GradedCell& cell : drawn.cells)
    EXPECT_EQ((found[{cell.distance, cell.angle}]), cell.asked);
}

TEST(Graded, AreAFunctionOfTheSeed) {
  const auto first = [](std::uint64_t seed) {
    GradedSpec spec = kSpec;
    spec.seed = seed;
    return draw_graded(spec, room().place()).list.front().clip[0].world_from_camera.translation();
  };
  EXPECT_EQ(first(0), first(0));
  EXPECT_NE(first(0), first(1));
}

TEST(Graded, OfHandheldScansAreTheSamePosesAtEachSpeed) {
  GradedSpec spec = kSpec;
  spec.distance_m = {0, 2};
  spec.angle_deg = {0, 90};
  spec.speed = {1, 3};
  const GradedQueries drawn = draw_graded(spec, room().place(true));
  ASSERT_EQ(drawn.list.size(), 6u);
  for (std::size_t i = 0; i < drawn.list.size(); i += 2) {
    const GradedQuery &slow = drawn.list[i], &fast = drawn.list[i + 1];
    EXPECT_EQ(slow.grade.speed, 1);
    EXPECT_EQ(fast.grade.speed, 3);
    EXPECT_EQ(slow.clip[slow.at].world_from_camera.translation(),
              fast.clip[fast.at].world_from_camera.translation());
    if (slow.at == 0 || fast.at == 0) continue;  // the first frame of a scan: no frame is before it
    const auto before_s = [](const GradedQuery& q) {
      return 1e-9 * static_cast<double>(q.clip[q.at].stamp_ns - q.clip[q.at - 1].stamp_ns);
    };
    EXPECT_NEAR(before_s(slow), 3 * before_s(fast), 1e-6);
  }
}

TEST(Graded, ViewsThatTheMapCannotShowAreCountedAndNotAsked) {
  GradedSpec spec = kSpec;
  spec.distance_m = {0, 4};
  spec.angle_deg = {90, 180};
  spec.per_bin = 2;
  spec.least_shown = 1.0;
  GradedPlace place = room().place();
  const Trajectory one{room().mapped.front()};
  const GradedPlace little{.queried = place.queried,
                           .mapped_renderer = place.mapped_renderer,
                           .queried_renderer = place.queried_renderer,
                           .robot = place.robot,
                           .offered = one};
  const GradedQueries drawn = draw_graded(spec, little);
  EXPECT_GT(drawn.cells[0].hidden, 100u) << "one view shows hardly all that one behind it sees";
  EXPECT_TRUE(drawn.list.empty());
}

TEST(Graded, TheNearestMappedViewIsByMetersAndRadians) {
  const auto pose = [](double x, double yaw_rad) {
    return SE3(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
               Eigen::Vector3d(x, 0, 0));
  };
  const Trajectory mapped{{0, pose(0, 0)}, {1, pose(1, 1)}};
  const QueryGrade turned =
      grade_of(mapped, pose(0.2, 1));  // 0.2 m + 1 rad to the first, 0.8 m + 0 rad to the second
  EXPECT_NEAR(*turned.mapped_m, 0.8, 1e-12);
  EXPECT_NEAR(*turned.mapped_deg, 0, 1e-5);
  const QueryGrade near = grade_of(mapped, pose(0.1, 0.2));
  EXPECT_NEAR(*near.mapped_m, 0.1, 1e-12);
  EXPECT_NEAR(*near.mapped_deg, 0.2 * 180 / std::numbers::pi, 1e-5);
  EXPECT_FALSE(grade_of({}, pose(0, 0)).mapped_m);
}

TEST(Graded, FramesAreOfTheirMomentsAndHaveATruth) {
  const GradedQueries drawn = draw_graded(kSpec, room().place());
  const GradedSequence sequence(room().renderer, room().robot.camera, drawn.list, {},
                                LabelMode::kExact);
  ASSERT_EQ(sequence.size(), drawn.list.size());
  ASSERT_EQ(sequence.truth()->size(), drawn.list.size());
  const RgbdFrame frame = sequence.frame(1, RandomStream(1));
  EXPECT_EQ(frame.stamp_ns, sequence.stamp_ns(1));
  EXPECT_EQ((*sequence.truth())[1].stamp_ns, sequence.stamp_ns(1));
  const RenderedFrame exact =
      room().renderer->render(room().robot.camera, drawn.list[1].clip[0].world_from_camera);
  EXPECT_NEAR(frame.depth_m(20, 20), exact.depth_m(20, 20), 0.05);  // differs by noise
  EXPECT_GT(sequence.stamp_ns(1), sequence.stamp_ns(0));
}

TEST(VisibleSurface, APathShowsAllOfItsOwnViewsAndNothingBehindIt) {
  const Trajectory one{room().mapped.front()};
  const VisibleSurface shown(room().renderer, room().robot.camera, one);
  const SE3& here = one.front().world_from_camera;
  EXPECT_GT(shown.share(*room().renderer, here), 0.98);
  const SE3 back =
      here * SE3(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY()).toRotationMatrix(),
                 Eigen::Vector3d::Zero());
  EXPECT_LT(shown.share(*room().renderer, back), 0.02);
  const SE3 aside = here * SE3(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix(),
                               Eigen::Vector3d::Zero());
  const double half = shown.share(*room().renderer, aside);
  EXPECT_GT(half, 0.3);
  EXPECT_LT(half, 0.9);
}

}  // namespace
}  // namespace mh
