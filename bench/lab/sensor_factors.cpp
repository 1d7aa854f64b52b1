// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/sensor_factors.hpp"

namespace mh {
namespace {

using Set = std::function<void(SensorConfig&)>;
const Set kOff = [](SensorConfig&) {};

}  // namespace

SensorConfig everything_off() {
  SensorConfig config = exact_sensors();
  config.depth_noise = no_depth_noise();
  config.depth_noise.enabled = false;
  return config;
}

std::vector<Factor> color_factors() {
  const auto shot = [](double gain) {
    return [=](SensorConfig& c) { c.shot_noise.enabled = true, c.shot_noise.gain = gain; };
  };
  const auto gaussian = [](double sigma) {
    return [=](SensorConfig& c) { c.color_noise.enabled = true, c.color_noise.sigma = sigma; };
  };
  const auto read = [](double share) {
    // The full well is so large that its own noise, the shot noise, is small compared with the read
    // noise.
    return [=](SensorConfig& c) { c.shot_noise = {true, 1e6, 1e6 * share, 1.0}; };
  };
  const auto blur = [](double ms) { return [=](SensorConfig& c) { c.motion_blur = {true, ms}; }; };
  const auto soft = [](double px) { return [=](SensorConfig& c) { c.lens_blur = {true, px}; }; };
  const auto processed = [](double contrast, double sharpening) {
    return [=](SensorConfig& c) {
      c.lens_blur = {true, 1.0}, c.processing = {true, contrast, sharpening, 0.7};
    };
  };
  const auto rolling = [](double ms) {
    return [=](SensorConfig& c) { c.rolling_shutter = {true, ms}; };
  };
  const auto vignetting = [](double strength) {
    return [=](SensorConfig& c) { c.vignetting = {true, strength}; };
  };
  const auto lens = [](double k1) {
    return [=](SensorConfig& c) {
      c.lens_distortion = {true, {k1, 0.0692, -0.00241, -0.00112, 0.0}};
    };
  };
  const auto lag = [](double target) {
    return
        [=](SensorConfig& c) { c.auto_exposure.enabled = true, c.auto_exposure.target = target; };
  };
  return {
      {"motion blur", {"off", "20 ms", "66 ms"}, {kOff, blur(20), blur(66)}, 320},
      {"lens blur", {"off", "0.7 px", "2 px"}, {kOff, soft(0.7), soft(2.0)}, 200},
      {"processing, of a lens blur of 1 px",
       {"off", "contrast 0.5, sharpening 2", "contrast 1, sharpening 5"},
       {processed(0, 0), processed(0.5, 2), processed(1, 5)},
       200},
      {"rolling shutter", {"off", "26 ms", "100 ms"}, {kOff, rolling(26.1), rolling(100)}},
      {"color noise (Gaussian)",
       {"off", "0.7 %", "5 %"},
       {kOff, gaussian(0.007), gaussian(0.05)},
       200},
      {"read noise alone",
       {"off", "1 % of a white pixel", "5 % of a white pixel"},
       {kOff, read(0.01), read(0.05)},
       200},
      {"shot and read noise", {"off", "gain 1", "gain 16"}, {kOff, shot(1), shot(16)}, 200},
      {"vignetting", {"off", "half of cos^4", "cos^4"}, {kOff, vignetting(0.5), vignetting(1.0)}},
      {"lens distortion",
       {"off", "Pepper's, k1 = -0.055", "k1 = -0.35"},
       {kOff, lens(-0.05452), lens(-0.35)}},
      {"exposure control, wrong by its lag",
       {"off", "a stop too dark", "a stop too bright"},
       {kOff, lag(0.09), lag(0.5)}},
  };
}

std::vector<Factor> depth_factors() {
  const auto noise = [](void (*set)(DepthNoiseConfig&)) {
    return [=](SensorConfig& c) {
      c.depth_noise.enabled = true;
      set(c.depth_noise);
    };
  };
  const Set axial = noise([](DepthNoiseConfig& d) { d.axial = true; });
  const Set lateral = noise([](DepthNoiseConfig& d) { d.lateral = true; });
  const Set steps = noise([](DepthNoiseConfig& d) { d.quantization = true; });
  const Set grazing = noise([](DepthNoiseConfig& d) { d.grazing_holes = true; });
  const Set shadow = noise([](DepthNoiseConfig& d) { d.projector_shadow = true; });
  const Set range = noise([](DepthNoiseConfig& d) { d.min_range_m = 0.4, d.max_range_m = 8.0; });
  const Set short_range =
      noise([](DepthNoiseConfig& d) { d.min_range_m = 0.8, d.max_range_m = 3.5; });
  const Set most = noise([](DepthNoiseConfig& d) {
    d = DepthNoiseConfig{};
    d.projector_shadow = false;
  });
  const Set all = noise([](DepthNoiseConfig& d) {
    d = DepthNoiseConfig{};
    d.projector_shadow = true;
  });
  const Look over_color{.over_color = true};
  const auto offset = [](double ms) {
    return [=](SensorConfig& c) { c.depth_offset = {true, ms}; };
  };
  return {
      {"axial noise",
       {"off", "on", "on, in a room three times as large"},
       {kOff, axial, axial},
       320,
       {Look{}, Look{}, Look{.far = 3}}},
      {"steps of disparity",
       {"off", "on", "on, in a room three times as large"},
       {kOff, steps, steps},
       320,
       {Look{}, Look{}, Look{.far = 3}}},
      {"lateral noise: ragged edges",
       {"off", "on", "on, at 320 x 240 pixels"},
       {kOff, lateral, lateral},
       200,
       {Look{}, Look{}, Look{.pixel = 2}}},
      {"shadow of the projector",
       {"off", "on", "on, projector twice as far from the camera"},
       {kOff, shadow, shadow},
       320,
       {Look{}, Look{}, Look{.baseline = 2}}},
      {"holes at grazing angles",
       {"off, 0.2 m above the floor", "on, where the other views are", "on, 0.2 m above the floor"},
       {kOff, grazing, grazing},
       640,
       {Look{.eye_m = 0.2}, Look{}, Look{.eye_m = 0.2}}},
      {"range", {"off", "0.4 to 8 m", "0.8 to 3.5 m"}, {kOff, range, short_range}},
      {"later than the color: edges of the depth over the color",
       {"off", "20 ms", "100 ms"},
       {kOff, offset(20), offset(100)},
       640,
       {over_color, over_color, over_color}},
      {"together", {"off", "without shadow", "Xtion"}, {kOff, most, all}},
  };
}

std::vector<Factor> label_factors() {
  const auto noise = [](auto member, auto value) {
    return [=](SensorConfig& c) { c.labels.noise.enabled = true, c.labels.noise.*member = value; };
  };
  using N = LabelNoiseConfig;
  return {
      {"confusion (exact labels)",
       {"off", "10 %", "50 %"},
       {kOff, noise(&N::confusion, 0.1), noise(&N::confusion, 0.5)}},
      {"swapped instances (exact labels)",
       {"off", "10 %", "50 %"},
       {kOff, noise(&N::swap, 0.1), noise(&N::swap, 0.5)}},
      {"dropout (exact labels)",
       {"off", "10 %", "50 %"},
       {kOff, noise(&N::dropout, 0.1), noise(&N::dropout, 0.5)}},
      {"eroded borders (exact labels)",
       {"off", "3 px", "12 px"},
       {kOff, noise(&N::erosion_px, 3), noise(&N::erosion_px, 12)}},
      {"classes (exact labels)",
       {"all", "thirteen", "two"},
       {kOff, noise(&N::class_set, ClassSet::kThirteen), noise(&N::class_set, ClassSet::kTwo)}},
  };
}

std::vector<Factor> frame_factors() {
  const auto blank = [](double share) {
    return [=](SensorConfig& c) { c.blank_frames = {true, share}; };
  };
  const auto dropped = [](double share) {
    return [=](SensorConfig& c) { c.dropped_frames = {true, share}; };
  };
  return {
      {"blank frames", {"off", "15 %", "50 %"}, {kOff, blank(0.15), blank(0.5)}},
      {"dropped frames", {"off", "15 %", "50 %"}, {kOff, dropped(0.15), dropped(0.5)}},
  };
}

Factor detector_factor() {
  return {"detectors",
          {"exact boxes", "YOLOv3-like", "another such network"},
          {[](SensorConfig& c) { c.labels.seed = kExactBoxes; }, kOff,
           [](SensorConfig& c) { c.labels.seed = 7; }}};
}

}  // namespace mh
