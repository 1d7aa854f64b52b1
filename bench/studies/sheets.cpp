// SPDX-License-Identifier: Apache-2.0
#include "bench/studies/sheets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "bench/drawing/canvas.hpp"
#include "bench/drawing/contact_sheet.hpp"
#include "bench/drawing/false_colors.hpp"
#include "scenes/pictures/write_picture.hpp"
#include "sim/sensors/shutter.hpp"

namespace mh {
namespace {

constexpr double kTileWidth = 400, kTileHeight = 300, kGap = 10, kMargin = 24, kCaption = 20;
constexpr double kHeader = 70;
constexpr std::size_t kMiddle = 30;  // of the path's frames
constexpr Rgb8 kInk = {40, 43, 50}, kGray = {110, 115, 125};

/// What is looked at, where a model has no dial for its strength.
struct Look {
  double baseline = 1;      ///< times the sensor's own
  double far = 1;           ///< the scene is so many times as large
  int pixel = 1;            ///< so many times as wide
  double eye_m = 0;         ///< above the floor; 0 = as the view is
  bool over_color = false;  ///< edges of the depth over the color picture
};

/// One factor: what it is called, and what makes it mild and strong.
struct Factor {
  std::string name;
  std::array<std::string, 3> captions;
  std::array<std::function<void(SensorConfig&)>, 3> settings;
  int crop_px = 640;  ///< width of the part that is shown, from the middle
  std::array<Look, 3> looks = {};
};

using Set = std::function<void(SensorConfig&)>;
const Set kOff = [](SensorConfig&) {};

SensorConfig everything_off() {
  SensorConfig config;
  config.depth_noise_on = config.color_noise_on = false;
  config.depth_noise = no_depth_noise();
  return config;
}

/// Where somebody at the height of a robot's camera sees most objects: from the rooms' middles, in
/// eight directions.
SE3 busiest_view(const Scene& scene, const Renderer& renderer, const Camera& camera) {
  std::vector<Eigen::Vector3d> eyes;
  for (const Room& room : scene.rooms) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : room.polygon_m)
      middle += corner / static_cast<double>(room.polygon_m.size());
    eyes.emplace_back(middle.x(), middle.y(), scene.floor.middle_m.z() + 1.1);
  }
  if (eyes.empty()) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& p : scene.positions_m)
      sum += p / static_cast<float>(scene.positions_m.size());
    eyes.emplace_back(sum.cast<double>());
  }
  SE3 best;
  std::size_t most = 0;
  for (const Eigen::Vector3d& eye : eyes)
    for (int k = 0; k < 8; ++k) {
      const double heading = k * std::numbers::pi / 4.0;
      const SE3 pose =
          look_at(eye, eye + Eigen::Vector3d(std::cos(heading), std::sin(heading), -0.15));
      const RenderedFrame seen = renderer.render(camera, pose);
      const std::size_t objects =
          std::set<InstanceId>(seen.instances.begin(), seen.instances.end()).size();
      if (objects <= most) continue;
      most = objects;
      best = pose;
    }
  return best;
}

/// Two seconds of walking and turning, the given pose in the middle.
Trajectory motion_through(const SE3& pose) {
  Vector6d twist;
  twist << 0, 0, 0.4, 0, 1.0, 0;  // m/s, rad/s, of the camera
  Trajectory path;
  for (std::size_t i = 0; i <= 2 * kMiddle; ++i) {
    const double t = (static_cast<double>(i) - static_cast<double>(kMiddle)) / 30.0;
    path.push_back({static_cast<Stamp>(i) * 33'333'333, pose * SE3::exp(t * twist)});
  }
  return path;
}

/// False colors for the distance, shaded as if lit from the left, so that its noise can be seen;
/// black without return.
cv::Mat depth_picture(const Grid2d<float>& depth_m, const Camera& camera) {
  const int w = depth_m.width(), h = depth_m.height();
  cv::Mat picture = depth_colors(depth_m, 0.5F, 6.0F);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const float z = depth_m(x, y), next = depth_m(std::min(x + 2, w - 1), y);
      cv::Vec3b& pixel = picture.at<cv::Vec3b>(y, x);
      if (z <= 0.0F) continue;
      const double slope = next > 0.0F ? (next - z) * camera.fx_px / (2.0 * z) : 0.0;
      const double shade = 0.72 + 0.28 * slope / std::sqrt(1.0 + slope * slope);
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(pixel[c] * shade);
    }
  return picture;
}

