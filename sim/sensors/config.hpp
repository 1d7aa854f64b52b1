// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "sim/sensors/labels.hpp"
#include "slam/core/camera.hpp"
#include "slam/io/setting.hpp"

// The settings of a sensor level (sim/sensors/levels): a struct for each section of the file,
// followed by the list of its fields. Each fault can be switched on and off separately.

namespace mh {

inline constexpr double kSecondsPerMs = 1e-3;

/// Xtion/Kinect v1 depth. Axial and lateral noise: Nguyen, Izadi and Lovell, "Modeling Kinect
/// sensor noise for improved 3D reconstruction and tracking", 3DIMPVT 2012. Disparity quantization
/// and projector shadow (the projector is camera.baseline_m to the right of the camera): Khoshelham
/// and Elberink, "Accuracy and resolution of Kinect depth data", Sensors 2012. Range: ASUS Xtion
/// data sheet.
struct DepthNoiseConfig {
  bool enabled = true;            ///< off: the exact depth at any range
  bool axial = true;              ///< sigma_z(z, incidence)
  bool lateral = true;            ///< ragged edges: Gaussian lookup offsets, sigma_L(incidence) px
  bool quantization = true;       ///< 1/8 px disparity steps
  bool grazing_holes = true;      ///< no return beyond kMaxIncidenceRad
  bool projector_shadow = false;  ///< no return where the projector's light is blocked
  double min_range_m = 0.4;
  double max_range_m = 8.0;  ///< must be above min_range_m
  friend bool operator==(const DepthNoiseConfig&, const DepthNoiseConfig&) = default;
};

template <MaybeConst<DepthNoiseConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, axial, lateral, quantization, grazing_holes, projector_shadow, min_range_m,
         max_range_m] = c;
  v("enabled", enabled, setting::kSwitch, "off: the exact depth at any range");
  v("axial", axial, setting::kSwitch, "noise along the ray");
  v("lateral", lateral, setting::kSwitch, "noise perpendicular to the ray: ragged edges");
  v("quantization", quantization, setting::kSwitch, "steps of 1/8 px of disparity");
  v("grazing_holes", grazing_holes, setting::kSwitch, "no return beyond 80 degrees of incidence");
  v("projector_shadow", projector_shadow, setting::kSwitch,
    "no return where the projector's light is blocked");
  v("min_range_m", min_range_m, {0, setting::kMany}, "nearer surfaces give no return");
  v("max_range_m", max_range_m, {0, setting::kMany},
    "farther surfaces give no return; must be above min_range_m");
}

/// All depth faults off and no range limits: a base for enabling a single fault.
inline DepthNoiseConfig no_depth_noise() {
  return {.axial = false,
          .lateral = false,
          .quantization = false,
          .grazing_holes = false,
          .projector_shadow = false,
          .min_range_m = 0.0,
          .max_range_m = setting::kMany};
}

struct ColorNoiseConfig {
  bool enabled = true;
  double sigma = 0.007;  ///< Pepper's Gazebo model (pepper_robot)
  friend bool operator==(const ColorNoiseConfig&, const ColorNoiseConfig&) = default;
};

template <MaybeConst<ColorNoiseConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, sigma] = c;
  v("enabled", enabled, setting::kSwitch, "Gaussian noise in gray levels");
  v("sigma", sigma, setting::kShare, "standard deviation, as a share of full scale");
}

/// Light is counted in electrons: shot noise has variance L * well (L = linear light, 1 at white),
/// read noise has standard deviation read_noise_e; the noisy count is divided by the well, the
/// electron count of a white pixel (well_e / gain). Defaults: OV5640, from Aldebaran's
/// documentation of Pepper's 2D camera. Signal-to-noise ratio at most 36 dB: well of 10^3.6 = 3981
/// electrons. Dynamic range 68 dB: read noise of 3981 / 10^3.4 = 1.6 electrons. Model: Healey and
/// Kondepudy, PAMI 1994.
struct ShotNoiseConfig {
  bool enabled = false;
  double well_e = 3981.0;
  double read_noise_e = 1.6;
  double gain = 1.0;  ///< analog: a white pixel holds well_e / gain electrons
  /// The exposure (RenderedFrame) at which `gain` applies. At other exposures the gain scales in
  /// proportion, but never falls below 1, so dark rooms are noisier. 0: the same gain at every
  /// exposure.
  double gain_at_exposure = 0.0;
  friend bool operator==(const ShotNoiseConfig&, const ShotNoiseConfig&) = default;
};

