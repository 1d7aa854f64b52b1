// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/sheets.hpp"

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

#include "bench/lab/sensor_factors.hpp"
#include "bench/report/drawing/canvas.hpp"
#include "bench/report/drawing/contact_sheet.hpp"
#include "bench/report/drawing/false_colors.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "sim/sensors/shutter.hpp"

namespace mh {
namespace {

constexpr double kTileWidth = 400, kTileHeight = 300, kGap = 10, kMargin = 24, kCaption = 20;
constexpr double kHeader = 70;
constexpr std::size_t kMiddle = 30;  // index of the middle frame of the path
constexpr Rgb8 kInk = {40, 43, 50}, kGray = {110, 115, 125};

/// The view that shows the most objects, among eight directions from the center of each room at the
/// height of a robot's camera.
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

/// Two seconds of walking and turning, with the given pose in the middle.
Trajectory motion_through(const SE3& pose) {
  Vector6d twist;
  twist << 0, 0, 0.4, 0, 1.0, 0;  // m/s and rad/s, in the camera's frame
  Trajectory path;
  for (std::size_t i = 0; i <= 2 * kMiddle; ++i) {
    const double t = (static_cast<double>(i) - static_cast<double>(kMiddle)) / 30.0;
    path.push_back({static_cast<Stamp>(i) * 33'333'333, pose * SE3::exp(t * twist)});
  }
  return path;
}

/// Draws distances in false colors, shaded as if lit from the left so that noise is visible; black
/// means no return.
cv::Mat depth_image(const Grid2d<float>& depth_m, const Camera& camera) {
  const int w = depth_m.width(), h = depth_m.height();
  cv::Mat image = depth_colors(depth_m, 0.5F, 6.0F);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const float z = depth_m(x, y), next = depth_m(std::min(x + 2, w - 1), y);
      cv::Vec3b& pixel = image.at<cv::Vec3b>(y, x);
      if (z <= 0.0F) continue;
      const double slope = next > 0.0F ? (next - z) * camera.fx_px / (2.0 * z) : 0.0;
      const double shade = 0.72 + 0.28 * slope / std::sqrt(1.0 + slope * slope);
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(pixel[c] * shade);
    }
  return image;
}

/// Draws edges of the depth in red over the color image in gray. They coincide with the objects'
/// edges if both images were taken at the same time.
cv::Mat edges_over_color(const Grid2d<float>& depth_m, const Grid2d<Rgb8>& color) {
  constexpr double kJump = 0.08;  // share of the distance
  constexpr int kReach_px = 2;
  cv::Mat image = color_image(color);
  const auto jumps = [&](float a, float b) {
    return std::abs(a - b) > kJump * std::min(a, b) && a > 0 && b > 0;
  };
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      cv::Vec3b& pixel = image.at<cv::Vec3b>(y, x);
      const auto gray = static_cast<std::uint8_t>((pixel[0] + pixel[1] + pixel[2]) / 3);
      const float z = depth_m(x, y);
      const bool edge = jumps(z, depth_m(std::min(x + kReach_px, image.cols - 1), y)) ||
                        jumps(z, depth_m(x, std::min(y + kReach_px, image.rows - 1)));
      pixel = edge ? cv::Vec3b(30, 30, 235) : cv::Vec3b(gray, gray, gray);
    }
  return image;
}

/// Draws class colors over the gray image; where the label is void, the image itself is visible.
cv::Mat label_image(const SemanticImage& labels, const Grid2d<Rgb8>& color) {
  cv::Mat image = color_image(color);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      cv::Vec3b& pixel = image.at<cv::Vec3b>(y, x);
      const double gray = (pixel[0] + pixel[1] + pixel[2]) / 3.0;
      const ClassDistribution& seen = labels.at(x, y);
      const Rgb8 shown = class_color(seen.most_probable());
      const double part = seen.entries.empty() ? 0.0 : 0.6;
      const std::array<std::uint8_t, 3> bgr = {shown.b, shown.g, shown.r};
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>(part * bgr[static_cast<std::size_t>(c)] +
                                             (1.0 - part) * gray);
    }
  return image;
}

/// Draws the rows of one sheet; `show` returns the image for one setting.
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
      canvas.image(part, x, y + kCaption, kTileWidth, kTileHeight);
      canvas.text(factor.captions[k], {x, y + kCaption + kTileHeight + 14}, 8.5, kGray);
    }
    y += row;
  }
  return canvas.finish();
}

/// Draws successive frames, one row for each strength of each factor. Lost frames are marked.
cv::Mat draw_frames(const std::function<cv::Mat(std::size_t frame, const SensorConfig&)>& show,
                    RandomStream stream) {
  constexpr std::size_t kFrames = 10;
  constexpr double kWidth = 120, kHeight = 90, kStep = 122;
  constexpr Rgb8 kLost = {205, 50, 40}, kEmpty = {236, 238, 241};
  const std::vector<Factor> factors = frame_factors();
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
        const cv::Mat image = show(kMiddle - kFrames / 2 + i, config);
        const bool arrives = std::ranges::find(come, i) != come.end();
        if (arrives) {
          canvas.image(image, x, y, kWidth, kHeight);
        } else {
          canvas.fill(x, y, kWidth, kHeight, kEmpty);
          canvas.cross({x + kWidth / 2, y + kHeight / 2}, 12, kLost, 3);
        }
        if (!arrives || cv::countNonZero(image.reshape(1)) == 0)
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
    Camera seen_by = resized(camera, camera.width_px / look.pixel, camera.height_px / look.pixel);
    seen_by.baseline_m *= look.baseline;
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
      [&](const SensorConfig& c, const Look& look) { return color_image(frame(c, look).color); });
  sheets.depth = draw("Depth: near red, far blue, black without return", depth_factors(),
                      [&](const SensorConfig& c, const Look& look) {
                        const RgbdFrame seen = frame(c, look);
                        return look.over_color ? edges_over_color(seen.depth_m, seen.color)
                                               : depth_image(seen.depth_m, camera);
                      });
  sheets.frames = draw_frames(
      [&](std::size_t i, const SensorConfig& c) {
        const RenderedFrame seen = renderer->render(camera, path[i].world_from_camera);
        return color_image(sense(seen, camera, c, stream.fork(i), 0).color);
      },
      RandomStream(6));  // with this seed, "mild" and "strong" both lose some of the ten frames

  const RenderedFrame truth = renderer->render(camera, pose);
  std::vector<Factor> factors = label_factors();
  sheets.labels =
      draw("Labels: class colors over the image", factors, [&](const SensorConfig& c, const Look&) {
        return label_image(sense_labels(truth, LabelMode::kExact, c, pose, stream), truth.color);
      });
  // Below, the rows of the detector: exact boxes, one network, another network.
  const Factor detectors = detector_factor();
  const cv::Mat more = draw("", {detectors}, [&](const SensorConfig& c, const Look&) {
    const LabelMode mode = c.labels.seed == kExactBoxes ? LabelMode::kBoxes : LabelMode::kDetector;
    return label_image(sense_labels(truth, mode, c, pose, stream), truth.color);
  });
  cv::vconcat(sheets.labels,
              more(cv::Range(static_cast<int>(kHeader) - 20, more.rows), cv::Range::all()),
              sheets.labels);
  return sheets;
}

}  // namespace mh
