// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/sensors/labels.hpp"
#include "sim/sensors/view_noise.hpp"
#include "sim/sensors/visible_objects.hpp"

namespace mh {

/// The numbers that decide an instance's faults in one frame (see LabelConfig).
class FaultDraws {
 public:
  FaultDraws(const LabelConfig& config, const SE3& world_from_camera, RandomStream frame);
  /// Standard normal; `purpose` keeps decisions apart from one another.
  double normal(std::uint64_t purpose, std::uint64_t thing) const;
  /// Uniform in [0, 1], from the same numbers.
  double uniform(std::uint64_t purpose, std::uint64_t thing) const;
  /// Bits that a thing keeps for ever.
  std::uint64_t persistent_bits(std::uint64_t purpose, std::uint64_t thing) const;

 private:
  ViewNoise view_;
  RandomStream always_, frame_;
  double persistent_, of_view_, of_frame_;  // factors; their squares sum to 1
};

/// The class for which an instance is taken when it is taken for another: of the same kind (one
/// with boxes for one with boxes), ever the same for the same instance.
ClassId wrong_class(ClassId truth, std::uint64_t bits);

/// Gives objects the classes that the dials make of them and leaves out those that lose theirs.
std::vector<VisibleObject> with_faults(std::vector<VisibleObject> objects,
                                       const LabelNoiseConfig& config, const FaultDraws& draws);

/// Makes void (index 0) what lies within `radius_px` (in rows and columns) of another index.
void erode(Grid2d<std::uint8_t>& index, int radius_px);

}  // namespace mh
