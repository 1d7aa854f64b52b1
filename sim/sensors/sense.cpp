// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>

#include "sim/sensors/depth_bias.hpp"
#include "sim/sensors/depth_noise.hpp"
#include "sim/sensors/develop.hpp"
#include "sim/sensors/sense.hpp"

namespace mh {
namespace {

enum SenseStream : std::uint64_t {
  kDepth = 1,
  kColor = 2,
  kLabels = 3,
  kBlank = 4,
  kDepthFaults = 5
};

}  // namespace

bool is_blank(const SensorConfig& config, RandomStream stream) {
  return stream.fork(kBlank).uniform(0) < config.blank_frames.lost();
}

RgbdFrame sense(const RenderedFrame& truth, const Camera& camera, const SensorConfig& config,
                RandomStream stream, Stamp stamp_ns, double gain) {
  assert(truth.depth_m.width() == camera.width_px && truth.depth_m.height() == camera.height_px);
  if (is_blank(config, stream))
    return {.stamp_ns = stamp_ns,
            .color = Grid2d<Rgb8>(camera.width_px, camera.height_px),
            .depth_m = Grid2d<float>(camera.width_px, camera.height_px),
            .semantics = {}};
  RgbdFrame frame{stamp_ns, truth.color, {}, {}};
  frame.depth_m = config.depth_noise.enabled
                      ? noisy_depth(truth.depth_m, camera, config.depth_noise, stream.fork(kDepth))
                      : truth.depth_m;
  if (config.depth_faults.enabled)
    frame.depth_m =
        faulty_depth(frame.depth_m, camera, config.depth_faults, stream.fork(kDepthFaults));
  if (config.depth_bias.enabled) frame.depth_m = biased_depth(frame.depth_m, config.depth_bias);
  SensorConfig set = config;
  set.shot_noise.gain = analog_gain(config.shot_noise, truth.exposure);
  develop(frame.color, camera, set, gain, stream.fork(kColor));
  return frame;
}

SemanticImage sense_labels(const RenderedFrame& truth, LabelMode mode, const SensorConfig& config,
                           const SE3& world_from_camera, RandomStream stream) {
  if (is_blank(config, stream)) return {};
  return label_image(truth, mode, config.labels, world_from_camera, stream.fork(kLabels));
}

}  // namespace mh
