// SPDX-License-Identifier: Apache-2.0
#include "bench/live/live_page.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "bench/report/drawing/false_colors.hpp"
#include "scenes/image_file.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "slam/core/labels.hpp"

namespace mh {
namespace {

using PageJson = nlohmann::json;

constexpr int kJpegQuality = 80;

Grid2d<Rgb8> colors_of(const Grid2d<ClassId>& classes) {
  Grid2d<Rgb8> image(classes.width(), classes.height());
  std::ranges::transform(classes, image.begin(), class_color);
  return image;
}

Grid2d<Rgb8> colors_of(const Grid2d<float>& depth_m) {
  const cv::Mat bgr = depth_colors(depth_m, 0.4F, 8.0F);
  Grid2d<Rgb8> image(bgr.cols, bgr.rows);
  for (int y = 0; y < bgr.rows; ++y)
    for (int x = 0; x < bgr.cols; ++x) {
      const auto& c = bgr.at<cv::Vec3b>(y, x);
      image(x, y) = {c[2], c[1], c[0]};
    }
  return image;
}

}  // namespace

double rounded_for_page(double value) {
  return std::round(1000 * value) / 1000;
}

PageJson from_above_for_page(const SE3& world_from_camera) {
  const Eigen::Vector3d& at = world_from_camera.translation();
  const Eigen::Vector3d ahead = world_from_camera.rotation().col(2);
  return {rounded_for_page(at.x()), rounded_for_page(at.y()),
          rounded_for_page(std::atan2(ahead.y(), ahead.x()))};
}

PageJson plan_for_page(const Scene* scene) {
  PageJson rooms = PageJson::array(), things = PageJson::array(), names = PageJson::array();
  for (const ClassInfo& info : classes()) {
    const Rgb8 color = class_color(info.id);
    names.push_back(
        {std::string(info.name), fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b)});
  }
  if (scene == nullptr) return {{"rooms", rooms}, {"things", things}, {"classes", names}};
  for (const Room& room : scene->rooms) {
    PageJson outline = PageJson::array();
    for (const Eigen::Vector2d& p : room.polygon_m)
      outline.push_back({rounded_for_page(p.x()), rounded_for_page(p.y())});
    rooms.push_back({{"name", room.name}, {"outline", outline}});
  }
  for (const Instance& thing : scene->instances) {
    const std::string_view name = classes()[thing.class_id].name;
    constexpr float kHall_m2 = 12;  // larger instances surround rooms, like walls and floors
    const Eigen::Vector3f size_m = thing.max_m - thing.min_m;
    if (name == "floor" || name == "wall" || name == "ceiling" ||
        size_m.x() * size_m.y() > kHall_m2)
      continue;
    things.push_back({rounded_for_page(thing.min_m.x()), rounded_for_page(thing.min_m.y()),
                      rounded_for_page(thing.max_m.x()), rounded_for_page(thing.max_m.y()),
                      thing.class_id});
  }
  return {{"rooms", rooms}, {"things", things}, {"classes", names}};
}

PageImages images_for_page(const RgbdFrame& frame) {
  return {encode_jpeg(frame.color, kJpegQuality),
          encode_jpeg(colors_of(frame.depth_m), kJpegQuality),
          encode_jpeg(colors_of(classes_of(frame)), kJpegQuality)};
}

}  // namespace mh
