// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include <fmt/format.h>

#include "sim/sensors/sensors.hpp"
#include "slam/core/yaml.hpp"

namespace mh {
namespace {

constexpr double kMs = 1e-3;

/// Reads a section with its `enabled`; absent sections leave everything as it is, sections that are
/// there are on unless they say otherwise.
void section(YamlReader& file, const char* key, bool& on,
             const std::function<void(YamlReader&)>& read) {
  std::optional<YamlReader> node = file.find(key);
  if (!node) return;
  on = node->boolean("enabled", true);
  read(*node);
  node->finish();
}

/// A number above a bound that itself is none.
double above(YamlReader& node, const char* key, double fallback, double bound, double max) {
  const double value = node.number_or(key, fallback, bound, max);
  if (value <= bound) node.at(key).fail(fmt::format("{:g} is not above {:g}", value, bound));
  return value;
}

void read_depth_noise(YamlReader node, SensorConfig& config) {
  config.depth_noise_on = node.boolean("enabled", config.depth_noise_on);
  DepthNoiseConfig& d = config.depth_noise;
  d.axial = node.boolean("axial", d.axial);
  d.lateral = node.boolean("lateral", d.lateral);
  d.quantization = node.boolean("quantization", d.quantization);
  d.grazing_holes = node.boolean("grazing_holes", d.grazing_holes);
  d.projector_shadow = node.boolean("projector_shadow", d.projector_shadow);
  d.min_range_m = node.number_or("min_range_m", d.min_range_m, 0.0);
  d.max_range_m = node.number_or("max_range_m", d.max_range_m, 0.0);
  if (d.max_range_m <= d.min_range_m) node.fail("max_range_m must be above min_range_m");
  node.finish();
}

void read_color(YamlReader& file, SensorConfig& config) {
  YamlReader gray = file.at("color_noise");
  config.color_noise_on = gray.boolean("enabled", config.color_noise_on);
  config.color_noise.sigma = gray.number_or("sigma", config.color_noise.sigma, 0.0, 1.0);
  gray.finish();
  section(file, "shot_noise", config.shot_noise_on, [&](YamlReader& node) {
    ShotNoiseConfig& c = config.shot_noise;
    c.well_e = above(node, "well_e", c.well_e, 0.0, 1e7);
    c.read_noise_e = node.number_or("read_noise_e", c.read_noise_e, 0.0, 1e6);
    c.gain = node.number_or("gain", c.gain, 1.0, 1000.0);
    c.gain_at_exposure = node.number_or("gain_at_exposure", c.gain_at_exposure, 0.0, 1e6);
  });
  section(file, "auto_exposure", config.auto_exposure_on, [&](YamlReader& node) {
    AutoExposureConfig& c = config.auto_exposure;
    c.target = above(node, "target", c.target, 0.0, 1.0);
    c.time_constant_s = node.number_or("time_constant_s", c.time_constant_s, 0.0, 60.0);
    c.max_gain = node.number_or("max_gain", c.max_gain, 1.0, 1000.0);
  });
  section(file, "vignetting", config.vignetting_on, [&](YamlReader& node) {
    config.vignetting.strength = node.number_or("strength", config.vignetting.strength, 0.0, 1.0);
  });
  bool blurred = false;
  section(file, "lens_blur", blurred, [&](YamlReader& node) {
    const double sigma_px = node.number("sigma_px", 0.0, 20.0);
    config.lens_blur_px = blurred ? sigma_px : 0.0;
  });
  bool processed = false;
  section(file, "processing", processed, [&](YamlReader& node) {
    ProcessingConfig c;
    c.contrast = node.number_or("contrast", c.contrast, 0.0, 1.0);
    c.sharpening = node.number_or("sharpening", c.sharpening, 0.0, 20.0);
    c.sharpening_px = above(node, "sharpening_px", c.sharpening_px, 0.0, 20.0);
    if (processed) config.processing = c;
  });
  section(file, "lens_distortion", config.lens_distortion_on, [&](YamlReader& node) {
    Distortion& d = config.lens_distortion;
    d.k1 = node.number_or("k1", d.k1, -2.0, 2.0);
    d.k2 = node.number_or("k2", d.k2, -2.0, 2.0);
    d.p1 = node.number_or("p1", d.p1, -0.2, 0.2);
    d.p2 = node.number_or("p2", d.p2, -0.2, 0.2);
    d.k3 = node.number_or("k3", d.k3, -2.0, 2.0);
  });
}

void read_timing(YamlReader& file, SensorConfig& config) {
  ShutterConfig& shutter = config.shutter;
  section(file, "motion_blur", shutter.motion_blur_on, [&](YamlReader& node) {
    shutter.exposure_s = kMs * above(node, "exposure_ms", shutter.exposure_s / kMs, 0.0, 1000.0);
  });
  section(file, "rolling_shutter", shutter.rolling_shutter_on, [&](YamlReader& node) {
    shutter.readout_s = kMs * above(node, "readout_ms", shutter.readout_s / kMs, 0.0, 1000.0);
  });
  bool on = false;
  section(file, "depth_offset", on, [&](YamlReader& node) {
    const double offset_s = kMs * node.number("offset_ms", -1000.0, 1000.0);
    config.depth_offset_s = on ? offset_s : 0.0;
  });
  section(file, "blank_frames", on, [&](YamlReader& node) {
    const double share = node.number("share", 0.0, 1.0);
    config.blank_share = on ? share : 0.0;
  });
  section(file, "dropped_frames", on, [&](YamlReader& node) {
    const double share = node.number("share", 0.0, 1.0);
    config.dropped_share = on ? share : 0.0;
  });
}

void read_labels(YamlReader& file, LabelConfig& config) {
  bool on = false;
  LabelNoiseConfig noise;
  section(file, "label_noise", on, [&](YamlReader& node) {
    noise.confusion = node.number_or("confusion", noise.confusion, 0.0, 1.0);
    noise.swap = node.number_or("swap", noise.swap, 0.0, 1.0);
    noise.dropout = node.number_or("dropout", noise.dropout, 0.0, 1.0);
    noise.erosion_px = static_cast<int>(node.integer_or("erosion_px", noise.erosion_px, 0, 1000));
    config.seed = static_cast<std::uint64_t>(node.integer_or("seed", 0, 0, INT64_MAX));
    config.persistent_share = node.number_or("persistent_share", config.persistent_share, 0.0, 1.0);
    config.frame_share = node.number_or("frame_share", config.frame_share, 0.0, 1.0);
    if (config.persistent_share + config.frame_share > 1.0)
      node.fail("persistent_share and frame_share sum to more than 1");
  });
  if (on) config.noise = noise;
  DetectorConfig& d = config.detector;
  if (std::optional<YamlReader> node = file.find("detector")) {
    d.recall_small = node->number_or("recall_small", d.recall_small, 0.0, 1.0);
    d.recall_medium = node->number_or("recall_medium", d.recall_medium, 0.0, 1.0);
    d.recall_large = node->number_or("recall_large", d.recall_large, 0.0, 1.0);
    d.confusion = node->number_or("confusion", d.confusion, 0.0, 1.0);
    d.false_alarms = node->number_or("false_alarms", d.false_alarms, 0.0, 8.0);
    d.box_sigma = node->number_or("box_sigma", d.box_sigma, 0.0, 1.0);
    node->finish();
  }
}

}  // namespace

SensorConfig load_sensor_config(const std::filesystem::path& file) {
  YamlReader reader = YamlReader::load(file);
  SensorConfig config;
  read_depth_noise(reader.at("depth_noise"), config);
  read_color(reader, config);
  read_timing(reader, config);
  read_labels(reader, config.labels);
  reader.finish();
  return config;
}

}  // namespace mh
