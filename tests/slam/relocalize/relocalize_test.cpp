// SPDX-License-Identifier: Apache-2.0
#include "slam/relocalize/relocalize.hpp"
#include "slam/config/slam.hpp"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"

namespace mh {
namespace {

AugmentedVector vector_of(std::vector<Label> labels, std::vector<std::uint32_t> words) {
  return augmented_vector(std::span<const Label>(labels), std::span<const std::uint32_t>(words),
                          1.0, [](std::uint32_t) { return 1.0; });
}

/// Keyframes that share no landmarks: each one is its own neighborhood.
Map map_of(const std::vector<AugmentedVector>& vectors) {
  Map map;
  for (const AugmentedVector& vector : vectors) {
    Keyframe keyframe;
    keyframe.words.vector = vector;
    map.add(std::move(keyframe));
  }
  return map;
}

// A query with labels {5, 6} and words {1, 2, 3, 4}. Keyframe 0 shares both labels and no word,
// keyframe 1 four words and no label, keyframe 2 one label and three words.
class SelectKeyframes : public testing::Test {
 protected:
  const AugmentedVector query_ = vector_of({5, 6}, {1, 2, 3, 4});
  const Map map_ = map_of({vector_of({5, 6}, {10, 11, 12, 13}), vector_of({7, 8}, {1, 2, 3, 4}),
                           vector_of({5, 8}, {1, 2, 3, 13})});
  std::vector<std::uint32_t> select(Overlap overlap, const AugmentedVector& query) const {
    std::vector<std::uint32_t> ids;
    const SemanticConfig config{.alpha = 0.8, .beta = 0.0, .overlap = overlap};
    for (const auto& candidate : select_keyframes(map_, query, config).candidates)
      ids.push_back(candidate.keyframe.value);
    std::sort(ids.begin(), ids.end());
    return ids;
  }
};

TEST_F(SelectKeyframes, OverlapDecidesWhatEquationThreeCounts) {
  using Ids = std::vector<std::uint32_t>;
  EXPECT_EQ(select(Overlap::kLabels, query_), Ids({0}));        // n = 2, -, 1
  EXPECT_EQ(select(Overlap::kWords, query_), Ids({1}));         // n = -, 4, 3: 3 is not above 3.2
  EXPECT_EQ(select(Overlap::kAugmented, query_), Ids({1, 2}));  // n = 2, 4, 4
}

TEST_F(SelectKeyframes, WithoutLabelsWordsAreCounted) {
  EXPECT_EQ(select(Overlap::kLabels, vector_of({}, {1, 2, 3, 4})), std::vector<std::uint32_t>({1}));
}

TEST_F(SelectKeyframes, ErasedKeyframesAreNoCandidates) {
  Map map = map_;
  map.erase(KeyframeId{1});
  const auto selection = select_keyframes(map, query_, {.overlap = Overlap::kWords});
  ASSERT_EQ(selection.candidates.size(), 1U);
  EXPECT_EQ(selection.candidates[0].keyframe, KeyframeId{2});
}

// The scores of the two lists have different scales: nearness reorders each list by itself, and
// never merges them.
TEST(ChooseCandidates, NearnessKeepsTheTurnsOfTwoLists) {
  const Map map = map_of({vector_of({5, 6}, {1, 2, 3, 13, 14, 15, 16, 17}),  // first by labels
                          vector_of({7, 8}, {1, 2, 3, 4})});  // first by words, scored higher
  const Features features;
  const FeatureGrid grid(features.keypoints, Camera{});
  WordIndex words;
  words.vector = vector_of({5, 6}, {1, 2, 3, 4});
  const auto chosen = [&](double nearness) {
    SlamConfig config;
    config.semantics.candidates = CandidateLists::kSideBySide;
    config.semantics.nearness = nearness;
    return choose_candidates(map, {features, grid, words}, config, nullptr).candidates;
  };
  for (const double nearness : {0.0, 2.0}) {  // no shared class has a size: every factor is 1
    const auto candidates = chosen(nearness);
    ASSERT_EQ(candidates.size(), 2u);
    EXPECT_EQ(candidates[0].keyframe, KeyframeId{0});
    EXPECT_EQ(candidates[1].keyframe, KeyframeId{1});
    EXPECT_LT(candidates[0].score, candidates[1].score);
  }
}

TEST(Relocalize, AnEmptyMapHasNoCandidate) {
  const Features features;
  const FeatureGrid grid(features.keypoints, Camera{});
  const WordIndex words;
  MatchCounts counts{};
  const auto result =
      relocalize({features, grid, words}, {Camera{}, SlamConfig{}, Map{}, counts}, RandomStream(1));
  EXPECT_EQ(result.stage, RelocalizationStage::kNoCandidate);
  EXPECT_FALSE(result.camera_from_world.has_value());
}

// As released, ORB-SLAM2 adds the score that an earlier query left in a neighbor (mRelocScore) if
// the neighbor shares words, but not enough of them: its answers depend on the order of the
// queries.
/// A keyframe with words 1 to 4 and its neighbor with words 4 to 7.
Map map_of_neighbors() {
  constexpr std::uint32_t kShared = 20;  // landmarks
  Map map;
  for (const auto& words : {std::vector<std::uint32_t>{1, 2, 3, 4}, {4, 5, 6, 7}}) {
    Keyframe keyframe;
    keyframe.features.keypoints.resize(kShared);
    keyframe.features.descriptors.resize(kShared);
    keyframe.words.vector = vector_of({}, words);
    map.add(std::move(keyframe));
  }
  for (std::uint32_t i = 0; i < kShared; ++i)
    map.add_observation(map.add_landmark({0, 0, 2}, KeyframeId{0}, i), KeyframeId{1}, i);
  map.update_covisibility(KeyframeId{0});
  return map;
}

TEST(StaleScores, OfNeighborsAreThoseOfEarlierQueries) {
  const Map map = map_of_neighbors();
  const AugmentedVector near_first = vector_of({}, {1, 2, 3, 4}),
                        near_second = vector_of({}, {5, 6, 7, 9});
  const SemanticConfig config{.alpha = 0.8, .beta = 0.0, .overlap = Overlap::kWords};
  const auto score = [&](StaleScores* released) {
    return select_keyframes(map, near_first, config, released).candidates.at(0).score;
  };
  // All four words have the same weight. The first query has a similarity of 1 with the first
  // keyframe and of 1/4 with the second one, with which it shares one word of four; the second
  // query shares three of four words with the second keyframe.
  EXPECT_DOUBLE_EQ(score(nullptr), 1.25);
  StaleScores released;
  EXPECT_DOUBLE_EQ(score(&released), 1.0) << "nothing was ever computed for the neighbor";
  select_keyframes(map, near_second, config, &released);
  EXPECT_DOUBLE_EQ(score(&released), 1.75) << "the other query's similarity was not used";
  EXPECT_DOUBLE_EQ(score(nullptr), 1.25);
}

TEST(StaleScores, AreCountedByTheQueryThatLeftThem) {
  const Map map = map_of_neighbors();
  const AugmentedVector near_first = vector_of({}, {1, 2, 3, 4}),
                        near_second = vector_of({}, {5, 6, 7, 9});
  const SemanticConfig config{.alpha = 0.8, .beta = 0.0, .overlap = Overlap::kWords};
  const auto summed = [&](StaleScores* released) {
    return select_keyframes(map, near_first, config, released).summed;
  };
  StaleScores released;
  const SummedScores unscored = summed(&released);
  EXPECT_EQ(unscored.terms, 2);
  EXPECT_EQ(unscored.unscored, 1);
  EXPECT_EQ(unscored.stale, 0);
  EXPECT_DOUBLE_EQ(unscored.weight, 1.0);

  select_keyframes(map, near_second, config, &released);
  for (const int age : {1, 2}) {
    const SummedScores stale = summed(&released);
    EXPECT_EQ(stale.terms, 2);
    EXPECT_EQ(stale.unscored, 0);
    EXPECT_EQ(stale.stale, 1);
    EXPECT_DOUBLE_EQ(stale.weight, 1.75);
    EXPECT_DOUBLE_EQ(stale.stale_weight, 0.75);
    EXPECT_EQ(stale.stale_age, age);
  }
  const SummedScores fresh = summed(nullptr);
  EXPECT_EQ(fresh.terms, 2);
  EXPECT_EQ(fresh.unscored + fresh.stale, 0);
  EXPECT_DOUBLE_EQ(fresh.weight, 1.25);
}

TEST(StaleScores, ThatAreClearedAreThoseOfAFirstQuery) {
  Map map = map_of_neighbors();
  Keyframe other;  // similarity 0.8: above beta times 1, but not above beta times 1.25
  other.words.vector = vector_of({}, {1, 2, 3, 4, 8});
  map.add(std::move(other));
  const Features features;
  const FeatureGrid grid(features.keypoints, Camera{});
  WordIndex words;
  words.vector = vector_of({}, {1, 2, 3, 4});
  MatchCounts counts{};
  const auto candidates = [&](NeighborScores neighbors) {
    SlamConfig config;
    config.semantics = {.alpha = 0.8, .beta = 0.75, .overlap = Overlap::kWords};
    config.relocalize.neighbor_scores = neighbors;
    StaleScores released;
    return relocalize({features, grid, words}, {Camera{}, config, map, counts}, RandomStream(1),
                      nullptr, &released)
        .candidates.final;
  };
  EXPECT_EQ(candidates(NeighborScores::kFresh), 1);
  EXPECT_EQ(candidates(NeighborScores::kCleared), 2);
  EXPECT_EQ(candidates(NeighborScores::kAsReleased), 2);
}

/// A keyframe, and a frame from a nearby place that sees the same points without noise.
struct MappedViews {
  static constexpr std::uint32_t kPoints = 60;
  const Camera camera;
  const SE3 truth = SE3::exp((Vector6d() << 0.1, -0.05, 0.12, 0.03, -0.06, 0.02).finished());
  Map map;
  Features features;
  WordIndex words;

