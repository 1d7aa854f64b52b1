// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "slam/config/setting.hpp"

namespace mh {

/// What n of equation 3 counts (Algorithm 1 leaves it open).
enum class Overlap {
  kLabels,     ///< distinct labels, as Algorithm 1's text says
  kAugmented,  ///< members of the augmented vector: labels and words
  kWords       ///< visual words alone
};

constexpr std::array<std::pair<std::string_view, Overlap>, 3> words(Overlap) {
  return {{{"labels", Overlap::kLabels},
           {"augmented", Overlap::kAugmented},
           {"words", Overlap::kWords}}};
}

/// Which candidates relocalization tries.
enum class CandidateLists {
  kOne,        ///< those of Algorithm 1
  kSideBySide  ///< those of Algorithm 1, interleaved with those that it selects from words alone
};

constexpr std::array<std::pair<std::string_view, CandidateLists>, 2> words(CandidateLists) {
  return {{{"one", CandidateLists::kOne}, {"side_by_side", CandidateLists::kSideBySide}}};
}

/// Where relocalization also looks for matches if matching by words gives a candidate too few.
enum class WiderSearch {
  kNone,
  kSameLabel,  ///< among all keypoints with the landmark's label
  kAll         ///< among all keypoints; uses no label, so the plain system has it, too
};

constexpr std::array<std::pair<std::string_view, WiderSearch>, 3> words(WiderSearch) {
  return {{{"none", WiderSearch::kNone},
           {"same_label", WiderSearch::kSameLabel},
           {"all", WiderSearch::kAll}}};
}

/// The paper's parameters, and settings of rules that go beyond the paper
/// (slam/relocalize/beyond_paper.hpp): `label_mass`, `candidates` and all members after
/// `candidates`.
struct SemanticConfig {
  double gamma = 1.0;
  double label_mass = 0.0;
  double xi = 1.5;
  double alpha = 0.8;
  double beta = 0.75;
  Overlap overlap = Overlap::kAugmented;
  bool void_is_a_label = false;
  CandidateLists candidates = CandidateLists::kOne;
  double nearness = 0.0;
  WiderSearch wider_search = WiderSearch::kNone;
  double min_agreement = 0.0;

  /// These settings with the method switched off: the plain system. Settings that are not part of
  /// the method (alpha, beta) are kept.
  SemanticConfig neutralized() const {
    SemanticConfig plain = *this;
    plain.gamma = 0.0;
    plain.label_mass = 0.0;
    plain.xi = 1.0;
    plain.overlap = Overlap::kWords;
    plain.candidates = CandidateLists::kOne;
    plain.nearness = 0.0;
    if (wider_search == WiderSearch::kSameLabel) plain.wider_search = WiderSearch::kNone;
    plain.min_agreement = 0.0;
    return plain;
  }
  /// The plain system's defaults.
  static SemanticConfig neutral() { return SemanticConfig{}.neutralized(); }
  friend bool operator==(const SemanticConfig&, const SemanticConfig&) = default;
};

template <MaybeConst<SemanticConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [gamma, label_mass, xi, alpha, beta, overlap, void_is_a_label, candidates, nearness,
         wider_search, min_agreement] = c;
  v("gamma", gamma, {0, setting::kMany}, "weight of a label, equation 1");
  v("label_mass", label_mass, {0, 0.99},
    "if not 0: queries use the gamma at which labels hold this share of the keyframes' vectors");
  v("xi", xi, {1, setting::kMany}, "factor on the distance where labels disagree, equation 2");
  v("alpha", alpha, setting::kOpenShare, "equation 4");
  v("beta", beta, setting::kOpenShare, "equation 6");
  v("overlap", overlap, {}, "what equation 3 counts: labels, augmented or words");
  v("void_is_a_label", void_is_a_label, setting::kSwitch, "void disagrees with every label");
  v("candidates", candidates, {},
    "of relocalization: one list, or that list and one by words alone, interleaved (side_by_side)");
  v("nearness", nearness, {0, 100},
    "exponent of the size agreement that multiplies a candidate's score; 0: off");
  v("wider_search", wider_search, {},
    "what else to search below relocalize.min_word_matches: none, same_label or all keypoints");
  v("min_agreement", min_agreement, setting::kShare,
    "relocalization rejects a pose if a smaller share of its inliers' labels agree; 0: off");
}

}  // namespace mh
