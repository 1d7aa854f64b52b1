// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/contact_sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "bench/report/drawing/canvas.hpp"
#include "bench/report/drawing/false_colors.hpp"
#include "bench/report/drawing/viewpoints.hpp"
#include "scenes/recordings/images/write_image.hpp"

namespace mh {
namespace {

constexpr double kSheetMargin = 30, kGap = 12, kCaption = 22, kSheetHeader = 92;
constexpr double kTileWidth = 400;
constexpr float kNear_m = 0.4F, kFar_m = 8.0F;  // range of the false colors
constexpr double kSheetEye_m = 1.45;            // eyes of a sitting person or standing child

cv::Mat class_image(const Grid2d<ClassId>& labels) {
  Grid2d<Rgb8> colors(labels.width(), labels.height());
  for (int y = 0; y < labels.height(); ++y)
    for (int x = 0; x < labels.width(); ++x) colors(x, y) = class_color(labels(x, y));
  return color_image(colors);
}

std::vector<ClassId> classes_seen(const std::vector<View>& views) {
  std::vector<bool> seen(classes().size(), false);
  for (const View& view : views)
    for (const ClassId id : view.classes) seen[id] = true;
  std::vector<ClassId> list;
  for (std::size_t id = 0; id < seen.size(); ++id)
    if (seen[id]) list.push_back(static_cast<ClassId>(id));
  return list;
}

void draw_depth_scale(Canvas& canvas, double x, double y, double width) {
  canvas.image(depth_scale(), x, y, width, 14);
  canvas.text(fmt::format("{} m", kNear_m), {x, y + 32}, 9);
  canvas.text(fmt::format("{} m and more", kFar_m), {x + width, y + 32}, 9, {40, 40, 40},
              Canvas::Align::kRight);
  canvas.text("gray: no return", {x + width / 2, y + 32}, 9, {40, 40, 40}, Canvas::Align::kCenter);
}

constexpr int kLegendColumns = 7;
constexpr double kLegendRow = 24;

void draw_class_legend(Canvas& canvas, const std::vector<ClassId>& list, double x, double y,
                       double width) {
  const double column = width / kLegendColumns;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const double left = x + column * static_cast<double>(i % kLegendColumns);
    const double top = y + kLegendRow * static_cast<double>(i / kLegendColumns);
    canvas.fill(left, top, 16, 14, class_color(list[i]));
    canvas.text(std::string(classes()[list[i]].name), {left + 23, top + 12}, 9.5);
  }
}

View shoot(std::string caption, const Renderer& renderer, const Camera& camera, const SE3& pose) {
  RenderedFrame frame = renderer.render(camera, pose);
  return {std::move(caption), std::move(frame.color), std::move(frame.depth_m),
          std::move(frame.classes)};
}

/// A view from a corner of a room, with measures of how good it is.
struct CornerView {
  View view;
  int objects = 0;   ///< that fill 1/100 of the view or more; not walls, floor, ceiling
  float near_m = 0;  ///< 9/10 of the view is farther away; near 0 if something blocks it
};

CornerView shoot_corner(const Scene& scene, const Room& room, const Renderer& renderer,
                        const Camera& camera, const SE3& pose) {
  RenderedFrame frame = renderer.render(camera, pose);
  CornerView corner;
  std::map<InstanceId, std::size_t> pixels;
  for (const InstanceId id : frame.instances) ++pixels[id];
  for (const Instance& instance : scene.instances) {
    const std::string_view name = classes()[instance.class_id].name;
    const auto seen = pixels.find(instance.id);
    if (seen != pixels.end() && 100 * seen->second >= frame.instances.size() && name != "wall" &&
        name != "floor" && name != "ceiling")
      ++corner.objects;
  }
  std::vector<float> depths;
  for (const float depth : frame.depth_m)
    if (depth > 0) depths.push_back(depth);
  if (!depths.empty()) {
    const auto tenth = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 10);
    std::nth_element(depths.begin(), tenth, depths.end());
    corner.near_m = *tenth;
  }
  corner.view = {room.name, std::move(frame.color), std::move(frame.depth_m),
                 std::move(frame.classes)};
  return corner;
}

/// Above 0 if the outline, traversed counter-clockwise, turns left at corner i, which is then
/// convex.
double turn_at(const Room& room, std::size_t i) {
  const auto& p = room.polygon_m;
  const Eigen::Vector2d before = p[i] - p[(i + p.size() - 1) % p.size()];
  const Eigen::Vector2d after = p[(i + 1) % p.size()] - p[i];
  return before.x() * after.y() - before.y() * after.x();
}

/// Returns a place that is visible from all corners of a room: the middle of a rectangular room;
/// for an L-shaped room, the middle of the part that both arms share.
Eigen::Vector2d heart(const Room& room) {
  const auto& p = room.polygon_m;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : p) box.extend(corner);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (turn_at(room, i) >= 0) continue;
    const Eigen::Vector2d inward = (p[i] - p[(i + p.size() - 1) % p.size()]).normalized() +
                                   (p[i] - p[(i + 1) % p.size()]).normalized();
    const Eigen::Vector2d opposite(inward.x() > 0 ? box.max().x() : box.min().x(),
                                   inward.y() > 0 ? box.max().y() : box.min().y());
    return 0.5 * (p[i] + opposite);
  }
  return box.center();
}

/// A wide lens (75 degrees), as used to photograph rooms.
Camera wide_camera() {
  Camera camera;
  camera.fx_px = camera.fy_px =
      0.5 * camera.width_px / std::tan(0.5 * 75.0 * std::numbers::pi / 180);
  return camera;
}

}  // namespace