template <MaybeConst<ShotNoiseConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, well_e, read_noise_e, gain, gain_at_exposure] = c;
  v("enabled", enabled, setting::kSwitch, "shot and read noise in linear light");
  v("well_e", well_e, setting::above(0, 1e7), "electrons of a white pixel at gain 1");
  v("read_noise_e", read_noise_e, {0, 1e6}, "electrons, standard deviation");
  v("gain", gain, {1, 1000}, "a white pixel holds well_e / gain electrons");
  v("gain_at_exposure", gain_at_exposure, {0, 1e6},
    "the exposure at which gain applies; at others, it is scaled in proportion; 0: it always "
    "applies");
}

/// Gain that follows the mean luminance with a lag, like the average-based control of OmniVision's
/// sensors (OV5647 data sheet, section 4.5): the logarithm of the gain approaches that of target /
/// mean exponentially.
struct AutoExposureConfig {
  bool enabled = false;
  double target = 0.18;
  double time_constant_s = 0.5;  ///< time constant of the lag; 0 = no lag
  double max_gain = 4.0;         ///< on top of the renderer's exposure; the minimum is 1 / max_gain
  friend bool operator==(const AutoExposureConfig&, const AutoExposureConfig&) = default;
};

template <MaybeConst<AutoExposureConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, target, time_constant_s, max_gain] = c;
  v("enabled", enabled, setting::kSwitch, "gain that follows the mean luminance with a lag");
  v("target", target, setting::above(0, 1), "mean linear luminance, as a fraction of white");
  v("time_constant_s", time_constant_s, {0, 60}, "time constant of the lag; 0: no lag");
  v("max_gain", max_gain, {1, 1000}, "maximum gain; the minimum is 1 / max_gain");
}

/// A fraction of the natural falloff, cos^4 of the angle from the axis (the rest is removed by a
/// lens shading correction).
struct VignettingConfig {
  bool enabled = false;
  double strength = 1.0;
  friend bool operator==(const VignettingConfig&, const VignettingConfig&) = default;
};

template <MaybeConst<VignettingConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, strength] = c;
  v("enabled", enabled, setting::kSwitch, "light falls off toward the corners");
  v("strength", strength, setting::kShare, "fraction of the natural cos^4 falloff");
}

/// A Gaussian point spread function, applied in linear light.
struct LensBlurConfig {
  bool enabled = false;
  double sigma_px = 0.0;
  friend bool operator==(const LensBlurConfig&, const LensBlurConfig&) = default;
};

template <MaybeConst<LensBlurConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, sigma_px] = c;
  v("enabled", enabled, setting::kSwitch, "blur of the lens");
  v("sigma_px", sigma_px, setting::required({0, 20}),
    "standard deviation of its Gaussian point spread function");
}

/// In-camera image processing: see processing.hpp.
struct ProcessingConfig {
  bool enabled = false;
  double contrast = 0.0;
  double sharpening = 0.0;
  double sharpening_px = 1.0;
  friend bool operator==(const ProcessingConfig&, const ProcessingConfig&) = default;
};

template <MaybeConst<ProcessingConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, contrast, sharpening, sharpening_px] = c;
  v("enabled", enabled, setting::kSwitch, "in-camera image processing");
  v("contrast", contrast, setting::kShare, "strength of an S-shaped tone curve; 0: sRGB alone");
  v("sharpening", sharpening, {0, 20}, "strength of unsharp masking of the luma; 0: none");
  v("sharpening_px", sharpening_px, setting::above(0, 20),
    "standard deviation of the blur in unsharp masking");
}

