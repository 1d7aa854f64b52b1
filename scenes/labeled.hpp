// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace mh {

/// How much of a scene's surface has a class, and the names of what has none.
struct LabeledSurface {
  struct Unlabeled {
    std::string pattern;  ///< as a rule of labels.yaml names it (LabelRules)
    double area_m2 = 0;
  };
  double area_m2 = 0, labeled_m2 = 0;
  std::vector<Unlabeled> unlabeled;  ///< the largest first

  double share() const { return area_m2 > 0 ? labeled_m2 / area_m2 : 0.0; }
};

/// Sums the faces' areas. What has no class goes by its object's name, counting numbers apart, or
/// by its material's where it is no object's.
LabeledSurface survey_labels(const Scene& scene);

/// The text of a labels.yaml that names all that has no class, to be filled in; as it is, it loads
/// and changes nothing.
std::string suggested_labels(const LabeledSurface& surface);

}  // namespace mh