/// The color picture in gray with the depth's edges in red: they lie on the things' own where both
/// are of the same moment.
cv::Mat edges_over_color(const Grid2d<float>& depth_m, const Grid2d<Rgb8>& color) {
  constexpr double kJump = 0.08;  // share of the distance
  constexpr int kReach_px = 2;
  cv::Mat picture = color_picture(color);
  const auto jumps = [&](float a, float b) {
    return std::abs(a - b) > kJump * std::min(a, b) && a > 0 && b > 0;
  };
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      cv::Vec3b& pixel = picture.at<cv::Vec3b>(y, x);
      const auto gray = static_cast<std::uint8_t>((pixel[0] + pixel[1] + pixel[2]) / 3);
      const float z = depth_m(x, y);
      const bool edge = jumps(z, depth_m(std::min(x + kReach_px, picture.cols - 1), y)) ||
                        jumps(z, depth_m(x, std::min(y + kReach_px, picture.rows - 1)));
      pixel = edge ? cv::Vec3b(30, 30, 235) : cv::Vec3b(gray, gray, gray);
    }
  return picture;
}

/// Class colors over the gray picture; void is the picture itself.
cv::Mat label_picture(const SemanticImage& labels, const Grid2d<Rgb8>& color) {
  cv::Mat picture = color_picture(color);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      cv::Vec3b& pixel = picture.at<cv::Vec3b>(y, x);
      const double gray = (pixel[0] + pixel[1] + pixel[2]) / 3.0;
      const ClassDistribution& seen = labels.at(x, y);
      const Rgb8 shown = class_color(seen.most_probable());
      const double part = seen.entries.empty() ? 0.0 : 0.6;
      const std::array<std::uint8_t, 3> bgr = {shown.b, shown.g, shown.r};
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>(part * bgr[static_cast<std::size_t>(c)] +
                                             (1.0 - part) * gray);
    }
  return picture;
}

std::vector<Factor> color_factors() {
  const auto shot = [](double gain) {
    return [=](SensorConfig& c) { c.shot_noise_on = true, c.shot_noise.gain = gain; };
  };
  const auto gaussian = [](double sigma) {
    return [=](SensorConfig& c) { c.color_noise_on = true, c.color_noise.sigma = sigma; };
  };
  const auto read = [](double share) {
    // So large a well that its own noise, the shot noise, is small beside that of reading.
    return [=](SensorConfig& c) { c.shot_noise_on = true, c.shot_noise = {1e6, 1e6 * share, 1.0}; };
  };
  const auto blur = [](double s) {
    return [=](SensorConfig& c) { c.shutter.motion_blur_on = true, c.shutter.exposure_s = s; };
  };
  const auto soft = [](double px) { return [=](SensorConfig& c) { c.lens_blur_px = px; }; };
  const auto processed = [](double contrast, double sharpening) {
    return [=](SensorConfig& c) {
      c.lens_blur_px = 1.0, c.processing = {contrast, sharpening, 0.7};
    };
  };
  const auto rolling = [](double s) {
    return [=](SensorConfig& c) { c.shutter.rolling_shutter_on = true, c.shutter.readout_s = s; };
  };
  const auto vignetting = [](double strength) {
    return [=](SensorConfig& c) { c.vignetting_on = true, c.vignetting.strength = strength; };
  };
  const auto lens = [](double k1) {
    return [=](SensorConfig& c) {
      c.lens_distortion_on = true, c.lens_distortion = {k1, 0.0692, -0.00241, -0.00112, 0.0};
    };
  };
  const auto lag = [](double target) {
    return [=](SensorConfig& c) { c.auto_exposure_on = true, c.auto_exposure.target = target; };
  };
  return {
      {"motion blur", {"off", "20 ms", "66 ms"}, {kOff, blur(0.020), blur(0.066)}, 320},
      {"lens blur", {"off", "0.7 px", "2 px"}, {kOff, soft(0.7), soft(2.0)}, 200},
      {"processing, of a lens blur of 1 px",
       {"off", "contrast 0.5, sharpening 2", "contrast 1, sharpening 5"},
       {processed(0, 0), processed(0.5, 2), processed(1, 5)},
       200},
      {"rolling shutter", {"off", "26 ms", "100 ms"}, {kOff, rolling(0.0261), rolling(0.1)}},
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
      c.depth_noise_on = true;
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
  const auto offset = [](double s) { return [=](SensorConfig& c) { c.depth_offset_s = s; }; };
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
       {kOff, offset(0.020), offset(0.100)},
       640,
       {over_color, over_color, over_color}},
      {"together", {"off", "without shadow", "Xtion"}, {kOff, most, all}},
  };
}

