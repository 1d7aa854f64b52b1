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

constexpr std::array<std::pair<std::string_view, Overlap>, 3> setting_words(Overlap) {
  return {{{"labels", Overlap::kLabels},
           {"augmented", Overlap::kAugmented},
           {"words", Overlap::kWords}}};
}

/// The paper's parameters.
struct SemanticConfig {
  double gamma = 1.0;
  double label_mass = 0.0;
  double xi = 1.5;
  double alpha = 0.8;
  double beta = 0.75;
  Overlap overlap = Overlap::kAugmented;
  bool void_is_a_label = false;

  /// These settings with the method switched off: the plain system. Settings that are not part of
  /// the method (alpha, beta) are kept.
  SemanticConfig neutralized() const {
    SemanticConfig plain = *this;
    plain.gamma = 0.0;
    plain.label_mass = 0.0;
    plain.xi = 1.0;
    plain.overlap = Overlap::kWords;
    return plain;
  }
  /// The plain system's defaults.
  static SemanticConfig neutral() { return SemanticConfig{}.neutralized(); }
  friend bool operator==(const SemanticConfig&, const SemanticConfig&) = default;
};

template <Either<SemanticConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [gamma, label_mass, xi, alpha, beta, overlap, void_is_a_label] = c;
  v("gamma", gamma, {0, setting::kMany}, "weight of a label, equation 1");
  v("label_mass", label_mass, {0, 0.99},
    "if not 0: queries take the gamma with which labels hold this share of the keyframes' vectors");
  v("xi", xi, {1, setting::kMany}, "factor where labels disagree, equation 2");
  v("alpha", alpha, setting::kOpenShare, "equation 4");
  v("beta", beta, setting::kOpenShare, "equation 6");
  v("overlap", overlap, {}, "what equation 3 counts: labels, augmented or words");
  v("void_is_a_label", void_is_a_label, setting::kSwitch, "void disagrees with every label");
}

}  // namespace mh
