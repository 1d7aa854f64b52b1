// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/recordings/open_sequence.hpp"

namespace mh {

/// OpenLORIS-Scene's packages (Shi et al., ICRA 2020): one folder per sequence, of which the
/// D435i's color and depth aligned to it are read (color.txt, aligned_depth.txt; mm), the
/// calibration in sensors.yaml, and groundtruth.txt, whose poses are those of the robot's base:
/// trans_matrix.yaml says where the camera is on it.
extern const SequenceReader kOpenlorisReader;

}  // namespace mh
