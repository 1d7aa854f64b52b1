// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/map_score.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

using Eigen::Vector3d;

Instance instance(const char* name, ClassId class_id, const Vector3d& low, const Vector3d& high) {
  Instance made;
  made.name = name;
  made.class_id = class_id;
  made.min_m = low.cast<float>();
  made.max_m = high.cast<float>();
  return made;
}

MapObject found(ClassId class_id, const Vector3d& low, const Vector3d& high) {
  return {.name = "",
          .class_id = class_id,
          .center_m = 0.5 * (low + high),
          .min_m = low,
          .max_m = high};
}

TEST(ScoreObjects, EachTrueObjectIsFoundOnceAndEachFoundOneFindsOne) {
  Scene scene;
  scene.instances = {instance("chair", 5, {0, 0, 0}, {0.5, 0.5, 1}),
                     instance("other chair", 5, {0.6, 0, 0}, {1.1, 0.5, 1}),
                     instance("table", 7, {2, 0, 0}, {3, 1, 0.7}),
                     instance("vase", 46, {2.4, 0.4, 0.7}, {2.6, 0.6, 1.08}),
                     instance("wall", 1, {0, 3, 0}, {5, 3.1, 2.5})};
  const std::vector<MapObject> objects = {
      found(5, {0, 0, 0}, {0.55, 0.5, 1}),               // the first chair
      found(5, {0.05, 0, 0}, {0.5, 0.5, 1}),             // found twice
      found(7, {2.4, 0, 0}, {3, 1, 0.7}),                // 0.2 m off
      found(46, {2.35, 0.35, 0.7}, {2.65, 0.65, 1.15}),  // smaller in truth
      found(7, {8, 0, 0}, {9, 1, 0.7}),                  // there is none
      found(7, {8, 0, 0}, {8.2, 0.2, 0.2}),              // too small to count
  };
  const ObjectScore score = score_objects(objects, scene);
  EXPECT_EQ(score.recall.good, 2u);
  EXPECT_EQ(score.recall.all, 3u) << "no vase below 0.4 m, no wall";
  EXPECT_EQ(score.precision.good, 3u) << "chair, table and vase";
  EXPECT_EQ(score.precision.all, 5u);
}

}  // namespace
}  // namespace mh
