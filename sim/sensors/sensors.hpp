// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "sim/render/renderer.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// Xtion/Kinect v1 depth. Axial and lateral noise: Nguyen, Izadi and Lovell, "Modeling Kinect
/// sensor noise for improved 3D reconstruction and tracking", 3DIMPVT 2012; disparity quantisation:
/// Khoshelham and Elberink, Sensors 2012; range: ASUS Xtion data sheet. Each on or off alone.
struct DepthNoiseConfig {
  bool axial = true;          ///< sigma_z(z, incidence)
  bool lateral = true;        ///< ragged edges: the lookup strays by sigma_L(incidence), px
  bool quantisation = true;   ///< 1/8 px disparity steps
  bool grazing_holes = true;  ///< no return beyond kMaxIncidenceRad
  double min_range_m = 0.4;   ///< nearer surfaces give no return; 0 or more
  double max_range_m = 8.0;   ///< farther ones neither; above min_range_m
};

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

struct ColourNoiseConfig {
  double sigma = 0.007;  ///< Gaussian, of full scale, 0 to 1 (Pepper's Gazebo model, pepper_robot)
};

/// How labels come to the frame.
enum class LabelMode { kNone, kExact, kBoxes };

struct SensorConfig {
  bool depth_noise_on = true;  ///< off: the exact depth at any range
  DepthNoiseConfig depth_noise;
  bool colour_noise_on = true;
  ColourNoiseConfig colour_noise;
};

/// Reads a level (YAML, see sim/sensors/levels). @throws InputError naming file, line, field,
/// value.
SensorConfig load_sensor_config(const std::filesystem::path& file);

/// The frame that a camera with these faults would deliver for an exact picture. All noise is a
/// function of (stream, pixel) alone; depth and colour use streams of their own.
RgbdFrame sense(const RenderedFrame& truth, const Camera& camera, const SensorConfig& config,
                LabelMode labels, RandomStream stream, Stamp stamp_ns);

/// A detector needs to see this much of an object before its box counts.
inline constexpr int kMinBoxPixels = 100;

/// kExact: one-hot class per pixel. kBoxes: the exact bounding box of the visible pixels of each
/// instance of a COCO class, at least kMinBoxPixels of them, is filled with its class (smaller
/// boxes over larger ones, higher instance ids over lower where equal); all else is background.
/// kNone: an empty image.
SemanticImage label_image(const RenderedFrame& truth, LabelMode mode);

}  // namespace mh