std::vector<Factor> label_factors() {
  const auto noise = [](auto member, auto value) {
    return [=](SensorConfig& c) { c.labels.noise.*member = value; };
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
  };
}

/// The rows of one sheet; `show` makes the picture of one setting.
cv::Mat draw(const std::string& title, const std::vector<Factor>& factors,
             const std::function<cv::Mat(const SensorConfig&, const Look&)>& show) {
  const double row = kTileHeight + 2 * kCaption + kGap;
  Canvas canvas(static_cast<int>(2 * kMargin + 3 * kTileWidth + 2 * kGap),
                static_cast<int>(kHeader + static_cast<double>(factors.size()) * row + kMargin));
  canvas.text(title, {kMargin, 40}, 15, kInk, Canvas::Align::kLeft, true);
  double y = kHeader;
  for (const Factor& factor : factors) {
    canvas.text(factor.name, {kMargin, y + 12}, 10.5, kInk, Canvas::Align::kLeft, true);
    for (std::size_t k = 0; k < 3; ++k) {
      SensorConfig config = everything_off();
      factor.settings[k](config);
      const double x = kMargin + static_cast<double>(k) * (kTileWidth + kGap);
      cv::Mat whole = show(config, factor.looks[k]);
      if (const int pixel = factor.looks[k].pixel; pixel > 1)
        cv::resize(whole, whole, {}, pixel, pixel, cv::INTER_NEAREST);
      const int w = factor.crop_px, h = static_cast<int>(w * kTileHeight / kTileWidth);
      cv::Mat part;
      cv::resize(whole({(whole.cols - w) / 2, (whole.rows - h) / 2, w, h}), part, {800, 600}, 0, 0,
                 cv::INTER_NEAREST);
      canvas.picture(part, x, y + kCaption, kTileWidth, kTileHeight);
      canvas.text(factor.captions[k], {x, y + kCaption + kTileHeight + 14}, 8.5, kGray);
    }
    y += row;
  }
  return canvas.finish();
}

/// Successive frames, one row for each strength of each factor; what is lost is marked.
cv::Mat draw_frames(const std::function<cv::Mat(std::size_t frame, const SensorConfig&)>& show,
                    RandomStream stream) {
  constexpr std::size_t kFrames = 10;
  constexpr double kWidth = 120, kHeight = 90, kStep = 122;
  constexpr Rgb8 kLost = {205, 50, 40}, kEmpty = {236, 238, 241};
  const auto blank = [](double share) { return [=](SensorConfig& c) { c.blank_share = share; }; };
  const auto dropped = [](double share) {
    return [=](SensorConfig& c) { c.dropped_share = share; };
  };
  const std::vector<Factor> factors = {
      {"blank frames", {"off", "15 %", "50 %"}, {kOff, blank(0.15), blank(0.5)}},
      {"dropped frames", {"off", "15 %", "50 %"}, {kOff, dropped(0.15), dropped(0.5)}},
  };
  constexpr double kRow = kHeight + kCaption + 4;
  Canvas canvas(static_cast<int>(2 * kMargin + 3 * kTileWidth + 2 * kGap),
                static_cast<int>(kHeader + 2 * (3 * kRow + 40) + kMargin));
  canvas.text("Frames: one after another; red is lost", {kMargin, 40}, 15, kInk,
              Canvas::Align::kLeft, true);
  double y = kHeader;
  for (const Factor& factor : factors) {
    canvas.text(factor.name, {kMargin, y + 12}, 10.5, kInk, Canvas::Align::kLeft, true);
    y += kCaption;
    for (std::size_t k = 0; k < 3; ++k, y += kRow) {
      SensorConfig config = everything_off();
      factor.settings[k](config);
      const std::vector<std::size_t> come = arriving(kFrames, config, stream);
      for (std::size_t i = 0; i < kFrames; ++i) {
        const double x = kMargin + static_cast<double>(i) * kStep;
        const cv::Mat picture = show(kMiddle - kFrames / 2 + i, config);
        const bool arrives = std::ranges::find(come, i) != come.end();
        if (arrives) {
          canvas.picture(picture, x, y, kWidth, kHeight);
        } else {
          canvas.fill(x, y, kWidth, kHeight, kEmpty);
          canvas.cross({x + kWidth / 2, y + kHeight / 2}, 12, kLost, 3);
        }
        if (!arrives || cv::countNonZero(picture.reshape(1)) == 0)
          canvas.fill(x, y + kHeight - 5, kWidth, 5, kLost);
      }
      canvas.text(factor.captions[k], {kMargin, y + kHeight + 14}, 8.5, kGray);
    }
    y += 40 - kCaption;
  }
  return canvas.finish();
}

}  // namespace