struct LensDistortionConfig {
  bool enabled = false;  ///< off: the camera's own lens
  Distortion lens;
  friend bool operator==(const LensDistortionConfig&, const LensDistortionConfig&) = default;
};

template <MaybeConst<LensDistortionConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, lens] = c;
  [[maybe_unused]] auto& [k1, k2, p1, p2, k3, k4, k5, k6] = lens;  // k4 to k6: no level has them
  v("enabled", enabled, setting::kSwitch, "Brown-Conrady as in OpenCV; off: the camera's own lens");
  v("k1", k1, {-2, 2}, "radial");
  v("k2", k2, {-2, 2}, "radial");
  v("p1", p1, {-0.2, 0.2}, "tangential");
  v("p2", p2, {-0.2, 0.2}, "tangential");
  v("k3", k3, {-2, 2}, "radial");
}

// Exposure timing, along the true motion. Row y of h rows is exposed for exposure_s(), centered on
// stamp + ((y + 1/2) / h - 1/2) * readout_s(): the stamp is the middle of the image's exposure.

struct MotionBlurConfig {
  bool enabled = false;
  double exposure_ms = 20.0;
  double exposure_s() const { return enabled ? kSecondsPerMs * exposure_ms : 0.0; }
  friend bool operator==(const MotionBlurConfig&, const MotionBlurConfig&) = default;
};

template <MaybeConst<MotionBlurConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, exposure_ms] = c;
  v("enabled", enabled, setting::kSwitch, "images are integrated along the true motion");
  v("exposure_ms", exposure_ms, {0, 1000}, "how long each row collects light");
}

struct RollingShutterConfig {
  bool enabled = false;
  /// Default: the Kinect's color camera, Ringaby and Forssen, "Scan rectification for structured
  /// light range sensors with rolling shutters", ICCV 2011.
  double readout_ms = 26.1;
  double readout_s() const { return enabled ? kSecondsPerMs * readout_ms : 0.0; }
  friend bool operator==(const RollingShutterConfig&, const RollingShutterConfig&) = default;
};

template <MaybeConst<RollingShutterConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, readout_ms] = c;
  v("enabled", enabled, setting::kSwitch, "rows are read out one after another");
  v("readout_ms", readout_ms, {0, 1000}, "from the first row to the last");
}

struct DepthOffsetConfig {
  bool enabled = false;
  double offset_ms = 0.0;
  double offset_s() const { return enabled ? kSecondsPerMs * offset_ms : 0.0; }
  friend bool operator==(const DepthOffsetConfig&, const DepthOffsetConfig&) = default;
};

template <MaybeConst<DepthOffsetConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, offset_ms] = c;
  v("enabled", enabled, setting::kSwitch, "depth and color are captured at different times");
  v("offset_ms", offset_ms, setting::required({-1000, 1000}),
    "how much later than the stamp the depth is captured");
}

/// Systematic errors of a depth camera that remain after its calibration, the same in every frame;
/// see depth_bias.hpp. Neutral by default.
struct DepthBiasConfig {
  bool enabled = false;
  /// TUM's Kinects before their authors corrected them: 1.035 (freiburg1), 1.031 (freiburg2).
  double scale = 1.0;
  /// TUM fr1 after that correction: 0.01 (docs/measurements/tracking.md). Teichman, Miller and
  /// Thrun (CLAMS, RSS 2013) learn multipliers of this kind, which vary over image and distance.
  double bend = 0.0;
  std::uint64_t camera = 0;
  double shift_x_px = 0.0, shift_y_px = 0.0;
  friend bool operator==(const DepthBiasConfig&, const DepthBiasConfig&) = default;
};

