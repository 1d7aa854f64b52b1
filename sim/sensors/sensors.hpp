// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sim/render/renderer.hpp"
#include "sim/sensors/config.hpp"
#include "sim/sensors/labels.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// Nguyen et al. could measure up to 80 deg of incidence; beyond it the sensor returned too little.
inline constexpr double kMaxIncidenceRad = 1.3962634015954636;
/// Disparity steps per pixel; Khoshelham and Elberink, section 3.2.
inline constexpr double kDisparityStepsPerPx = 8.0;

/// Standard deviation (m) along the axis at a depth (m) and incidence (rad, 0 = face-on): equation
/// of Nguyen et al., their angular term from 60 deg on; the incidence counts as at most
/// kMaxIncidenceRad.
double axial_sigma_m(double depth_m, double incidence_rad);
/// Standard deviation (px) across it; equation of Nguyen et al., incidence limited likewise.
double lateral_sigma_px(double incidence_rad);

/// The gain that an image of this exposure takes: never below 1, where a camera exposes for less
/// time instead. An image of unknown exposure (0) takes that of the configuration.
double analogue_gain(const ShotNoiseConfig& config, float exposure);

/// The frame, without labels, that a camera with these faults delivers of what falls on it. All
/// noise is a function of (stream, pixel) alone; each kind uses a stream of its own.
/// @param truth   the image as the shutter left it (see shutter.hpp), or an exact one
/// @param stream  of this frame
/// @param gain    of the exposure control
RgbdFrame sense(const RenderedFrame& truth, const Camera& camera, const SensorConfig& config,
                RandomStream stream, Stamp stamp_ns, double gain = 1.0);

/// The labels that come with that frame; apart, since systems that see the same image may be
/// given different ones. None with a blank frame.
SemanticImage sense_labels(const RenderedFrame& truth, LabelMode mode, const SensorConfig& config,
                           const SE3& world_from_camera, RandomStream stream);

}  // namespace mh
