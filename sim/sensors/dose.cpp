// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/dose.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/setting_by_name.hpp"
#include "slam/io/settings_io.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

/// The section of a full name: "motion_blur" of "motion_blur.exposure_ms".
std::string_view section_of(std::string_view name) {
  return name.substr(0, name.find('.'));
}

void set(SensorConfig& level, const Dose& dose) {
  if (!is_dial(dose.dial)) throw InputError(fmt::format("'{}' {}", dose.dial, no_dial(dose.dial)));
  at_setting(level, dose.dial, [&]<class T>(T& value, const SettingRange& range, const char*) {
    if constexpr (std::is_same_v<T, bool>) {
      if (dose.value != 0 && dose.value != 1)
        throw InputError(fmt::format("{} = {}: a switch is 0 or 1", dose.dial, dose.value));
      value = dose.value != 0;
    } else if constexpr (kIsNumber<T>) {
      if (!allows(range, dose.value))
        throw InputError(
            fmt::format("{} = {} is outside {}", dose.dial, dose.value, interval(range)));
      if (std::is_integral_v<T> && dose.value != std::floor(dose.value))
        throw InputError(fmt::format("{} = {}: is no whole number", dose.dial, dose.value));
      value = static_cast<T>(dose.value);
    }
  });
  const std::string enabled = fmt::format("{}.enabled", section_of(dose.dial));
  if (enabled != dose.dial && is_dial(enabled))
    at_setting(level, enabled, []<class T>(T& value, const SettingRange&, const char*) {
      if constexpr (std::is_same_v<T, bool>) value = true;
    });
}

}  // namespace

std::vector<std::string> dial_names() {
  std::vector<std::string> names;
  const SensorConfig level;
  for_each_setting(level, EachByName([&]<class T>(const std::string& name, const T&,
                                                  const SettingRange&, const char*) {
                     if constexpr (std::is_arithmetic_v<T>) names.push_back(name);
                   }));
  return names;
}

bool is_dial(std::string_view name) {
  static const std::vector<std::string> kNames = dial_names();
  return std::ranges::find(kNames, name) != kNames.end();
}

std::string no_dial(std::string_view name) {
  constexpr std::string_view kPrefix = "level.";
  if (name.starts_with(kPrefix)) name.remove_prefix(kPrefix.size());
  return fmt::format("is no dial of a level{}; docs/reference/sensors.md lists them",
                     did_you_mean(name, dial_names()));
}

DialFacts facts_of_dial(std::string_view name) {
  DialFacts facts;
  at_setting(SensorConfig(), name,
             [&]<class T>(const T&, const SettingRange& range, const char* note) {
               facts = {note, range, std::is_integral_v<T>};
             });
  return facts;
}

double read_dose(std::string_view dial, const YamlReader& value) {
  double dose = 0;
  at_setting(SensorConfig(), dial, [&]<class T>(const T&, const SettingRange& range, const char*) {
    if constexpr (std::is_arithmetic_v<T>) {
      T read{};
      MappingReader::read(value, read, range);
      dose = static_cast<double>(read);
    }
  });
  return dose;
}

SensorConfig with_doses(SensorConfig level, std::span<const Dose> doses) {
  for (const Dose& dose : doses) set(level, dose);
  if (const auto wrong = contradiction_in(level))
    throw InputError(fmt::format("{}: {}", wrong->section, wrong->why));
  return level;
}

SensorConfig effective(SensorConfig level) {
  const auto drop = []<class Section>(Section& section, bool acts) {
    if (!section.enabled || !acts) {
      section = Section();
      section.enabled = false;
    }
  };
  drop(level.depth_noise, true);
  drop(level.color_noise, level.color_noise.sigma > 0);
  drop(level.shot_noise, true);
  drop(level.auto_exposure, true);
  drop(level.vignetting, level.vignetting.strength > 0);
  drop(level.lens_blur, level.lens_blur.sigma_px > 0);
  drop(level.processing, level.processing.contrast > 0 || level.processing.sharpening > 0);
  drop(level.lens_distortion, !level.lens_distortion.lens.none());
  drop(level.motion_blur, level.motion_blur.exposure_ms > 0);
  drop(level.rolling_shutter, level.rolling_shutter.readout_ms > 0);
  drop(level.depth_offset, level.depth_offset.offset_ms != 0);
  const DepthBiasConfig& bias = level.depth_bias;
  drop(level.depth_bias,
       bias.scale != 1 || bias.bend > 0 || bias.shift_x_px != 0 || bias.shift_y_px != 0);
  drop(level.blank_frames, level.blank_frames.share > 0);
  drop(level.dropped_frames, level.dropped_frames.share > 0);
  drop(level.hurry, level.hurry.speed != 1);
  drop(level.light, level.light.share != 1 || level.light.flicker > 0);
  drop(level.lens_dirt, level.lens_dirt.share > 0);
  drop(level.jpeg, level.jpeg.loss > 0);
  const DepthFaultsConfig& depth = level.depth_faults;
  drop(level.depth_faults, depth.noise > 0 || depth.edges > 0 || depth.holes > 0);
  const FeedConfig& feed = level.feed;
  drop(level.feed, feed.keep_every > 1 || feed.stuck > 0 || feed.jitter_ms > 0 || feed.backward);
  drop(level.told, level.told.focal != 1 || level.told.center_px != 0 || level.told.k1 != 0);
  drop(level.labels.noise, !level.labels.noise.none());
  return level;
}

}  // namespace mh
