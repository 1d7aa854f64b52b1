// SPDX-License-Identifier: Apache-2.0
#include "slam/match/context.hpp"

#include <algorithm>

#include "slam/config/slam.hpp"

namespace mh {
namespace {

/// Recomputes equation 2, since the matchers do not store distances.
void set_distance(MatchedPair& pair, LabeledDescriptor p, LabeledDescriptor q,
                  const SemanticConfig& config) {
  MatcherCounts counts;
  const SemanticMatcher::Distance distance = SemanticMatcher(config, counts)(p, q);
  pair.distance_bits = distance.semantic;
  pair.penalized = distance.penalized;
}

LabeledDescriptor view(const Features& features, std::uint32_t i) {
  return {features.descriptors[i], features.keypoints[i].label};
}

/// Runs a search and, where decisions are traced, again without equation 2.
/// @param search    search(SemanticMatcher) -> what it found
/// @param decision  decision(GatedPair) -> the pair as a MatchDecision
template <class Search, class Decide>
auto traced(const SlamContext& context, Matcher matcher, Search search, Decide decision) {
  if (context.decisions == nullptr) return search(semantic_matcher(context, matcher));
  GateLog log;
  const auto note = [&](bool with_xi) {
    for (const GatedPair& pair : log) {
      MatchDecision decided = decision(pair);
      decided.matcher = matcher;
      decided.with_xi = with_xi;
      decided.gate = pair.gate;
      context.decisions->push_back(decided);
    }
    log.clear();
  };
  auto found = search(semantic_matcher(context, matcher, &log));
  note(true);
  SemanticConfig without_xi = context.config.semantics;
  without_xi.xi = 1;
  MatcherCounts not_counted;
  search(SemanticMatcher(without_xi, not_counted, &log));
  note(false);
  return found;
}

}  // namespace

SemanticMatcher semantic_matcher(const SlamContext& context, Matcher matcher, GateLog* log) {
  return {context.config.semantics, at(context.counts, matcher), log};
}

namespace {

/// Features of the two views that may match: those under equal nodes.
struct Nodes {
  const WordIndex& keyframe;
  const WordIndex& query;
};

std::vector<LandmarkId> match_under(const Nodes& nodes, const Keyframe& keyframe,
                                    const Query& query, const SlamContext& context,
                                    Matcher matcher) {
  const MatchConfig& config = context.config.match;
  std::vector<std::uint8_t> with_landmark(keyframe.features.size());
  for (std::size_t i = 0; i < with_landmark.size(); ++i)
    with_landmark[i] = keyframe.landmarks[i].valid();
  const std::vector<std::uint8_t> all(query.features.size(), 1);
  const auto matches = traced(
      context, matcher,
      [&](SemanticMatcher equation_2) {
        return match_by_words({keyframe.features, nodes.keyframe, with_landmark},
                              {query.features, nodes.query, all},
                              {.max_distance = static_cast<float>(config.max_distance),
                               .ratio = static_cast<float>(config.ratio)},
                              equation_2);
      },
      [&](const GatedPair& pair) {
        return MatchDecision{.feature = pair.feature,
                             .landmark = keyframe.landmarks[pair.asked],
                             .keyframe = keyframe.id,
                             .other_feature = pair.asked};
      });
  trace_words(context, matcher,
              {keyframe.id, keyframe.features, keyframe.landmarks, {}, query.features, matches});
  std::vector<LandmarkId> landmarks(query.features.size());
  for (const FeatureMatch& m : matches) landmarks[m.b] = keyframe.landmarks[m.a];
  return landmarks;
}

/// Puts all features under one node, or each under its label.
WordIndex nodes_of(const Features& features, WiderSearch where) {
  WordIndex index;
  for (std::uint32_t i = 0; i < features.size(); ++i) {
    const ClassId label = features.keypoints[i].label;
    if (where == WiderSearch::kAll)
      index.by_node.emplace_back(0, i);
    else if (label != kVoid)
      index.by_node.emplace_back(label, i);
  }
  std::sort(index.by_node.begin(), index.by_node.end());
  return index;
}

}  // namespace

std::vector<LandmarkId> match_landmarks(const Keyframe& keyframe, const Query& query,
                                        const SlamContext& context, Matcher matcher) {
  return match_under({keyframe.words, query.words}, keyframe, query, context, matcher);
}

std::vector<LandmarkId> match_landmarks_widely(const Keyframe& keyframe, const Query& query,
                                               const SlamContext& context, Matcher matcher,
                                               WiderSearch where) {
  const WordIndex of_keyframe = nodes_of(keyframe.features, where);
  const WordIndex of_query = nodes_of(query.features, where);
  return match_under({of_keyframe, of_query}, keyframe, query, context, matcher);
}

std::vector<std::int32_t> find_landmarks(const ProjectionSearch& search, const SlamContext& context,
                                         Matcher matcher) {
  auto found = traced(
      context, matcher,
      [&](SemanticMatcher equation_2) {
        return match_by_projection(search.targets, search.query.features, search.query.grid,
                                   search.taken, search.gate, equation_2);
      },
      [&](const GatedPair& pair) {
        return MatchDecision{
            .feature = pair.feature, .landmark = search.landmarks[pair.asked], .keyframe = {}};
      });
  trace_projection(context, matcher,
                   {{}, search.query.features, search.targets, found, search.landmarks});
  return found;
}

void trace_projection(const SlamContext& context, Matcher matcher, const ProjectionPairs& pairs) {
  if (context.trace == nullptr) return;
  for (std::size_t t = 0; t < pairs.found.size(); ++t) {
    if (pairs.found[t] < 0) continue;
    MatchedPair pair{.matcher = matcher,
                     .seen_in = pairs.seen_in,
                     .feature = static_cast<std::uint32_t>(pairs.found[t]),
                     .landmark = pairs.landmarks[t],
                     .keyframe = {},
                     .other_feature = pairs.others.empty() ? MatchedPair::kNone : pairs.others[t]};
    const ProjectionTarget& target = pairs.targets[t];
    set_distance(pair, {*target.descriptor, target.label}, view(pairs.features, pair.feature),
                 context.config.semantics);
    context.trace->push_back(pair);
  }
}

void trace_words(const SlamContext& context, Matcher matcher, const WordPairs& pairs) {
  if (context.trace == nullptr) return;
  for (const FeatureMatch& m : pairs.matches) {
    MatchedPair pair{.matcher = matcher,
                     .seen_in = pairs.b,
                     .feature = m.b,
                     .landmark = pairs.landmarks_a.empty() ? LandmarkId{} : pairs.landmarks_a[m.a],
                     .keyframe = pairs.a,
                     .other_feature = m.a};
    set_distance(pair, view(pairs.features_a, m.a), view(pairs.features_b, m.b),
                 context.config.semantics);
    context.trace->push_back(pair);
  }
}

}  // namespace mh