  /// @param lying  whether the frame's keypoint of a point is 60 px from its true place
  /// @param same_word  whether that keypoint has the same word as the keyframe's
  explicit MappedViews(const std::function<bool(std::uint32_t)>& lying,
                       const std::function<bool(std::uint32_t)>& same_word = {}) {
    const auto keypoint = [&](const Eigen::Vector3d& p) {
      Keypoint k;
      k.u_px = static_cast<float>(camera.project(p).x());
      k.v_px = static_cast<float>(camera.project(p).y());
      k.depth_m = static_cast<float>(p.z());
      return k;
    };
    Keyframe keyframe;
    std::vector<Eigen::Vector3d> points;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      const RandomStream draw = RandomStream(4).fork(i);
      points.push_back(camera.unproject(draw.uniform(0, 120, 520), draw.uniform(1, 100, 380),
                                        draw.uniform(2, 2, 4)));
      keyframe.features.keypoints.push_back(keypoint(points[i]));
      keyframe.features.descriptors.push_back(
          {draw.bits(3), draw.bits(4), draw.bits(5), draw.bits(6)});
      keyframe.words.by_node.emplace_back(i, i);
      words.by_node.emplace_back(!same_word || same_word(i) ? i : i + 1000, i);
      features.keypoints.push_back(keypoint(truth * points[i]));
      if (lying(i)) features.keypoints[i].u_px += 60;
    }
    std::sort(words.by_node.begin(), words.by_node.end());
    features.descriptors = keyframe.features.descriptors;
    words.vector = keyframe.words.vector = vector_of({}, {1, 2, 3});
    map.add(std::move(keyframe));
    for (std::uint32_t i = 0; i < kPoints; ++i)
      map.refresh(map.add_landmark(points[i], KeyframeId{0}, i), {});
  }

