// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/recorded_camera.hpp"

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {

RecordedCamera recorded_camera(const Settings& settings) {
  return {settings.camera, settings.depth_per_meter, settings.exchange_red_blue};
}

std::function<RecordedCamera(const std::filesystem::path&)> camera_reader(Settings* read) {
  return [read](const std::filesystem::path& file) {
    const Settings settings = load_settings(file);
    if (!settings.has_camera)
      throw InputError(fmt::format("{}: key 'camera' is missing", file.string()));
    if (read != nullptr) *read = settings;
    return recorded_camera(settings);
  };
}

bool settings_have_camera(const std::filesystem::path& file) {
  return load_settings(file).has_camera;
}

std::optional<double> stated_depth_per_meter(const std::filesystem::path& file) {
  const Settings settings = load_settings(file);
  if (!settings.has_depth_per_meter) return std::nullopt;
  return settings.depth_per_meter;
}

RecordingConfig with_settings(RecordingConfig config, Settings* read) {
  config.read_camera = camera_reader(read);
  config.has_camera = settings_have_camera;
  config.depth_per_meter = stated_depth_per_meter;
  return config;
}

OpenedRecording open_recorded(const Environment& environment, const std::string& sequence,
                              bool labels, Settings* read) {
  return open_sequence(sequence, with_settings({.calibration = environment.settings.value_or(""),
                                                .classes = environment.classes.value_or(""),
                                                .labels = labels,
                                                .topics = environment.topics,
                                                .whole = true},
                                               read));
}

RecordedCamera load_recorded_camera(const std::filesystem::path& file) {
  return recorded_camera(load_settings(file));
}

}  // namespace mh
