// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "sim/render/renderer.hpp"
#include "sim/sensors/labels.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// Xtion/Kinect v1 depth. Axial and lateral noise: Nguyen, Izadi and Lovell, "Modeling Kinect
/// sensor noise for improved 3D reconstruction and tracking", 3DIMPVT 2012; disparity
/// quantization and the shadow of the projector, which stands camera.baseline_m to the right of the
/// camera: Khoshelham and Elberink, "Accuracy and resolution of Kinect depth data", Sensors 2012;
/// range: ASUS Xtion data sheet. Each on or off alone.
struct DepthNoiseConfig {
  bool axial = true;              ///< sigma_z(z, incidence)
  bool lateral = true;            ///< ragged edges: the lookup strays by sigma_L(incidence), px
  bool quantization = true;       ///< 1/8 px disparity steps
  bool grazing_holes = true;      ///< no return beyond kMaxIncidenceRad
  bool projector_shadow = false;  ///< no return where the projector does not shine
  double min_range_m = 0.4;       ///< nearer surfaces give no return; 0 or more
  double max_range_m = 8.0;       ///< farther ones neither; above min_range_m
};

/// The exact depth at any range: everything off, for switching on one fault alone.
inline DepthNoiseConfig no_depth_noise() {
  return {.axial = false,
          .lateral = false,
          .quantization = false,
          .grazing_holes = false,
          .projector_shadow = false,
          .min_range_m = 0.0,
          .max_range_m = 1e6};
}

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

struct ColorNoiseConfig {
  double sigma = 0.007;  ///< Gaussian, of full scale, 0 to 1 (Pepper's Gazebo model, pepper_robot)
};

/// Light is counted in electrons: shot noise of variance L * well, read noise, both divided by the
/// well of a white pixel. Defaults: OV5640 as Aldebaran's documentation of Pepper's 2D camera gives
/// it: signal to noise at most 36 dB, so a well of 10^3.6 = 3981 electrons; dynamic range 68 dB, so
/// 3981 / 10^3.4 = 1.6 electrons of read noise. Model: Healey and Kondepudy, PAMI 1994.
struct ShotNoiseConfig {
  double well_e = 3981.0;  ///< electrons of a white pixel at gain 1, above 0
  double read_noise_e = 1.6;
  double gain = 1.0;  ///< analogue: a white pixel holds well_e / gain electrons; 1 or more
  /// The exposure (RenderedFrame) that takes this gain; others take theirs in proportion: dark
  /// rooms are noisier. 0: all take this one.
  double gain_at_exposure = 0.0;
};

/// The gain that a picture of this exposure takes: never below 1, where a camera exposes for less
/// time instead. A picture of unknown exposure (0) takes that of the configuration.
double analogue_gain(const ShotNoiseConfig& config, float exposure);

/// When light is collected, from the true motion. Row y of h is exposed for exposure_s around
/// stamp + ((y + 1/2) / h - 1/2) readout_s: the stamp is the middle of the picture's exposure.
struct ShutterConfig {
  bool motion_blur_on = false;
  double exposure_s = 0.020;  ///< above 0
  bool rolling_shutter_on = false;
  /// From the first row to the last. Default: the Kinect's color camera, Ringaby and Forssen,
  /// "Scan rectification for structured light range sensors with rolling shutters", ICCV 2011.
  double readout_s = 0.0261;
  // The picture is the mean of pictures along the motion, in linear light; between two of them
  // nothing moves farther than step_px unless there would be more than max_pictures of them.
  // Motion of less than sharp_px within a frame is not worth a second picture.
  double step_px = 1.5;
  double sharp_px = 0.5;
  int max_pictures = 33;
};

/// Gain that follows the mean luminance with a lag, as the average-based control of OmniVision's
/// sensors does (OV5647 data sheet, section 4.5): the logarithm of the gain nears that of
/// target / mean exponentially.
struct AutoExposureConfig {
  double target = 0.18;          ///< mean linear luminance aimed at, above 0
  double time_constant_s = 0.5;  ///< of the lag; 0 = none
  double max_gain = 4.0;         ///< beside the renderer's exposure; the least is its inverse
};

/// A share of the natural falloff cos^4 of the angle from the axis (what a lens shading correction
/// leaves of it).
struct VignettingConfig {
  double strength = 1.0;  ///< 0 to 1
};

/// What the camera does with its sensor's picture: see processing.hpp.
struct ProcessingConfig {
  double contrast = 0.0;       ///< of its tone curve, 0 to 1; 0 = none beyond sRGB
  double sharpening = 0.0;     ///< 0 = none
  double sharpening_px = 1.0;  ///< standard deviation of the blur that is compared with, above 0
};

struct SensorConfig {
  bool depth_noise_on = true;  ///< off: the exact depth at any range
  DepthNoiseConfig depth_noise;
  bool color_noise_on = true;
  ColorNoiseConfig color_noise;
  bool shot_noise_on = false;
  ShotNoiseConfig shot_noise;
  ShutterConfig shutter;
  bool auto_exposure_on = false;
  AutoExposureConfig auto_exposure;
  bool vignetting_on = false;
  VignettingConfig vignetting;
  ProcessingConfig processing;  ///< does nothing by itself
  double lens_blur_px = 0.0;    ///< standard deviation of its point spread, 0 = none
  bool lens_distortion_on = false;
  Distortion lens_distortion;   ///< off: the camera's own, as it comes
  double depth_offset_s = 0.0;  ///< the depth is that of so much later than the stamp
  double blank_share = 0.0;     ///< of frames that arrive black, without depth and labels
  double dropped_share = 0.0;   ///< of frames that never arrive
  LabelConfig labels;
};

/// Reads a level (YAML, see sim/sensors/levels). @throws InputError naming file, line, field,
/// value.
SensorConfig load_sensor_config(const std::filesystem::path& file);

/// The frame, without labels, that a camera with these faults delivers of what falls on it. All
/// noise is a function of (stream, pixel) alone; each kind uses a stream of its own.
/// @param truth   the picture as the shutter left it (see shutter.hpp), or an exact one
/// @param stream  of this frame
/// @param gain    of the exposure control
RgbdFrame sense(const RenderedFrame& truth, const Camera& camera, const SensorConfig& config,
                RandomStream stream, Stamp stamp_ns, double gain = 1.0);

/// The labels that come with that frame; apart, since systems that see the same picture may be
/// given different ones. None with a blank frame.
SemanticImage sense_labels(const RenderedFrame& truth, LabelMode mode, const SensorConfig& config,
                           const SE3& world_from_camera, RandomStream stream);

}  // namespace mh
