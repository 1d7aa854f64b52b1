// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/contact_sheet.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "bench/report/drawing/false_colors.hpp"
#include "slam/core/labels.hpp"

namespace mh {
namespace {

constexpr Rgb8 kPaint{201, 13, 157};

/// Renders one color, one depth and one class in every direction, and records the poses that it is
/// asked for.
class Recorder : public Renderer {
 public:
  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    poses.push_back(world_from_camera);
    const int w = camera.width_px, h = camera.height_px;
    return {{w, h, kPaint}, {w, h, 2.0F}, {w, h, *class_by_name("chair")}, {w, h, 1}};
  }
  mutable std::vector<SE3> poses;
};

TEST(LookAt, PutsTheTargetInTheMiddleAndStandsUpright) {
  for (const auto& [eye, target] :
       {std::pair(Eigen::Vector3d(1, 2, 1.4), Eigen::Vector3d(4, -1, 0.3)),
        {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-3, 0, 2)}}) {
    const SE3 pose = look_at(eye, target);
    const Eigen::Vector3d seen = pose.inverse() * target;
    EXPECT_LT((seen - Eigen::Vector3d(0, 0, (target - eye).norm())).norm(), 1e-12);
    EXPECT_NEAR(pose.rotation()(2, 0), 0, 1e-12) << "the image's rows are level";
    EXPECT_LT(pose.rotation()(2, 1), 0) << "and run down";
    EXPECT_NEAR(pose.rotation().determinant(), 1, 1e-12);
  }
}

// A path of 100 frames is cut into parts of equal length: the middle frame of each part is taken.
TEST(ViewsAlong, AreTheMiddlesOfEqualParts) {
  Trajectory path;
  for (int i = 0; i < 100; ++i)
    path.push_back(
        {i, SE3(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Vector3d(0.1 * i, 0, 0))});
  const auto frames = [&](std::size_t count) {
    const Recorder renderer;
    std::vector<int> at;
    const std::vector<View> views = views_along(path, renderer, Camera{}, count);
    for (std::size_t k = 0; k < views.size(); ++k) {
      at.push_back(static_cast<int>(std::lround(10 * renderer.poses[k].translation().x())));
      EXPECT_EQ(views[k].caption, fmt::format("frame {}", at.back()));
    }
    return at;
  };
  EXPECT_EQ(frames(1), (std::vector{50}));
  EXPECT_EQ(frames(2), (std::vector{25, 75}));
  EXPECT_EQ(frames(5), (std::vector{10, 30, 50, 70, 90}));
  EXPECT_EQ(frames(6), (std::vector{8, 25, 41, 58, 75, 91}));
  EXPECT_TRUE(views_along({}, Recorder(), Camera{}, 3).empty());
}

// An L-shaped room whose arms meet in a square of 2 m: the view from each outer corner passes over
// the middle of that square in any orientation of the L, so no view faces a wall.
TEST(ViewsOf, LooksFromTheCornersOverThePlaceThatAllOfThemSee) {
  const std::vector<Eigen::Vector2d> outline = {{0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 5}, {0, 5}};
  const Eigen::Vector2d shared(1, 1);
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Eigen::Rotation2Dd turn(quarter * std::numbers::pi / 2);
    Scene scene;
    Room room;
    room.name = "corner room";
    for (const Eigen::Vector2d& p : outline) room.polygon_m.push_back(turn * p);
    scene.rooms = {room};
    const Recorder renderer;
    const std::vector<View> views = views_of(scene, renderer);
    ASSERT_EQ(views.size(), 2u) << "the two that show most";
    EXPECT_EQ(views[0].caption, "corner room");
    ASSERT_EQ(renderer.poses.size(), 5u) << "outer corners";
    std::size_t k = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      if (i == 3) continue;  // this corner of the L points inward
      const Eigen::Vector3d eye = renderer.poses[k].translation();
      const Eigen::Vector2d expected = turn * (shared + 0.8 * (outline[i] - shared));
      EXPECT_LT((eye.head<2>() - expected).norm(), 1e-9) << quarter << " " << i;
      const Eigen::Vector2d ahead = renderer.poses[k].rotation().col(2).head<2>().normalized();
      EXPECT_LT((ahead - (turn * shared - eye.head<2>()).normalized()).norm(), 1e-9);
      ++k;
    }
  }
}

// From left to right: color, depth, labels; below them the class in its color.
TEST(ContactSheet, ShowsColorDepthAndLabelsFromLeftToRight) {
  const View view{"one", {80, 60, kPaint}, {80, 60, 2.0F}, {80, 60, *class_by_name("chair")}};
  const cv::Mat image = draw_contact_sheet("title", {view, view});
  const Rgb8 chair = class_color(*class_by_name("chair"));
  const auto box_of = [&](const cv::Mat& part, Rgb8 c) {
    cv::Mat mask;
    const cv::Scalar bgr(c.b, c.g, c.r);
    cv::inRange(part, bgr, bgr, mask);
    std::vector<cv::Point> found;
    cv::findNonZero(mask, found);
    return found.empty() ? cv::Rect() : cv::Rect(cv::boundingRect(found));
  };
  const cv::Rect color = box_of(image, kPaint);
  ASSERT_GT(color.area(), 0);
  const cv::Mat rows = image.rowRange(color.y, color.y + color.height);
  const cv::Rect labels = box_of(rows, chair);
  EXPECT_NEAR(labels.width, color.width, 2);
  EXPECT_NEAR(labels.height, color.height, 2);
  EXPECT_GT(labels.x, color.x + 2 * color.width) << "the depth lies between";
  EXPECT_LT(labels.x, color.x + 2.2 * color.width);
  EXPECT_LE(labels.x + labels.width, image.cols - color.x + 2) << "margins are alike";
  const cv::Mat below = image.rowRange(color.y + color.height + 30, image.rows);
  EXPECT_GT(box_of(below, chair).area(), 50) << "the legend";
  const auto end_of_scale = [&](int column) {
    const cv::Vec3b bgr = depth_scale().at<cv::Vec3b>(0, column);
    return box_of(below, {bgr[2], bgr[1], bgr[0]});
  };
  const cv::Rect near = end_of_scale(0), far = end_of_scale(255);
  ASSERT_GT(near.area(), 0);
  ASSERT_GT(far.area(), 0);
  EXPECT_LT(near.x + color.width - 10, far.x + far.width) << "the scale is as wide as the depth";
  EXPECT_GT(near.x, color.x + color.width);
  EXPECT_LT(far.x + far.width, labels.x);
}

}  // namespace
}  // namespace mh
