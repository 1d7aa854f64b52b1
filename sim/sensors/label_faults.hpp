// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/sensors/labels.hpp"
#include "sim/sensors/view_noise.hpp"
#include "sim/sensors/visible_objects.hpp"

namespace mh {

/// The random numbers that decide an instance's faults in one frame (see LabelConfig).
class FaultDraws {
 public:
  FaultDraws(const LabelConfig& config, const SE3& world_from_camera, RandomStream frame);
  /// Standard normal; `purpose` makes decisions independent.
  double normal(std::uint64_t purpose, std::uint64_t thing) const;
  /// Uniform in [0, 1], computed from the same numbers.
  double uniform(std::uint64_t purpose, std::uint64_t thing) const;
  /// Bits that are constant for an object.
  std::uint64_t persistent_bits(std::uint64_t purpose, std::uint64_t thing) const;

 private:
  ViewNoise view_;
  RandomStream always_, frame_;
  double persistent_, of_view_, of_frame_;  // factors; their squares sum to 1
};

/// The wrong class of an instance whose class is confused: of the same kind (with boxes if the true
/// one has boxes), always the same for the same instance.
ClassId wrong_class(ClassId truth, std::uint64_t bits);

/// Applies class confusion to objects and removes those whose labels drop out, as configured.
std::vector<VisibleObject> with_faults(std::vector<VisibleObject> objects,
                                       const LabelNoiseConfig& config, const FaultDraws& draws);

/// Sets pixels to void (index 0) within `radius_px` (in rows and columns) of a different index.
void erode(Grid2d<std::uint8_t>& index, int radius_px);

}  // namespace mh
