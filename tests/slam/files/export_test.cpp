// SPDX-License-Identifier: Apache-2.0
#include "slam/files/export.hpp"

#include <cstdio>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "slam/core/labels.hpp"

namespace mh {
namespace {

Keyframe keyframe_at(const Eigen::Vector3d& place, Stamp stamp_ns, int features) {
  Keyframe k;
  k.stamp_ns = stamp_ns;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  k.camera_from_world = SE3(turn, place).inverse();
  k.features.keypoints.resize(static_cast<std::size_t>(features));
  k.features.descriptors.resize(static_cast<std::size_t>(features));
  for (Keypoint& keypoint : k.features.keypoints) keypoint.label = *class_by_name("chair");
  return k;
}

/// Three keyframes, the middle one erased; the others share 15 landmarks at (i, -i / 2, 100 + i).
/// One more landmark is seen only from the first, and one is erased.
Map made_map() {
  Map map;
  map.add(keyframe_at({1, 2, 3}, 10, 20));
  map.add(keyframe_at({0, 0, 0}, 20, 1));
  map.add(keyframe_at({-4, 0.5, 0.25}, 30, 20));
  for (std::uint32_t i = 0; i < 15; ++i) {
    const LandmarkId id = map.add_landmark({1.0 * i, -0.5 * i, 100.0 + i}, KeyframeId{0}, i);
    map.add_observation(id, KeyframeId{2}, i);
    map.refresh(id, {});
  }
  map.add_landmark({7, 8, 9}, KeyframeId{0}, 17);
  map.erase(map.add_landmark({0, 0, 0}, KeyframeId{2}, 17));
  map.erase(KeyframeId{1});
  return map;
}

TEST(LandmarksPly, HoldsEachStandingLandmarkInTheOrderOfItsHeader) {
  const ClassInfo& chair = classes()[*class_by_name("chair")];
  const ClassInfo& unknown = classes()[kVoid];
  std::string rows;
  for (int i = 0; i < 15; ++i)
    rows += fmt::format("{} {} {} {} {} {} {} 2\n", i, i == 0 ? "-0" : fmt::format("{}", -0.5 * i),
                        100 + i, chair.r, chair.g, chair.b, chair.id);
  rows += fmt::format("7 8 9 {} {} {} 0 1\n", unknown.r, unknown.g, unknown.b);
  EXPECT_EQ(landmarks_ply(made_map()),
            "ply\nformat ascii 1.0\ncomment landmarks; meters; label: class id\n"
            "element vertex 16\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property uchar label\nproperty int observations\nend_header\n" +
                rows);
}

TEST(KeyframesPly, HoldsPlacesAndEdgesBetweenThem) {
  EXPECT_EQ(keyframes_ply(made_map()),
            "ply\nformat ascii 1.0\ncomment keyframes and what they share; meters\n"
            "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
            "property int landmarks\n"
            "element edge 1\nproperty int vertex1\nproperty int vertex2\nproperty int shared\n"
            "end_header\n1 2 3 16\n-4 0.5 0.25 15\n0 1 15\n");
}

TEST(KeyframesJson, HoldsIdsStampsAndPoses) {
  const std::string text = keyframes_json(made_map());
  for (const char* part :
       {"{\"id\": 0, \"stamp_ns\": 10, \"position_m\": [1, 2, 3], ",
        "{\"id\": 2, \"stamp_ns\": 30, \"position_m\": [-4, 0.5, 0.25], ", "\"landmarks\": 16}",
        "\"landmarks\": 15}", "\"edges\": [\n    {\"a\": 0, \"b\": 2, \"shared\": 15}\n  ]"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_EQ(text.find("\"id\": 1"), std::string::npos) << "an erased keyframe";
  // A quarter turn about z.
  const std::string key = "\"quaternion_xyzw\": [";
  double x = 1, y = 1, z = 0, w = 0;
  ASSERT_EQ(
      std::sscanf(text.c_str() + text.find(key) + key.size(), "%lf, %lf, %lf, %lf", &x, &y, &z, &w),
      4);
  EXPECT_NEAR(x, 0, 1e-15);
  EXPECT_NEAR(y, 0, 1e-15);
  EXPECT_NEAR(z, std::numbers::sqrt2 / 2, 1e-15);
  EXPECT_NEAR(w, std::numbers::sqrt2 / 2, 1e-15);
}

}  // namespace
}  // namespace mh
