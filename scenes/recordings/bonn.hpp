// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/recordings/open_sequence.hpp"

namespace mh {

/// The Bonn RGB-D Dynamic Dataset (Palazzolo et al., IROS 2019): folders rgbd_bonn_NAME in TUM's
/// layout, with the published calibration. groundtruth.txt has poses of the markers on the camera;
/// they are converted to poses of the camera as the data set's page describes.
extern const SequenceReader kBonnReader;

}  // namespace mh