template <MaybeConst<DepthBiasConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, scale, bend, camera, shift_x_px, shift_y_px] = c;
  v("enabled", enabled, setting::kSwitch, "systematic errors of depth");
  v("scale", scale, {0.5, 2}, "factor on all depths");
  v("bend", bend, {0, 0.2},
    "root mean square of (multiplier - 1); the multiplier varies smoothly over the image and with "
    "distance");
  v("camera", camera, setting::kSeed, "which camera: seed of the multiplier's shape");
  v("shift_x_px", shift_x_px, {-50, 50}, "a pixel reads the depth this far to its right");
  v("shift_y_px", shift_y_px, {-50, 50}, "and this far below it");
}

/// The fraction of frames that are blank (black, without depth and labels) or never arrive.
struct LostFramesConfig {
  bool enabled = false;
  double share = 0.0;
  double lost() const { return enabled ? share : 0.0; }
  friend bool operator==(const LostFramesConfig&, const LostFramesConfig&) = default;
};

template <MaybeConst<LostFramesConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, share] = c;
  v("enabled", enabled, setting::kSwitch, "whether frames are lost");
  v("share", share, setting::required(setting::kShare),
    "fraction of frames that arrive black (blank) or not at all (dropped)");
}

/// Light of the scene that reaches the sensor: less of it leaves fewer electrons, so the noise
/// weighs more. Flicker: lamps on alternating current vary at twice its frequency, and a camera
/// that is not in step with them records frames of different brightness.
struct LightConfig {
  bool enabled = false;
  double share = 1.0;
  double flicker = 0.0;
  friend bool operator==(const LightConfig&, const LightConfig&) = default;
};

template <MaybeConst<LightConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, share, flicker] = c;
  v("enabled", enabled, setting::kSwitch, "light that reaches the sensor");
  v("share", share, setting::kShare, "share of the scene's light");
  v("flicker", flicker, setting::kOpenShare,
    "amplitude by which the light of a frame varies, at a random phase in each frame");
}

/// Spots on the lens, out of focus: soft disks, the same in every frame. See lens_dirt.hpp.
struct LensDirtConfig {
  bool enabled = false;
  double share = 0.0;
  std::uint64_t lens = 0;
  friend bool operator==(const LensDirtConfig&, const LensDirtConfig&) = default;
};

template <MaybeConst<LensDirtConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, share, lens] = c;
  v("enabled", enabled, setting::kSwitch, "spots on the lens of the color camera");
  v("share", share, setting::kShare,
    "share of the image behind spots, which let 1/10 of the light "
    "through");
  v("lens", lens, setting::kSeed, "which lens: seed of the spots");
}

/// Compression of the color image for transport: ROS's compressed_image_transport sends JPEG of
/// quality 80 by default, many drivers less.
struct JpegConfig {
  bool enabled = false;
  int loss = 0;
  friend bool operator==(const JpegConfig&, const JpegConfig&) = default;
};

template <MaybeConst<JpegConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, loss] = c;
  v("enabled", enabled, setting::kSwitch, "color images are compressed as JPEG");
  v("loss", loss, {0, 99}, "100 - quality; 0: not compressed");
}

/// Faults that depth has in addition to those of its sensor (depth_noise); all are none at 0.
struct DepthFaultsConfig {
  bool enabled = false;
  double noise = 0.0;
  double edges = 0.0;
  double holes = 0.0;
  friend bool operator==(const DepthFaultsConfig&, const DepthFaultsConfig&) = default;
};

template <MaybeConst<DepthFaultsConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, noise, edges, holes] = c;
  v("enabled", enabled, setting::kSwitch, "more faults of depth");
  v("noise", noise, {0, 1000},
    "noise along the ray, as a multiple of a Kinect's (depth_noise.axial)");
  v("edges", edges, {0, 100}, "ragged edges, as a multiple of a Kinect's (depth_noise.lateral)");
  v("holes", holes, setting::kShare,
    "share of patches of 16 x 16 px without depth, others in each frame");
}

/// How frames are delivered. See sim/simulation/faulty_sequence.hpp.
struct FeedConfig {
  bool enabled = false;
  int keep_every = 1;
  double stuck = 0.0;
  double jitter_ms = 0.0;
  bool backward = false;
  friend bool operator==(const FeedConfig&, const FeedConfig&) = default;
};

