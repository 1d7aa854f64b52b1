// SPDX-License-Identifier: Apache-2.0
#include "slam/core/camera.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "slam/io/error.hpp"

namespace mh {
namespace {

std::string complaint(const Camera& camera) {
  try {
    validate(camera);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Camera, EachNumberHasItsRangeAndIsNamedOutsideIt) {
  EXPECT_EQ(complaint({}), "");
  const auto with = [](auto member, auto value) {
    Camera camera;
    camera.*member = value;
    return complaint(camera);
  };
  for (const auto& [member, name] :
       {std::pair(&Camera::width_px, "width_px"), {&Camera::height_px, "height_px"}})
    for (const int bad : {0, -1})
      EXPECT_EQ(with(member, bad),
                std::string("camera: ") + name + " = " + std::to_string(bad) + " is out of range");
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = HUGE_VAL;
  for (const auto& [member, name] :
       {std::pair(&Camera::fx_px, "fx_px"), {&Camera::fy_px, "fy_px"}}) {
    for (const double good : {16.1, 639999.0}) EXPECT_EQ(with(member, good), "") << name;
    for (const double bad : {0.0, 1e-9, 15.9, 640001.0, -1.0, kNan, kInfinity})
      EXPECT_TRUE(with(member, bad).starts_with(std::string("camera: ") + name + " = ")) << bad;
  }
  for (const auto& [member, name] : {std::pair(&Camera::rate_hz, "rate_hz"),
                                     {&Camera::baseline_m, "baseline_m"},
                                     {&Camera::disparity_sigma_px, "disparity_sigma_px"}}) {
    EXPECT_EQ(with(member, std::numeric_limits<double>::min()), "") << name;
    for (const double bad : {0.0, -1.0, kNan, kInfinity, -kInfinity})
      EXPECT_TRUE(with(member, bad).starts_with(std::string("camera: ") + name + " = ")) << bad;
  }
  // The principal point is at most at the center of the last pixel.
  for (const auto& [member, name, last] :
       {std::tuple(&Camera::cx_px, "cx_px", 639.0), {&Camera::cy_px, "cy_px", 479.0}}) {
    for (const double good : {0.0, last}) EXPECT_EQ(with(member, good), "") << name;
    for (const double bad :
         {std::nextafter(0.0, -1.0), std::nextafter(last, 1e9), kNan, kInfinity, -kInfinity})
      EXPECT_TRUE(with(member, bad).starts_with(std::string("camera: ") + name + " = ")) << bad;
  }
  // An image of one pixel.
  Camera one;
  one.width_px = one.height_px = 1;
  one.cx_px = one.cy_px = 0;
  EXPECT_EQ(complaint(one), "");
}

// f = 500 and 400 px, center (320, 240): a point 0.4 m to the right, 0.5 m down and 2 m ahead.
TEST(Camera, ProjectsAsWorkedByHandAndBack) {
  Camera camera;
  camera.fx_px = 500, camera.fy_px = 400;
  camera.cx_px = 320, camera.cy_px = 240;
  camera.baseline_m = 0.06;
  const Eigen::Vector3d point(0.4, 0.5, 2);
  EXPECT_LT((camera.project(point) - Eigen::Vector2d(420, 340)).norm(), 1e-12);
  EXPECT_LT((camera.unproject(420, 340, 2) - point).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(camera.disparity_px(2), 15);
  for (const auto& [u, v, inside] : {std::tuple(0.0, 0.0, true),
                                     {639.0, 479.0, true},
                                     {-0.001, 5.0, false},
                                     {5.0, -0.001, false},
                                     {639.001, 5.0, false},
                                     {5.0, 479.001, false}})
    EXPECT_EQ(camera.in_image(u, v), inside) << u << " " << v;
}

TEST(Distortion, FiveCoefficientsAreBrownConradysBitForBit) {
  const Distortion d{.k1 = -0.3, .k2 = 0.1, .p1 = 0.002, .p2 = -0.001, .k3 = -0.01};
  for (double x = -0.6; x < 0.6; x += 0.07)
    for (double y = -0.5; y < 0.5; y += 0.09) {
      const double r2 = x * x + y * y;
      const double radial = 1 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
      const Eigen::Vector2d bent = d.distorted(x, y);
      EXPECT_EQ(bent.x(), x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x));
      EXPECT_EQ(bent.y(), y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y);
    }
}

TEST(Distortion, EightCoefficientsAreARationalOne) {
  const Distortion d{0.5, -2.7, 0.002, -0.0002, 1.5, 0.38, -2.5, 1.46};
  EXPECT_TRUE(d.is_rational());
  EXPECT_NEAR(d.radial(0.25),
              (1 + 0.5 / 4 - 2.7 / 16 + 1.5 / 64) / (1 + 0.38 / 4 - 2.5 / 16 + 1.46 / 64), 1e-15);
  const Eigen::Vector2d bent = d.distorted(0.3, -0.2), back = d.undistorted(bent.x(), bent.y());
  EXPECT_NEAR(back.x(), 0.3, 1e-9);
  EXPECT_NEAR(back.y(), -0.2, 1e-9);
  EXPECT_EQ(distortion_of(coefficients_of(d)), d);
  EXPECT_EQ(coefficients_of(distortion_of({0.1, 0, 0, 0})), (std::vector<double>{0.1, 0, 0, 0, 0}));
  EXPECT_FALSE(Distortion{.k6 = 0.1}.none());
  EXPECT_EQ(text_of({.k1 = 0.1}), "k1 0.1, k2 0, p1 0, p2 0, k3 0");
}

// A message may contain a file name in Latin-1 and is written to JSON.
TEST(InputError, MessagesAreLegible) {
  EXPECT_STREQ(InputError("rgb/b\xfcro.png: cannot be read").what(),
               "rgb/b?ro.png: cannot be read");
  EXPECT_STREQ(MachineError("\xff").what(), "?");
}

}  // namespace
}  // namespace mh
