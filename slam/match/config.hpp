// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mh {

/// What is counted as n in equation 3 (Algorithm 1 leaves it open).
enum class Overlap {
  kLabels,     ///< distinct labels, as Algorithm 1's text says
  kAugmented,  ///< members of the augmented vector: labels and words
  kWords       ///< visual words alone
};

/// The paper's parameters. neutral() is the plain system.
struct SemanticConfig {
  double gamma = 1.0;  ///< weight of a label in equation 1, >= 0
  double xi = 1.5;     ///< penalty factor of equation 2, >= 1
  double alpha = 0.8;  ///< equation 4, [0, 1)
  double beta = 0.75;  ///< equation 6, [0, 1)
  Overlap overlap = Overlap::kAugmented;
  bool void_is_a_label = false;

  /// These settings with the method switched off: the plain system. What is not of the method
  /// (alpha, beta) stays.
  SemanticConfig neutralised() const {
    SemanticConfig plain = *this;
    plain.gamma = 0.0;
    plain.xi = 1.0;
    plain.overlap = Overlap::kWords;
    return plain;
  }
  static SemanticConfig neutral() { return SemanticConfig{}.neutralised(); }
  friend bool operator==(const SemanticConfig&, const SemanticConfig&) = default;
};

struct MatchConfig {
  int max_distance = 50;          ///< bits; tight gate (appearance alone, fusion)
  int max_distance_loose = 100;   ///< bits; where geometry already restricts the search
  double ratio = 0.75;            ///< best over second best, appearance alone
  double ratio_projection = 0.8;  ///< the same where geometry already restricts the search
};

}  // namespace mh
