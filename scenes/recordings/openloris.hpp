// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/recordings/open_sequence.hpp"

namespace mh {

/// OpenLORIS-Scene's packages (Shi et al., ICRA 2020): one folder per sequence. The reader uses the
/// D435i's color images and the depth aligned to them (color.txt, aligned_depth.txt; mm), the
/// calibration in sensors.yaml, and groundtruth.txt. The poses there are those of the robot's base;
/// trans_matrix.yaml states where the camera is on the robot.
extern const SequenceReader kOpenlorisReader;

}  // namespace mh
