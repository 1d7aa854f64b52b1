// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/sensors.hpp"
#include "slam/core/yaml.hpp"

namespace mh {

SensorConfig load_sensor_config(const std::filesystem::path& file) {
  YamlReader reader = YamlReader::load(file);
  SensorConfig config;

  YamlReader depth = reader.at("depth_noise");
  config.depth_noise_on = depth.boolean("enabled", config.depth_noise_on);
  DepthNoiseConfig& d = config.depth_noise;
  d.axial = depth.boolean("axial", d.axial);
  d.lateral = depth.boolean("lateral", d.lateral);
  d.quantisation = depth.boolean("quantisation", d.quantisation);
  d.grazing_holes = depth.boolean("grazing_holes", d.grazing_holes);
  d.min_range_m = depth.number_or("min_range_m", d.min_range_m, 0.0);
  d.max_range_m = depth.number_or("max_range_m", d.max_range_m, 0.0);
  if (d.max_range_m <= d.min_range_m) depth.fail("max_range_m must be above min_range_m");
  depth.finish();

  YamlReader colour = reader.at("colour_noise");
  config.colour_noise_on = colour.boolean("enabled", config.colour_noise_on);
  config.colour_noise.sigma = colour.number_or("sigma", config.colour_noise.sigma, 0.0, 1.0);
  colour.finish();

  reader.finish();
  return config;
}

}  // namespace mh