SE3 look_at(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m) {
  const Eigen::Vector3d forward = (target_m - eye_m).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d rotation;
  rotation << right, forward.cross(right), forward;
  return {rotation, eye_m};
}

std::vector<View> views_along(const Trajectory& path, const Renderer& renderer,
                              const Camera& camera, std::size_t count) {
  std::vector<View> views;
  if (path.empty()) return views;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = (2 * k + 1) * path.size() / (2 * count);
    views.push_back(shoot(fmt::format("frame {}", i), renderer, camera, path[i].world_from_camera));
  }
  return views;
}

std::vector<View> views_of(const Scene& scene, const Renderer& renderer) {
  const Camera camera = wide_camera();
  std::vector<View> views;
  if (scene.rooms.empty() || std::ranges::any_of(scene.rooms, &Room::is_box)) {
    constexpr std::size_t kViews = 6;
    for (const SE3& pose : viewpoints(scene, renderer, camera, kViews))
      views.push_back(shoot(fmt::format("view {}", views.size() + 1), renderer, camera, pose));
    return views;
  }
  for (const Room& room : scene.rooms) {
    const Eigen::Vector2d middle = heart(room);
    std::vector<CornerView> corners;
    for (std::size_t i = 0; i < room.polygon_m.size(); ++i) {
      if (turn_at(room, i) <= 0) continue;
      const Eigen::Vector2d eye = middle + 0.8 * (room.polygon_m[i] - middle);
      corners.push_back(
          shoot_corner(scene, room, renderer, camera,
                       look_at({eye.x(), eye.y(), kSheetEye_m}, {middle.x(), middle.y(), 0.75})));
    }
    // Corners that show the most objects come first; those where furniture blocks the view come
    // last.
    constexpr float kFree_m = 0.7F;
    std::ranges::stable_sort(corners, std::greater<>(), [](const CornerView& corner) {
      return std::tuple(corner.near_m > kFree_m, corner.objects, corner.near_m);
    });
    for (std::size_t i = 0; i < std::min<std::size_t>(2, corners.size()); ++i)
      views.push_back(std::move(corners[i].view));
  }
  return views;
}

cv::Mat draw_contact_sheet(const std::string& title, const std::vector<View>& views) {
  const double tile_height =
      views.empty() ? 300 : kTileWidth * views[0].color.height() / views[0].color.width();
  const double width = 2 * kSheetMargin + 3 * kTileWidth + 2 * kGap;
  const std::vector<ClassId> seen = classes_seen(views);
  const double legend_rows =
      std::ceil(static_cast<double>(seen.size()) / static_cast<double>(kLegendColumns));
  const double rows_end =
      kSheetHeader + static_cast<double>(views.size()) * (tile_height + kCaption);
  const double height = rows_end + 62 + legend_rows * kLegendRow + kSheetMargin;

  Canvas canvas(static_cast<int>(width), static_cast<int>(height));
  canvas.text(title, {kSheetMargin, 42}, 17, {35, 38, 45}, Canvas::Align::kLeft, true);
  canvas.text("without sensor noise", {width - kSheetMargin, 42}, 9, {110, 115, 125},
              Canvas::Align::kRight);
  const auto column = [&](int k) { return kSheetMargin + k * (kTileWidth + kGap); };
  const std::array<const char*, 3> headings = {"color", "depth", "labels"};
  for (int k = 0; k < 3; ++k)
    canvas.text(headings[static_cast<std::size_t>(k)], {column(k), kSheetHeader - 10}, 11);

  double y = kSheetHeader;
  for (const View& view : views) {
    canvas.image(color_image(view.color), column(0), y, kTileWidth, tile_height);
    canvas.image(depth_colors(view.depth_m, kNear_m, kFar_m), column(1), y, kTileWidth,
                 tile_height);
    canvas.image(class_image(view.classes), column(2), y, kTileWidth, tile_height);
    canvas.text(view.caption, {column(0), y + tile_height + 14}, 8.5, {110, 115, 125});
    y += tile_height + kCaption;
  }
  draw_depth_scale(canvas, column(1), rows_end + 6, kTileWidth);
  draw_class_legend(canvas, seen, kSheetMargin, rows_end + 58, width - 2 * kSheetMargin);
  return canvas.finish();
}

cv::Mat draw_gallery(const std::vector<View>& views, int columns, bool captions) {
  const double below = captions ? kCaption : kGap;
  const double tile_height =
      views.empty() ? 300 : kTileWidth * views[0].color.height() / views[0].color.width();
  const auto rows =
      (views.size() + static_cast<std::size_t>(columns) - 1) / static_cast<std::size_t>(columns);
  Canvas canvas(
      static_cast<int>(2 * kSheetMargin + columns * kTileWidth + (columns - 1) * kGap),
      static_cast<int>(2 * kSheetMargin + static_cast<double>(rows) * (tile_height + below)));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double x = kSheetMargin + static_cast<double>(i % static_cast<std::size_t>(columns)) *
                                        (kTileWidth + kGap);
    const double y = kSheetMargin + static_cast<double>(i / static_cast<std::size_t>(columns)) *
                                        (tile_height + below);
    canvas.image(color_image(views[i].color), x, y, kTileWidth, tile_height);
    if (captions) canvas.text(views[i].caption, {x, y + tile_height + 14}, 9.5, {60, 64, 72});
  }
  return canvas.finish();
}

}  // namespace mh
