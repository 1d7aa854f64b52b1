// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string_view>

#include "sim/sensors/config.hpp"
#include "slam/io/settings_io.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

/// A section that is present is on unless it says otherwise.
class LevelReader : public SettingsReader {
 public:
  using SettingsReader::SettingsReader;
  using SettingsReader::operator();

  void operator()(const char* key, bool& value, const SettingRange& range, const char* note) {
    if (place() && key == std::string_view("enabled")) value = true;
    SettingsReader::operator()(key, value, range, note);
  }
};

}  // namespace

std::optional<Contradiction> contradiction_in(const SensorConfig& config) {
  if (config.depth_noise.max_range_m <= config.depth_noise.min_range_m)
    return {{"depth_noise", "max_range_m must be above min_range_m"}};
  if (config.labels.persistent_share + config.labels.frame_share > 1.0)
    return {{"label_noise", "persistent_share and frame_share sum to more than 1"}};
  return std::nullopt;
}

SensorConfig exact_sensors() {
  SensorConfig config;
  config.depth_noise.enabled = config.color_noise.enabled = false;
  return config;
}

SensorConfig parse_sensor_config(const std::string& text, const std::string& name) {
  YamlReader level = YamlReader::parse(text, name);
  // Required, so that every level decides for or against noise explicitly.
  for (const char* section : {"depth_noise", "color_noise"}) level.at(section);
  SensorConfig config;
  LevelReader reader(level);
  for_each_setting(config, reader);
  reader.finish();
  if (const auto wrong = contradiction_in(config)) level.at(wrong->section).fail(wrong->why);
  level.finish();
  return config;
}

SensorConfig load_sensor_config(const std::filesystem::path& file) {
  return parse_sensor_config(read_text(file), file.string());
}

std::string format_sensor_config(const SensorConfig& config, bool notes) {
  SettingsWriter writer(notes);
  for_each_setting(config, writer);
  return writer.text();
}

}  // namespace mh
