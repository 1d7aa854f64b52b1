// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/sheets.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "bench/lab/sensor_factors.hpp"

namespace mh {
namespace {

constexpr Rgb8 kBelow = {90, 150, 210}, kAbove = {10, 20, 30};

/// One color for views that look down, and a different one for views that look up.
class DownOrUp : public Renderer {
 public:
  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    const int w = camera.width_px, h = camera.height_px;
    const bool down = world_from_camera.rotation()(2, 2) < 0;
    return {Grid2d<Rgb8>(w, h, down ? kBelow : kAbove), Grid2d<float>(w, h, 2.0F),
            Grid2d<ClassId>(w, h, ClassId{1}), Grid2d<InstanceId>(w, h, InstanceId{1})};
  }
};

// Before any effect is applied, a tile shows the rendered image; objects stand on the floor, so the
// view looks down.
TEST(SensorSheets, BeginWithWhatTheRendererDrawsOfAViewThatLooksDown) {
  Scene scene;
  scene.rooms.push_back({"room", {{0, 0}, {4, 0}, {4, 4}, {0, 4}}});
  const SensorSheets sheets = draw_sensor_sheets(scene, std::make_shared<DownOrUp>());
  const cv::Vec3b drawn(kBelow.b, kBelow.g, kBelow.r);
  const cv::Point first_tile(224, 240), first_frame(84, 135);  // centers of the tile and the frame
  EXPECT_EQ(sheets.color.at<cv::Vec3b>(first_tile), drawn);
  EXPECT_EQ(sheets.frames.at<cv::Vec3b>(first_frame), drawn);
}

TEST(SensorFactors, OfDepthSwitchOnWhatTheyName) {
  const std::vector<Factor> factors = depth_factors();
  const auto of = [&](std::size_t factor) {
    SensorConfig config = everything_off();
    factors.at(factor).settings[1](config);
    return config.depth_noise;
  };
  EXPECT_TRUE(of(0).axial && !of(0).lateral);
  EXPECT_TRUE(of(1).quantization && !of(1).axial);
  EXPECT_TRUE(of(2).lateral && !of(2).axial);
  EXPECT_TRUE(of(3).projector_shadow && !of(3).lateral);
  EXPECT_TRUE(of(4).grazing_holes && !of(4).lateral);
  EXPECT_EQ(of(5).min_range_m, 0.4);
  EXPECT_TRUE(of(7).axial && of(7).lateral && !of(7).projector_shadow);
}

}  // namespace
}  // namespace mh
