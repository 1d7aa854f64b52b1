// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/recordings/open_sequence.hpp"

namespace mh {

/// Sequences rendered in Replica's rooms by the authors of iMAP, in the layout in which NICE-SLAM
/// distributes them: results/frameXXXXXX.jpg and depthXXXXXX.png, traj.txt (camera to world, 4x4 by
/// rows, line N for frame N), and cam_params.json in the folder or beside it.
extern const SequenceReader kReplicaReader;

}  // namespace mh
