// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// How much of a scene's surface is labeled, and the names of the unlabeled parts.
struct LabeledSurface {
  struct Unlabeled {
    std::string pattern;  ///< as a rule of labels.yaml would match it (LabelRules)
    double area_m2 = 0;
  };
  double area_m2 = 0, labeled_m2 = 0;
  std::vector<Unlabeled> unlabeled;  ///< largest first

  double share() const { return area_m2 > 0 ? labeled_m2 / area_m2 : 0.0; }
};

/// Sums the areas of faces. Unlabeled surface is listed by object name without its number,
/// or by material name if it belongs to no object.
LabeledSurface survey_labels(const Scene& scene);

/// The text of a labels.yaml that lists everything unlabeled, to be filled in; unedited, it loads
/// and has no effect.
std::string suggested_labels(const LabeledSurface& surface);

}  // namespace mh
