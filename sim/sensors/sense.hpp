// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sim/render/renderer.hpp"
#include "sim/sensors/config.hpp"
#include "sim/sensors/labels.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// Maximum incidence, 80 deg: Nguyen et al. could not measure beyond it, since the sensor returned
/// too few readings.
inline constexpr double kMaxIncidenceRad = 1.3962634015954636;
/// Disparity steps per pixel: Khoshelham and Elberink, section 3.2.
inline constexpr double kDisparityStepsPerPx = 8.0;

/// Standard deviation (m) along the axis at a depth (m) and incidence (rad, 0 = face-on): equation
/// of Nguyen et al., their angular term from 60 deg on; the incidence is clamped to
/// kMaxIncidenceRad.
double axial_sigma_m(double depth_m, double incidence_rad);
/// Standard deviation (px) perpendicular to the axis; equation of Nguyen et al., incidence clamped
/// in the same way.
double lateral_sigma_px(double incidence_rad);

/// The gain for an image of this exposure: never below 1, since a camera would shorten the exposure
/// time instead. Unknown exposure (0): the configured gain.
double analog_gain(const ShotNoiseConfig& config, float exposure);

/// Whether the frame of this stream arrives blank.
bool is_blank(const SensorConfig& config, RandomStream stream);

/// Returns the frame, without labels, that a camera with these faults delivers. All noise is a
/// function of (stream, pixel) alone; each kind uses its own stream.
/// @param truth   the image as the shutter captured it (see shutter.hpp), or an exact one
/// @param stream  random stream of this frame
/// @param gain    gain of the exposure control
RgbdFrame sense(const RenderedFrame& truth, const Camera& camera, const SensorConfig& config,
                RandomStream stream, Stamp stamp_ns, double gain = 1.0);

/// Returns the labels of that frame; separate, since systems that see the same image may receive
/// different labels. Empty for a blank frame.
SemanticImage sense_labels(const RenderedFrame& truth, LabelMode mode, const SensorConfig& config,
                           const SE3& world_from_camera, RandomStream stream);

}  // namespace mh
