// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bench/lab/scan_views.hpp"
#include "bench/report/drawing/false_colors.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/generate/grammar.hpp"
#include "scenes/load.hpp"
#include "sim/render/renderer.hpp"
#include "source_dir.hpp"
#include "tests/bench/report/drawing/color_vision.hpp"

namespace mh {
namespace {

TEST(Ciede2000, GivesThePublishedFigures) {
  EXPECT_NEAR(ciede2000({50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 1e-4);
  EXPECT_NEAR(ciede2000({50, 2.5, 0}, {50, 0, -2.5}), 4.3065, 1e-4);
  EXPECT_NEAR(ciede2000({50, 2.5, 0}, {73, 25, -18}), 27.1492, 1e-4);
  EXPECT_NEAR(ciede2000({60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}), 1.2644, 1e-4);
  EXPECT_NEAR(ciede2000({2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}), 0.9082, 1e-4);
}

TEST(ColorVision, RedAndGreenLookAlikeToSomeAndGraysLookTheSameToAll) {
  const auto visions = color_visions();
  for (const Eigen::Matrix3d& vision : visions)
    for (const std::uint8_t v : {0, 60, 128, 255})
      EXPECT_LT(ciede2000(seen_lab({v, v, v}, vision), seen_lab({v, v, v}, visions[0])), 0.5);
  const Rgb8 red{190, 60, 40}, green{110, 125, 40};
  EXPECT_GT(ciede2000(seen_lab(red, visions[0]), seen_lab(green, visions[0])), 40);
  EXPECT_LT(least_difference(red, green), 20);
}

/// Adds pairs of classes whose pixels touch in images of a scene.
void add_touching(const std::string& name, std::set<std::pair<ClassId, ClassId>>& touching) {
  Scene scene = load_scene(name);
  const auto renderer = make_renderer("embree", scene, {});
  Camera camera;
  camera.width_px = 160;
  camera.height_px = 120;
  camera.fx_px = camera.fy_px = 120;
  camera.cx_px = 79.5;
  camera.cy_px = 59.5;
  for (const SE3& pose : scan_views(scene, 0, 12)) {
    const auto classes = renderer->render(camera, pose).classes;
    for (int y = 0; y + 1 < classes.height(); ++y)
      for (int x = 0; x + 1 < classes.width(); ++x)
        for (const ClassId other : {classes(x + 1, y), classes(x, y + 1)})
          if (classes(x, y) != other)
            touching.insert({std::min(classes(x, y), other), std::max(classes(x, y), other)});
  }
}

TEST(ClassColor, ColorBlindPeopleCanTellClassesThatTouch) {
  std::set<std::pair<ClassId, ClassId>> touching;
  add_touching(std::string(MH_SOURCE_DIR) + "/scenes/model_house/house.yaml", touching);
  for (const Category& category : categories())
    add_touching(to_string({category.name, 0}), touching);
  EXPECT_GT(touching.size(), 200U);
  for (const auto& [a, b] : touching)
    EXPECT_GE(least_difference(class_color(a), class_color(b)), 10)
        << classes()[a].name << " and " << classes()[b].name;
}

}  // namespace
}  // namespace mh
