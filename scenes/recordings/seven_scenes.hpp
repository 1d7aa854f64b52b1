// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/registered_depth.hpp"

namespace mh {

/// 7-Scenes as released (Shotton et al., CVPR 2013; Glocker et al., ISMAR 2013): folders seq-XX of
/// frame-XXXXXX.color.png, .depth.png (mm, 65535: not measured) and .pose.txt (depth camera to
/// world), and for each scene TrainSplit.txt and TestSplit.txt. Each of these two files is read as
/// one recording of all the sequences that it lists. Depth is registered to color, and the poses
/// are moved to the color camera.
extern const SequenceReader kSevenScenesReader;

/// Its color camera: focal length 525 px, principal point in the middle (Brachmann et al., DSAC and
/// later).
Camera seven_scenes_color();
/// Its depth camera: focal length 585 px, principal point (320, 240) (the data set's page), and its
/// position relative to the color camera. The data set does not state the position; the one used
/// here is that of a different Kinect (LIRIS, VOIR platform), as in Brachmann et al., ICCV 2021.
DepthCamera seven_scenes_depth();

}  // namespace mh