template <MaybeConst<FeedConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, keep_every, stuck, jitter_ms, backward] = c;
  v("enabled", enabled, setting::kSwitch, "how frames are delivered");
  v("keep_every", keep_every, setting::kCount, "1: all frames, 2: every second, ...");
  v("stuck", stuck, setting::kShare, "share of frames with the images of the frame before");
  v("jitter_ms", jitter_ms, {0, 1000},
    "standard deviation of the stamps' errors; stamps still increase");
  v("backward", backward, setting::kSwitch,
    "the last frame comes first, as if the camera had gone back; without other senses");
}

/// The calibration that is handed over with the frames, where it is wrong. The images stay.
struct ToldConfig {
  bool enabled = false;
  double focal = 1.0;
  double center_px = 0.0;
  double k1 = 0.0;
  friend bool operator==(const ToldConfig&, const ToldConfig&) = default;
};

template <MaybeConst<ToldConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, focal, center_px, k1] = c;
  v("enabled", enabled, setting::kSwitch, "systems are told a wrong calibration");
  v("focal", focal, {0.2, 5}, "factor on the focal lengths");
  v("center_px", center_px, {-1000, 1000}, "error of the principal point, to the right and down");
  v("k1", k1, {-1, 1}, "error of the first radial coefficient of the lens");
}

/// A handheld camera covers its path in less time: hurried(), sim/simulation/travel.hpp.
struct HurryConfig {
  bool enabled = false;
  double speed = 1.0;  ///< multiple of the path's own speed
  double factor() const { return enabled ? speed : 1.0; }
  friend bool operator==(const HurryConfig&, const HurryConfig&) = default;
};

template <MaybeConst<HurryConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, speed] = c;
  v("enabled", enabled, setting::kSwitch, "a handheld camera moves faster along its path");
  v("speed", speed, setting::required({1, 10}),
    "multiple of the path's own speed; a driving robot keeps its speed");
}

/// How finely motion within a frame is sampled: the image is the mean, in linear light, of images
/// along the motion. This controls the accuracy of the simulation; it is not a sensor fault, so
/// levels do not set it.
struct MotionSampling {
  double step_px = 1.5;   ///< maximum motion between two images, unless max_images is reached
  int max_images = 33;    ///< maximum number of images
  double sharp_px = 0.5;  ///< up to this much motion within a frame, one image is enough
  friend bool operator==(const MotionSampling&, const MotionSampling&) = default;
};

/// An inertial sensor in the camera's housing. Defaults: noise of the Bosch BMI055 (data sheet:
/// 0.014 deg/s/sqrt(Hz), 150 ug/sqrt(Hz), zero-rate offset 1 deg/s), as in Intel's D435i; bias
/// walks of the ADIS16448 from EuRoC's sensor.yaml (Burri et al., IJRR 2016); an accelerometer
/// offset as in that data set's ground truth.
struct ImuConfig {
  double rate_hz = 200;
  double gyro_noise = 2.44e-4;   ///< rad/s/sqrt(Hz)
  double gyro_walk = 1.94e-5;    ///< walk of the bias, rad/s^2/sqrt(Hz)
  double gyro_bias = 0.0175;     ///< bias at the start, rad/s
  double accel_noise = 1.47e-3;  ///< m/s^2/sqrt(Hz)
  double accel_walk = 3.0e-3;    ///< walk of the bias, m/s^3/sqrt(Hz)
  double accel_bias = 0.1;       ///< bias at the start, m/s^2
  friend bool operator==(const ImuConfig&, const ImuConfig&) = default;
};

