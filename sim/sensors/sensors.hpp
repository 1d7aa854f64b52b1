// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "sim/render/renderer.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// Xtion/Kinect v1 depth. Axial and lateral noise: Nguyen, Izadi and Lovell, 3DIMPVT 2012;
/// disparity quantisation: Khoshelham and Elberink, Sensors 2012; range: ASUS Xtion data sheet.
struct DepthNoiseConfig {
  bool axial = true;            ///< sigma_z(z, incidence)
  bool lateral = true;          ///< ragged edges, px
  bool quantisation = true;     ///< 1/8 px disparity steps
  bool grazing_holes = true;    ///< no return where the surface is nearly edge-on
  double min_range_m = 0.4;
  double max_range_m = 8.0;
};

struct ColourNoiseConfig {
  double sigma = 0.007;  ///< Gaussian, of full scale (Pepper's Gazebo model, pepper_robot)
};

/// How labels come to the frame.
enum class LabelMode { kNone, kExact, kBoxes };

struct SensorConfig {
  bool depth_noise_on = true;
  DepthNoiseConfig depth_noise;
  bool colour_noise_on = true;
  ColourNoiseConfig colour_noise;
};

/// The frame that a camera with these faults would deliver for an exact picture. All noise is a
/// function of (stream, pixel) alone.
RgbdFrame sense(const RenderedFrame& truth, const Camera& camera, const SensorConfig& config,
                LabelMode labels, RandomStream stream, Stamp stamp_ns);

/// kExact: one-hot class per pixel. kBoxes: the exact bounding box of each visible instance of a
/// COCO class is filled with its class (smaller boxes over larger ones), all else is background.
SemanticImage label_image(const RenderedFrame& truth, LabelMode mode);

}  // namespace mh
