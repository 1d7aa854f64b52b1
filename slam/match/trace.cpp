// SPDX-License-Identifier: Apache-2.0
#include "slam/match/trace.hpp"

#include <map>

namespace mh {
namespace {

/// Equation 2 once more: the matchers keep no distances.
void set_distance(MatchedPair& pair, LabeledDescriptor p, LabeledDescriptor q,
                  const SemanticConfig& config) {
  MatcherCounts counts;
  pair.distance_bits = SemanticMatcher(config, counts)(p, q).semantic;
  pair.penalized = counts.penalized != 0;
}

LabeledDescriptor view(const Features& features, std::uint32_t i) {
  return {features.descriptors[i], features.keypoints[i].label};
}

}  // namespace

void trace_projection(MatchTrace* trace, Matcher matcher, KeyframeId seen_in,
                      const Features& features, std::span<const ProjectionTarget> targets,
                      std::span<const std::int32_t> found, std::span<const LandmarkId> landmarks,
                      std::span<const std::uint32_t> others, const SemanticConfig& config) {
  if (trace == nullptr) return;
  for (std::size_t t = 0; t < found.size(); ++t) {
    if (found[t] < 0) continue;
    MatchedPair pair{.matcher = matcher,
                     .seen_in = seen_in,
                     .feature = static_cast<std::uint32_t>(found[t]),
                     .landmark = landmarks.empty() ? LandmarkId{} : landmarks[t],
                     .keyframe = {},
                     .other_feature = others.empty() ? MatchedPair::kNone : others[t]};
    set_distance(pair, {*targets[t].descriptor, targets[t].label}, view(features, pair.feature),
                 config);
    trace->push_back(pair);
  }
}

void trace_words(MatchTrace* trace, Matcher matcher, KeyframeId a, const Features& features_a,
                 std::span<const LandmarkId> landmarks_a, KeyframeId b, const Features& features_b,
                 std::span<const FeatureMatch> matches, const SemanticConfig& config) {
  if (trace == nullptr) return;
  for (const FeatureMatch& m : matches) {
    MatchedPair pair{.matcher = matcher,
                     .seen_in = b,
                     .feature = m.b,
                     .landmark = landmarks_a.empty() ? LandmarkId{} : landmarks_a[m.a],
                     .keyframe = a,
                     .other_feature = m.a};
    set_distance(pair, view(features_a, m.a), view(features_b, m.b), config);
    trace->push_back(pair);
  }
}

void trace_landmarks(MatchTrace* trace, Matcher matcher, const Keyframe& keyframe,
                     const Features& features, std::span<const LandmarkId> landmarks,
                     const SemanticConfig& config) {
  if (trace == nullptr) return;
  std::map<LandmarkId, std::uint32_t> feature_of;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i)
    if (keyframe.landmarks[i].valid()) feature_of[keyframe.landmarks[i]] = i;
  std::vector<FeatureMatch> matches;
  for (std::uint32_t i = 0; i < landmarks.size(); ++i)
    if (landmarks[i].valid()) matches.push_back({feature_of.at(landmarks[i]), i});
  trace_words(trace, matcher, keyframe.id, keyframe.features, keyframe.landmarks, {}, features,
              matches, config);
}

}  // namespace mh