template <MaybeConst<ImuConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [rate_hz, gyro_noise, gyro_walk, gyro_bias, accel_noise, accel_walk, accel_bias] = c;
  v("rate_hz", rate_hz, {10, 2000}, "readings per second, in suites that provide them");
  v("gyro_noise", gyro_noise, {0, 1}, "rad/s/sqrt(Hz)");
  v("gyro_walk", gyro_walk, {0, 1}, "random walk of the bias, rad/s^2/sqrt(Hz)");
  v("gyro_bias", gyro_bias, {0, 10}, "standard deviation of the bias at the start, rad/s");
  v("accel_noise", accel_noise, {0, 10}, "m/s^2/sqrt(Hz)");
  v("accel_walk", accel_walk, {0, 10}, "random walk of the bias, m/s^3/sqrt(Hz)");
  v("accel_bias", accel_bias, {0, 100}, "standard deviation of the bias at the start, m/s^2");
}

struct SensorConfig {
  DepthNoiseConfig depth_noise;
  ColorNoiseConfig color_noise;
  ShotNoiseConfig shot_noise;
  AutoExposureConfig auto_exposure;
  VignettingConfig vignetting;
  LensBlurConfig lens_blur;
  ProcessingConfig processing;
  LensDistortionConfig lens_distortion;
  MotionBlurConfig motion_blur;
  RollingShutterConfig rolling_shutter;
  DepthOffsetConfig depth_offset;
  DepthBiasConfig depth_bias;
  LostFramesConfig blank_frames;    ///< arrive black, without depth and labels
  LostFramesConfig dropped_frames;  ///< never arrive
  HurryConfig hurry;
  LightConfig light;
  LensDirtConfig lens_dirt;
  JpegConfig jpeg;
  DepthFaultsConfig depth_faults;
  FeedConfig feed;
  ToldConfig told;
  ImuConfig imu;
  LabelConfig labels;
  MotionSampling motion_sampling;
  friend bool operator==(const SensorConfig&, const SensorConfig&) = default;
};

/// Calls visit.section(name) before each section of a level and visit(name, value, range, note) for
/// each field.
template <MaybeConst<SensorConfig> C, class Visit>
void for_each_setting(C& config, Visit&& visit) {
  [[maybe_unused]] auto& [depth_noise, color_noise, shot_noise, auto_exposure, vignetting,
                          lens_blur, processing, lens_distortion, motion_blur, rolling_shutter,
                          depth_offset, depth_bias, blank_frames, dropped_frames, hurry, light,
                          lens_dirt, jpeg, depth_faults, feed, told, imu, labels, motion_sampling] =
      config;
  const auto part = [&](const char* name, auto& c) {
    visit.section(name);
    fields(c, visit);
  };
  part("depth_noise", depth_noise);
  part("color_noise", color_noise);
  part("shot_noise", shot_noise);
  part("auto_exposure", auto_exposure);
  part("vignetting", vignetting);
  part("lens_blur", lens_blur);
  part("processing", processing);
  part("lens_distortion", lens_distortion);
  part("motion_blur", motion_blur);
  part("rolling_shutter", rolling_shutter);
  part("depth_offset", depth_offset);
  part("depth_bias", depth_bias);
  part("blank_frames", blank_frames);
  part("dropped_frames", dropped_frames);
  part("hurry", hurry);
  part("light", light);
  part("lens_dirt", lens_dirt);
  part("jpeg", jpeg);
  part("depth_faults", depth_faults);
  part("feed", feed);
  part("told", told);
  part("imu", imu);
  for_each_setting(labels, visit);
}

/// What does not fit together in a level: a section and why.
struct Contradiction {
  const char *section, *why;
};
std::optional<Contradiction> contradiction_in(const SensorConfig& config);

/// No noise at all: the default if no level is specified.
SensorConfig exact_sensors();

/// Reads a level (YAML, see sim/sensors/levels): depth_noise and color_noise are required; a
/// section that is present is on unless it contains `enabled: false`. @throws InputError naming
/// file, line, field, value.
SensorConfig load_sensor_config(const std::filesystem::path& file);
/// Parses a level from text; `name` names the file in messages.
SensorConfig parse_sensor_config(const std::string& text, const std::string& name);

/// Formats a level that load_sensor_config() reads back bit for bit; with notes, each line states
/// its meaning and valid values.
std::string format_sensor_config(const SensorConfig& config, bool notes = false);

}  // namespace mh
