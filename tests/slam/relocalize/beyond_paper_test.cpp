// SPDX-License-Identifier: Apache-2.0
#include "slam/relocalize/beyond_paper.hpp"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace mh {
namespace {

/// Adds a square of 3 x 3 keypoints with a class.
void add_thing(Features& view, ClassId label, float u_px, float v_px, float side_px) {
  for (int i = 0; i < 9; ++i) {
    Keypoint k;
    k.u_px = u_px + side_px * static_cast<float>(i % 3 - 1) / 2;
    k.v_px = v_px + side_px * static_cast<float>(i / 3 - 1) / 2;
    k.label = label;
    view.keypoints.push_back(k);
    view.descriptors.emplace_back();
  }
}

TEST(SizeAgreement, IsTheRatioOfSizesWhereverThingsStandInTheImage) {
  Features near, far;
  add_thing(near, 5, 320, 240, 200);
  add_thing(far, 5, 100, 400, 50);
  EXPECT_NEAR(size_agreement(near, far), 0.25, 1e-6);
  EXPECT_NEAR(size_agreement(far, near), 0.25, 1e-6);
  EXPECT_NEAR(size_agreement(near, near), 1, 1e-12);
  // A second class of the same size, with an equal number of keypoints.
  add_thing(near, 7, 500, 100, 80);
  add_thing(far, 7, 200, 300, 80);
  EXPECT_NEAR(size_agreement(near, far), 0.5 * (0.25 + 1), 1e-6);
}

TEST(SizeAgreement, SaysNothingWithoutSharedClasses) {
  Features chair, table, unknown, few;
  add_thing(chair, 5, 320, 240, 200);
  add_thing(table, 7, 320, 240, 20);
  add_thing(unknown, kVoid, 320, 240, 20);
  add_thing(few, 5, 320, 240, 20);
  few.keypoints.resize(4);
  few.descriptors.resize(4);
  EXPECT_EQ(size_agreement(chair, table), 1);
  EXPECT_EQ(size_agreement(unknown, unknown), 1);
  EXPECT_EQ(size_agreement(chair, few), 1);
}

std::vector<Candidate<KeyframeId>> list(std::initializer_list<std::uint32_t> ids) {
  std::vector<Candidate<KeyframeId>> candidates;
  double score = 1;
  for (const std::uint32_t id : ids) candidates.push_back({KeyframeId{id}, score *= 0.9});
  return candidates;
}

std::vector<std::uint32_t> ids(const std::vector<Candidate<KeyframeId>>& candidates) {
  std::vector<std::uint32_t> result;
  for (const auto& candidate : candidates) result.push_back(candidate.keyframe.value);
  return result;
}

TEST(SideBySide, TakesTurnsAndNamesNobodyTwice) {
  using Ids = std::vector<std::uint32_t>;
  EXPECT_EQ(ids(side_by_side(list({4, 2, 9}), list({2, 7}))), Ids({4, 2, 7, 9}));
  EXPECT_EQ(ids(side_by_side(list({}), list({2, 7}))), Ids({2, 7}));
  EXPECT_EQ(ids(side_by_side(list({3, 1}), list({3, 1}))), Ids({3, 1}));
}

/// The agreement of a view in which every keypoint is matched with a landmark; pairs are (mapped
/// class, seen class).
double agreement(const std::vector<std::pair<ClassId, ClassId>>& pairs, std::size_t unmatched = 0) {
  Keyframe keyframe;
  keyframe.features.keypoints.resize(pairs.size());
  keyframe.features.descriptors.resize(pairs.size());
  keyframe.landmarks.resize(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i)
    keyframe.features.keypoints[i].label = pairs[i].first;
  Features view = keyframe.features;
  Map map;
  const KeyframeId id = map.add(keyframe);
  std::vector<LandmarkId> landmarks;
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    landmarks.push_back(map.add_landmark({0, 0, 2.0 + i}, id, i));
    map.refresh(landmarks.back(), {});
    view.keypoints[i].label = pairs[i].second;
  }
  for (std::size_t i = 0; i < unmatched; ++i) landmarks[pairs.size() - 1 - i] = LandmarkId{};
  return label_agreement(view, landmarks, map);
}

TEST(LabelAgreement, CountsMatchesOfKnownClassesAlone) {
  std::vector<std::pair<ClassId, ClassId>> pairs(8, {5, 5});
  pairs.insert(pairs.end(), {{5, kVoid}, {kVoid, 5}, {5, 6}});
  EXPECT_EQ(agreement(pairs), 1) << "nine are too few to tell";
  pairs.emplace_back(5, 6);
  EXPECT_DOUBLE_EQ(agreement(pairs), 0.8);
  pairs.emplace_back(5, 6);
  EXPECT_DOUBLE_EQ(agreement(pairs), 8.0 / 11);
  EXPECT_DOUBLE_EQ(agreement(pairs, 1), 0.8) << "a keypoint without a landmark is no match";
}

}  // namespace
}  // namespace mh
