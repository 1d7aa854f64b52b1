// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/sensors/config.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// What a level does to frames after they were captured: to their delivery (section `feed`), and to
/// the calibration that is handed over with them (section `told`). A frame keeps its true pose; a
/// wrong stamp is also that of its pose. Returns the sequence itself if the level has none of these
/// faults.
std::shared_ptr<const Sequence> with_feed_faults(std::shared_ptr<const Sequence> frames,
                                                 const SensorConfig& level);

/// A recording with all faults of a level, by the code that renders them: those of its images, lost
/// frames, and with_feed_faults(). Noise is keyed as in a rendering: a recording of exact images
/// becomes what the level renders.
/// @throws InputError if the level has a fault that needs the scene
std::shared_ptr<const Sequence> degraded(std::shared_ptr<const Sequence> recording,
                                         const SensorConfig& level);

/// Why a level cannot be applied to finished images: a line for each section that needs the scene.
std::vector<std::string> faults_of_scene(const SensorConfig& level);

}  // namespace mh