SensorSheets draw_sensor_sheets(const Scene& scene, std::shared_ptr<const Renderer> renderer) {
  const Camera camera;
  const Trajectory path = motion_through(busiest_view(scene, *renderer, camera));
  const SE3& pose = path[kMiddle].world_from_camera;
  const RandomStream stream(1);
  const auto frame = [&](const SensorConfig& config, const Look& look) {
    Camera seen_by = camera;
    seen_by.baseline_m *= look.baseline;
    seen_by.width_px /= look.pixel, seen_by.height_px /= look.pixel;
    seen_by.fx_px /= look.pixel, seen_by.fy_px /= look.pixel;
    seen_by.cx_px = (seen_by.cx_px + 0.5) / look.pixel - 0.5;
    seen_by.cy_px = (seen_by.cy_px + 0.5) / look.pixel - 0.5;
    Trajectory way = path;
    if (look.eye_m > 0)
      for (TimedPose& p : way) {
        Eigen::Vector3d eye = p.world_from_camera.translation();
        eye.z() = look.eye_m;
        p.world_from_camera = SE3(p.world_from_camera.rotation(), eye);
      }
    const Shutter shutter(renderer, seen_by, way, config);
    Shutter::Exposed exposed = shutter.expose(kMiddle);
    const auto scale_depth = [&](Grid2d<float>& depth_m, double by) {
      for (float& z : depth_m) z = static_cast<float>(by * z);
    };
    scale_depth(exposed.seen.depth_m, look.far);
    RgbdFrame sensed = sense(exposed.seen, shutter.camera(), config, stream, 0, exposed.gain);
    scale_depth(sensed.depth_m, 1 / look.far);
    return sensed;
  };
  SensorSheets sheets;
  sheets.color = draw(
      "Color: forward at 0.4 m/s while turning at 1 rad/s", color_factors(),
      [&](const SensorConfig& c, const Look& look) { return color_picture(frame(c, look).color); });
  sheets.depth = draw("Depth: near red, far blue, black without return", depth_factors(),
                      [&](const SensorConfig& c, const Look& look) {
                        const RgbdFrame seen = frame(c, look);
                        return look.over_color ? edges_over_color(seen.depth_m, seen.color)
                                               : depth_picture(seen.depth_m, camera);
                      });
  sheets.frames = draw_frames(
      [&](std::size_t i, const SensorConfig& c) {
        const RenderedFrame seen = renderer->render(camera, path[i].world_from_camera);
        return color_picture(sense(seen, camera, c, stream.fork(i), 0).color);
      },
      RandomStream(6));  // in ten frames this one loses some at either share

  const RenderedFrame truth = renderer->render(camera, pose);
  std::vector<Factor> factors = label_factors();
  sheets.labels = draw(
      "Labels: class colors over the picture", factors, [&](const SensorConfig& c, const Look&) {
        return label_picture(sense_labels(truth, LabelMode::kExact, c, pose, stream), truth.color);
      });
  // The detector's rows go below: exact boxes, one network and another.
  const Factor detectors{"detectors",
                         {"exact boxes", "YOLOv3-like", "another such network"},
                         {[](SensorConfig& c) { c.labels.seed = 100; }, kOff,
                          [](SensorConfig& c) { c.labels.seed = 7; }}};
  const cv::Mat more = draw("", {detectors}, [&](const SensorConfig& c, const Look&) {
    const LabelMode mode = c.labels.seed == 100 ? LabelMode::kBoxes : LabelMode::kDetector;
    return label_picture(sense_labels(truth, mode, c, pose, stream), truth.color);
  });
  cv::vconcat(sheets.labels,
              more(cv::Range(static_cast<int>(kHeader) - 20, more.rows), cv::Range::all()),
              sheets.labels);
  return sheets;
}

}  // namespace mh