  RelocalizationResult find(Acceptance acceptance, double search_radius_px = 10) const {
    SlamConfig config;
    config.relocalize.acceptance = acceptance;
    config.relocalize.search_radius_px = search_radius_px;
    const FeatureGrid grid(features.keypoints, camera);
    MatchCounts counts{};
    return relocalize({features, grid, words}, {camera, config, map, counts}, RandomStream(1));
  }
};

constexpr auto kBoth = {Acceptance::kOurs, Acceptance::kOrbSlam2};

/// Two identical rooms, 10 m apart, and a frame from the first. `less` points are missing in the
/// copy.
struct RoomAndCopy : MappedViews {
  const SE3 to_copy = SE3::exp((Vector6d() << 10, 0, 0, 0, 0, 0).finished());
  explicit RoomAndCopy(std::uint32_t less) : MappedViews([](std::uint32_t) { return false; }) {
    Keyframe copy = map.at(KeyframeId{0});
    copy.camera_from_world = to_copy.inverse();
    copy.landmarks.clear();
    map.add(std::move(copy));
    for (std::uint32_t i = less; i < kPoints; ++i) {
      const LandmarkId landmark = map.at(KeyframeId{0}).landmarks[i];
      map.refresh(map.add_landmark(to_copy * map.at(landmark).position_in_world, KeyframeId{1}, i),
                  {});
    }
  }
  RelocalizationResult find_place(double rival_share, const IsPossible& is_possible = {}) const {
    SlamConfig config;
    config.relocalize.rival_share = rival_share;
    const FeatureGrid grid(features.keypoints, camera);
    MatchCounts counts{};
    return relocalize({features, grid, words}, {camera, config, map, counts}, RandomStream(1),
                      nullptr, nullptr, is_possible);
  }
};

TEST(Relocalize, RefusesAPlaceThatHasARival) {
  EXPECT_EQ(RoomAndCopy(0).find_place(0).stage, RelocalizationStage::kVerified);
  for (const double share : {0.9, 1.0}) {
    const auto refused = RoomAndCopy(0).find_place(share);
    EXPECT_EQ(refused.stage, RelocalizationStage::kInliers);
    EXPECT_FALSE(refused.camera_from_world);
  }
  // The copy has 54 of the 60 points: a share of 0.9.
  EXPECT_EQ(RoomAndCopy(6).find_place(0.9).stage, RelocalizationStage::kInliers);
  const auto clear = RoomAndCopy(6).find_place(0.91);
  EXPECT_EQ(clear.stage, RelocalizationStage::kVerified);
  EXPECT_EQ(clear.keyframe, KeyframeId{0});
}

TEST(Relocalize, PassesOverPlacesThatAreImpossible) {
  const RoomAndCopy rooms(0);
  for (const double rival_share : {0.0, 0.9})
    for (const double from_m : {-5.0, 5.0}) {
      const auto found = rooms.find_place(rival_share, [&](const MapPose& pose) {
        return std::abs(pose.camera_from_world.inverse().translation().x() - from_m) < 5;
      });
      EXPECT_EQ(found.stage, RelocalizationStage::kVerified);
      EXPECT_EQ(found.keyframe, KeyframeId{from_m < 0 ? 0U : 1U});
    }
  const auto nowhere = rooms.find_place(0, [](const MapPose&) { return false; });
  EXPECT_EQ(nowhere.stage, RelocalizationStage::kInliers);
  EXPECT_FALSE(nowhere.camera_from_world);
}

// The first and the last feature may be false. Relocalization finds every true one, no others, and
// the exact pose.
TEST(Relocalize, FindsEachTrueLandmarkAndTheExactPose) {
  constexpr std::uint32_t kPoints = MappedViews::kPoints;
  for (const Acceptance acceptance : kBoth)
    for (const bool lies : {false, true}) {
      const auto lying = [&](std::uint32_t i) { return lies && (i == 0 || i == kPoints - 1); };
      const MappedViews views(lying);
      const auto found = views.find(acceptance);
      EXPECT_EQ(found.stage, RelocalizationStage::kVerified);
      EXPECT_EQ(found.keyframe, KeyframeId{0});
      EXPECT_EQ(found.inliers, static_cast<int>(lies ? kPoints - 2 : kPoints));
      ASSERT_TRUE(found.camera_from_world);
      EXPECT_LT((*found.camera_from_world * views.truth.inverse()).log().norm(), 1e-5);
      ASSERT_EQ(found.landmarks.size(), kPoints);
      for (std::uint32_t i = 0; i < kPoints; ++i)
        EXPECT_EQ(found.landmarks[i], lying(i) ? LandmarkId{} : LandmarkId{i}) << i;
    }
}

// 16 points share their words; the pose computed from these finds the others.
TEST(Relocalize, BothAcceptancesSearchOnByThePose) {
  for (const Acceptance acceptance : kBoth) {
    const MappedViews views([](std::uint32_t) { return false; },
                            [](std::uint32_t i) { return i < 16; });
    const auto found = views.find(acceptance);
    EXPECT_EQ(found.stage, RelocalizationStage::kVerified);
    EXPECT_EQ(found.inliers, static_cast<int>(MappedViews::kPoints));
  }
}

// 44 keypoints are 1.5 px off and differ by 80 bits, which only the first search accepts.
TEST(Relocalize, TheFirstSearchReachesAsFarAsItsRadius) {
  MappedViews views([](std::uint32_t) { return false; }, [](std::uint32_t i) { return i < 16; });
  for (std::uint32_t i = 16; i < MappedViews::kPoints; ++i) {
    views.features.keypoints[i].v_px += 1.5F;
    views.features.descriptors[i][0] = ~views.features.descriptors[i][0];
    views.features.descriptors[i][1] ^= 0xffffU;
  }
  EXPECT_EQ(views.find(Acceptance::kOurs, 2).stage, RelocalizationStage::kVerified);
  EXPECT_EQ(views.find(Acceptance::kOurs, 1).stage, RelocalizationStage::kInliers);
}

// The first 10 or 16 of 30 matches by words are false. Our acceptance needs ten true matches,
// ORB-SLAM2's needs half of all matches.
TEST(Relocalize, OrbSlam2AsksForHalfOfTheMatches) {
  const auto stage = [](std::uint32_t liars, Acceptance acceptance) {
    return MappedViews([=](std::uint32_t i) { return i < liars; },
                       [](std::uint32_t i) { return i < 30; })
        .find(acceptance)
        .stage;
  };
  EXPECT_EQ(stage(10, Acceptance::kOrbSlam2), RelocalizationStage::kVerified);
  EXPECT_EQ(stage(16, Acceptance::kOrbSlam2), RelocalizationStage::kPnp);
  // 44 true matches are too few for either, but ours gets as far as counting them.
  EXPECT_EQ(stage(16, Acceptance::kOurs), RelocalizationStage::kInliers);
}

CandidateAttempt alone(const MappedViews& views, const TrialGivens& givens = {}) {
  const SlamConfig config;
  const FeatureGrid grid(views.features.keypoints, views.camera);
  MatchCounts counts{};
  return try_alone(KeyframeId{0}, {views.features, grid, views.words},
                   {views.camera, config, views.map, counts}, RandomStream(1), givens);
}

TEST(TryAlone, AnswersAsAmongTheCandidates) {
  const MappedViews views([](std::uint32_t i) { return i < 7; });
  const auto among = views.find(Acceptance::kOurs);
  const CandidateAttempt tried = alone(views);
  EXPECT_EQ(tried.stage, among.stage);
  EXPECT_EQ(tried.landmarks, among.landmarks);
  EXPECT_EQ(tried.camera_from_world.translation(), among.camera_from_world->translation());
  EXPECT_EQ(tried.camera_from_world.rotation(), among.camera_from_world->rotation());
}

TEST(TryAlone, KeepsOnlyTheMatchesThatAreAllowed) {
  const MappedViews views([](std::uint32_t) { return false; });
  const auto first = [&](std::uint32_t count) {
    return alone(views, {.allows = [=](std::uint32_t feature, LandmarkId landmark) {
                   EXPECT_EQ(feature, landmark.value);
                   return feature < count;
                 }});
  };
  EXPECT_EQ(first(14).stage, RelocalizationStage::kMatches) << "one fewer than it takes";
  EXPECT_EQ(first(40).stage, RelocalizationStage::kInliers) << "guided searches found the others";
  EXPECT_EQ(first(55).inliers, 55);
}

// No keypoint shares a word with the keyframe: there is no match by words, but all match around the
// pose.
TEST(TryAlone, AGivenPoseNeedsNoMatchByWords) {
  const MappedViews views([](std::uint32_t) { return false; }, [](std::uint32_t) { return false; });
  EXPECT_EQ(alone(views).stage, RelocalizationStage::kMatches);
  const CandidateAttempt given = alone(views, {.camera_from_world = views.truth});
  EXPECT_EQ(given.stage, RelocalizationStage::kVerified);
  EXPECT_EQ(given.inliers, static_cast<int>(MappedViews::kPoints));
  const SE3 turned = SE3::exp((Vector6d() << 0, 0, 0, 0, 1, 0).finished()) * views.truth;
  EXPECT_EQ(alone(views, {.camera_from_world = turned}).stage, RelocalizationStage::kInliers);
}

// For ORB-SLAM2, the matches that a search adds count only if they bring the total to 50.
TEST(Relocalize, OrbSlam2GivesUpWhereASearchCannotReachFifty) {
  for (const auto& [liars, stage] : {std::pair{10U, RelocalizationStage::kVerified},
                                     std::pair{11U, RelocalizationStage::kInliers}}) {
    const std::uint32_t false_ones = liars;
    const auto found = MappedViews([=](std::uint32_t i) { return i >= 60 - false_ones; },
                                   [](std::uint32_t i) { return i < 20; })
                           .find(Acceptance::kOrbSlam2);
    EXPECT_EQ(found.stage, stage) << liars;
  }
}

}  // namespace
}  // namespace mh
