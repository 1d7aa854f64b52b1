// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "slam/config/semantics.hpp"
#include "slam/core/match_counts.hpp"
#include "slam/features/feature_grid.hpp"
#include "slam/features/features.hpp"
#include "slam/match/gate.hpp"
#include "slam/vocabulary/word_index.hpp"

namespace mh {

/// A descriptor with the label that equation 2 needs.
struct LabeledDescriptor {
  const Descriptor& descriptor;
  ClassId label;
};

/// Equation 2 over ORB descriptors, with counts of its effect.
class SemanticMatcher {
 public:
  /// @param log  receives the outcome of each pair; may be null
  SemanticMatcher(const SemanticConfig& config, MatcherCounts& counts, GateLog* log = nullptr)
      : xi_(static_cast<float>(config.xi)),
        policy_(config.void_is_a_label ? VoidPolicy::kIsALabel : VoidPolicy::kUnknown),
        counts_(counts),
        log_(log) {}

  struct Distance {
    float plain = 0;         ///< Hamming distance, bits
    float semantic = 0;      ///< after equation 2
    bool penalized = false;  ///< the labels disagree
  };
  Distance operator()(LabeledDescriptor p, LabeledDescriptor q) const {
    const auto plain = static_cast<float>(hamming(p.descriptor, q.descriptor));
    const bool disagree = labels_disagree(p.label, q.label, policy_);
    return {plain, semantic_distance(plain, disagree, xi_), disagree};
  }
  /// Best candidate of a search: nearest by semantic distance, with the second nearest for the
  /// ratio test.
  struct Best {
    std::uint32_t index = UINT32_MAX;
    Distance first{1e9F, 1e9F}, second{1e9F, 1e9F};
    int first_octave = -1, second_octave = -2;
    int compared = 0, penalized = 0;  ///< candidates
    void offer(std::uint32_t i, Distance d, int octave) {
      ++compared;
      penalized += d.penalized;
      if (d.semantic < first.semantic) {
        second = first;
        second_octave = first_octave;
        first = d;
        first_octave = octave;
        index = i;
      } else if (d.semantic < second.semantic) {
        second = d;
        second_octave = octave;
      }
    }
  };
  /// Applies the distance limit and the ratio test (ratio >= 1: none). Counts the search's
  /// candidates and where xi changed the outcome: to be called once for each search.
  bool accept(const Best& best, float max_distance, float ratio);
  GateLog* log() const { return log_; }

 private:
  float xi_;
  VoidPolicy policy_;
  MatcherCounts& counts_;
  GateLog* log_;
};

/// A point with a predicted image position, to be searched for among a frame's features.
struct ProjectionTarget {
  float u_px = 0, v_px = 0;
  float radius_px = 0;
  int min_octave = 0, max_octave = 0;
  const Descriptor* descriptor = nullptr;
  ClassId label = kVoid;
  float angle_rad = -1;  ///< keypoint orientation for check_angle; negative = not checked
};

struct ProjectionGate {
  float max_distance = 50;  ///< after equation 2
  float ratio = 1.0F;  ///< best over second best, if both are on one octave; >= 1: no ratio test
  bool check_angle = false;  ///< keep the dominant rotations only
};

/// Returns for each target the feature that it matches, or none. A feature goes to the target with
/// the smallest distance (ties to the first); features with taken[i] != 0 are skipped.
std::vector<std::int32_t> match_by_projection(std::span<const ProjectionTarget> targets,
                                              const Features& features, const FeatureGrid& grid,
                                              std::span<const std::uint8_t> taken,
                                              const ProjectionGate& gate, SemanticMatcher matcher);

struct FeatureMatch {
  std::uint32_t a = 0, b = 0;  ///< feature indices
};

/// A frame's features as input of match_by_words().
struct WordView {
  const Features& features;
  const WordIndex& words;
  std::span<const std::uint8_t> use;  ///< one flag per feature: whether it takes part
};

struct WordGate {
  float max_distance = 50;  ///< after equation 2
  float ratio = 1.0F;       ///< best over second best; >= 1: no ratio test
};

/// Matches features of two frames under the same vocabulary node: nearest neighbor with gate, ratio
/// test and dominant rotation; each feature at most once.
/// @param compatible  geometric test of a pair, e.g. the epipolar line; may be empty.
std::vector<FeatureMatch> match_by_words(
    const WordView& a, const WordView& b, const WordGate& gate, SemanticMatcher matcher,
    const std::function<bool(std::uint32_t, std::uint32_t)>& compatible = {});

}  // namespace mh
