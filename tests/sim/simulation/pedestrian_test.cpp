// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/pedestrian.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "sim/simulation/simulated_sequence.hpp"
#include "slam/io/error.hpp"
#include "tests/sim/scene_builder.hpp"

namespace mh {
namespace {

constexpr Stamp kSecond = 1'000'000'000;

const Pedestrian kPedestrian{
    .path_m = {{1, 0}, {3, 0}, {3, 1}}, .speed_m_per_s = 0.5, .start_s = 2};

TEST(Pedestrian, HeWaitsThenGoesToAndFroAtOneSpeed) {
  const auto at = [](double s) {
    const SE3 pose = world_from_pedestrian(kPedestrian, static_cast<Stamp>(s * 1e9));
    return pose.translation();
  };
  EXPECT_NEAR((at(0) - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((at(2) - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((at(4) - Eigen::Vector3d(2, 0, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((at(7) - Eigen::Vector3d(3, 0.5, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((at(8) - Eigen::Vector3d(3, 1, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((at(9) - Eigen::Vector3d(3, 0.5, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((at(14) - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-9);
  for (double s = 2; s < 30; s += 0.1)
    EXPECT_LE((at(s + 0.1) - at(s)).norm(), 0.05 + 1e-9) << s;  // never faster
}

TEST(Pedestrian, HeFacesTheWayHeGoes) {
  const auto forward = [](double s) {
    return world_from_pedestrian(kPedestrian, static_cast<Stamp>(s * 1e9)).rotation().col(0).eval();
  };
  EXPECT_NEAR(forward(4).x(), 1, 1e-9);
  EXPECT_NEAR(forward(7).y(), 1, 1e-9);
  EXPECT_NEAR(forward(9).y(), -1, 1e-9);
  EXPECT_NEAR(forward(11).x(), -1, 1e-9);
}

TEST(Pedestrian, BadFilesAreNamed) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("mh_pedestrian_" + std::to_string(getpid()) + ".yaml");
  for (const char* text :
       {"path: [[1, 2]]", "path: [[1, 2], [1, 2]]", "path: [[1, 2], [3, 4]]\nspeed_m_per_s: 0",
        "path: [[1, 2], [3, 4]]\nsped: 1", "path: [[1, 2], [3]]"}) {
    std::ofstream(file) << text;
    EXPECT_THROW(load_pedestrian(file), InputError) << text;
  }
  std::ofstream(file) << "path: [[1, 2], [3, 4]]";
  EXPECT_EQ(load_pedestrian(file).path_m.size(), 2u);
  std::filesystem::remove(file);
}

TEST(Pedestrian, HasAPersonsSize) {
  const Scene scene = build_pedestrian({1, 1, 1});
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(classes()[scene.instances[0].class_id].name, "person");
  const Eigen::Vector3f &low = scene.instances[0].min_m, &high = scene.instances[0].max_m;
  EXPECT_NEAR(low.z(), 0, 1e-3);
  EXPECT_NEAR(high.z(), kPedestrianHeight_m, 1e-3);
  EXPECT_NEAR(high.y(), kPedestrianRadius_m, 2e-3);
  EXPECT_LT(high.x(), high.y());
  EXPECT_EQ(scene.light.size(), scene.positions_m.size());
  for (const Eigen::Vector3f& light : scene.light) {
    EXPECT_GE(light.minCoeff(), 0.6F - 1e-4F);
    EXPECT_LE(light.maxCoeff(), 1.4F + 1e-4F);
  }
}

/// A camera at a height of 1 m, looking along x at a wall 5 m away, and a pedestrian who crosses
/// its view 3 m away.
class PedestrianSceneTest : public testing::Test {
 protected:
  PedestrianSceneTest() {
    scene_ = test::plain_scene({120, 120, 120});
    test::add_quad(scene_, {5, -9, -9}, {0, 18, 0}, {0, 0, 18}, 5, 1);
    renderer_ = make_embree_renderer(scene_);
    camera_.width_px = 320, camera_.height_px = 240;
    camera_.fx_px = camera_.fy_px = 240;
    camera_.cx_px = 159.5, camera_.cy_px = 119.5;
    Eigen::Matrix3d rotation;  // camera z along world x, y down
    rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    world_from_camera_ = {rotation, {0, 0, 1}};
  }
  Scene scene_;
  std::shared_ptr<const Renderer> renderer_;
  Camera camera_;
  SE3 world_from_camera_;
};

TEST_F(PedestrianSceneTest, HeHidesWhatIsBehindHimAndNothingElseChanges) {
  const PedestrianScene pedestrian_scene(scene_, renderer_, 1.0F,
                                         {.path_m = {{3, -2}, {3, 2}}, .speed_m_per_s = 1});
  const RenderedFrame empty = renderer_->render(camera_, world_from_camera_);
  const RenderedFrame seen = pedestrian_scene.at(2 * kSecond)->render(camera_, world_from_camera_);
  EXPECT_EQ(pedestrian_scene.at(2 * kSecond)->render_depth(camera_, world_from_camera_),
            seen.depth_m);
  const std::vector<Eigen::Vector2i> pixel = {{camera_.width_px / 2, camera_.height_px / 2}};
  EXPECT_EQ(pedestrian_scene.at(2 * kSecond)->depth_at(camera_, world_from_camera_, pixel)[0],
            seen.depth_m(pixel[0].x(), pixel[0].y()));
  // The pedestrian is on the axis, seen from the side: 2 * 0.65 * 0.22 m wide at chest height.
  const ClassId person = *class_by_name("person");
  EXPECT_EQ(seen.classes(159, 119), person);
  EXPECT_EQ(seen.instances(159, 119), 2);
  EXPECT_NEAR(seen.depth_m(159, 119), 3.0F - 0.2F, 0.05F);
  int top = 240, pixels = 0, broadest = 0;
  for (int y = 0; y < 240; ++y) {
    int row = 0;
    for (int x = 0; x < 320; ++x) {
      if (seen.classes(x, y) == person) {
        ++row, ++pixels;
        top = std::min(top, y);
        EXPECT_EQ(seen.instances(x, y), 2);
      } else {
        EXPECT_EQ(seen.color(x, y), empty.color(x, y));
        EXPECT_EQ(seen.depth_m(x, y), empty.depth_m(x, y));
        EXPECT_EQ(seen.instances(x, y), empty.instances(x, y));
      }
    }
    broadest = std::max(broadest, row);
  }
  EXPECT_NEAR(top, 119.5 - 240 * (kPedestrianHeight_m - 1) / 3, 3);
  EXPECT_NEAR(broadest, 240 * 2 * 0.65 * kPedestrianRadius_m / 3, 3);
  EXPECT_GT(pixels, 2000);
}

TEST_F(PedestrianSceneTest, HeIsHiddenByWhatIsBeforeHim) {
  const PedestrianScene pedestrian_scene(scene_, renderer_, 1.0F,
                                         {.path_m = {{7, -2}, {7, 2}}, .speed_m_per_s = 1});
  const RenderedFrame empty = renderer_->render(camera_, world_from_camera_);
  const RenderedFrame seen = pedestrian_scene.at(2 * kSecond)->render(camera_, world_from_camera_);
  EXPECT_TRUE(std::equal(seen.depth_m.begin(), seen.depth_m.end(), empty.depth_m.begin()));
  EXPECT_TRUE(std::equal(seen.classes.begin(), seen.classes.end(), empty.classes.begin()));
}

TEST_F(PedestrianSceneTest, HeMovesWithTimeAndIsTheSameBitsAtTheSameTime) {
  const PedestrianScene pedestrian_scene(scene_, renderer_, 1.0F,
                                         {.path_m = {{3, -2}, {3, 2}}, .speed_m_per_s = 1});
  const auto left_edge = [&](Stamp stamp) {
    const RenderedFrame seen = pedestrian_scene.at(stamp)->render(camera_, world_from_camera_);
    for (int x = 0; x < 320; ++x)
      if (seen.instances(x, 119) == 2) return x;
    return -1;
  };
  EXPECT_EQ(left_edge(2 * kSecond), left_edge(2 * kSecond));
  // Half a second is half a meter, which is 40 px at 3 m; +y is to the left.
  EXPECT_NEAR(left_edge(2 * kSecond) - left_edge(2 * kSecond + kSecond / 2), 40, 2);
}

TEST_F(PedestrianSceneTest, ASequenceShowsHimWhereHeIsAtEachStamp) {
  const auto pedestrian_scene = std::make_shared<const PedestrianScene>(
      scene_, renderer_, 1.0F, Pedestrian{.path_m = {{3, -2}, {3, 2}}, .speed_m_per_s = 1});
  const std::vector<TimedPose> path = {{0, world_from_camera_}, {2 * kSecond, world_from_camera_}};
  const auto person = [&](std::size_t i, std::shared_ptr<const PedestrianScene> who) {
    const SimulatedSequence sequence(renderer_, camera_, path, SensorConfig{}, LabelMode::kExact,
                                     std::move(who));
    const RgbdFrame frame = sequence.frame(i, RandomStream(1));
    return frame.semantics.at(159, 119).most_probable() == *class_by_name("person") &&
           std::abs(frame.depth_m(159, 119) - 2.8F) < 0.1F;
  };
  EXPECT_FALSE(person(0, pedestrian_scene));  // 2 m to the side, outside the image
  EXPECT_TRUE(person(1, pedestrian_scene));
  EXPECT_FALSE(person(1, nullptr));
}

}  // namespace
}  // namespace mh
