// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/draw_detections.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/protocol/metrics/average_precision.hpp"
#include "bench/report/drawing/canvas.hpp"
#include "bench/report/drawing/false_colors.hpp"
#include "scenes/recordings/images/write_image.hpp"

namespace mh {
namespace {

/// A box and its name, which is drawn on a plate of the same color.
struct NamedBox {
  ImageBox box;
  std::string text;
  Rgb8 color;
};

constexpr double kText = 9, kPlate = kText + 6;

bool is_bright(Rgb8 color) {
  return 299 * color.r + 587 * color.g + 114 * color.b > 140'000;
}

void outline(Canvas& canvas, const ImageBox& box, Rgb8 color, double thickness) {
  const double right = box.left + box.width, bottom = box.top + box.height;
  canvas.line({box.left, box.top}, {right, box.top}, color, thickness);
  canvas.line({right, box.top}, {right, bottom}, color, thickness);
  canvas.line({right, bottom}, {box.left, bottom}, color, thickness);
  canvas.line({box.left, bottom}, {box.left, box.top}, color, thickness);
}

/// Draws boxes with an edge that is visible on dark and bright areas, then their names in the
/// given order. A name is drawn above its box, below it or inside, wherever there is no other name
/// yet.
void draw_boxes(Canvas& canvas, const std::vector<NamedBox>& boxes) {
  for (const NamedBox& b : boxes)
    outline(canvas, b.box, is_bright(b.color) ? Rgb8{0, 0, 0} : Rgb8{255, 255, 255}, 4);
  for (const NamedBox& b : boxes) outline(canvas, b.box, b.color, 2);
  std::vector<ImageBox> plates;
  for (const NamedBox& b : boxes) {
    ImageBox plate{0, b.box.left, 0, Canvas::text_width(b.text, kText) + 6, kPlate};
    const auto is_free = [&](double top) {
      return std::ranges::none_of(plates, [&](const ImageBox& other) {
        return plate.left < other.left + other.width && other.left < plate.left + plate.width &&
               top < other.top + kPlate && other.top < top + kPlate;
      });
    };
    const double above = std::max(0.0, b.box.top - kPlate);
    plate.top = above;
    for (const double top : {above, b.box.top + b.box.height - kPlate, b.box.top})
      if (is_free(top)) {
        plate.top = top;
        break;
      }
    plates.push_back(plate);
    canvas.fill(plate.left, plate.top, plate.width, kPlate, b.color);
    canvas.text(b.text, {plate.left + 3, plate.top + kText + 3}, kText,
                is_bright(b.color) ? Rgb8{0, 0, 0} : Rgb8{255, 255, 255});
  }
}

ImageBox image_box(const DetectedBox& box) {
  return {0, box.left, box.top, double{box.right} - box.left, double{box.bottom} - box.top};
}

std::string caption(const DetectedBox& box, const ClassNames& names) {
  return fmt::format("{} {:.2f}", names.names[static_cast<std::size_t>(box.network_class)],
                     box.score);
}

}  // namespace

cv::Mat draw_detections(const Grid2d<Rgb8>& color, const std::vector<DetectedBox>& boxes,
                        const ClassNames& names, const SemanticImage& labels) {
  const bool both = !labels.index.empty();
  Canvas canvas(color.width() * (both ? 2 : 1), color.height());
  canvas.image(color_image(color), 0, 0, color.width(), color.height());
  if (both) {
    Grid2d<Rgb8> classes(color.width(), color.height());
    for (int y = 0; y < color.height(); ++y)
      for (int x = 0; x < color.width(); ++x)
        classes(x, y) = class_color(labels.at(x, y).most_probable());
    canvas.image(color_image(classes), color.width(), 0, color.width(), color.height());
  }
  std::vector<NamedBox> named;
  for (const DetectedBox& box : boxes)
    named.push_back(
        {image_box(box), caption(box, names), class_color(box.classes.most_probable())});
  draw_boxes(canvas, named);
  return canvas.finish();
}

cv::Mat draw_missed(const Grid2d<Rgb8>& color, const std::vector<VisibleObject>& missed,
                    const std::vector<DetectedBox>& found, const ClassNames& names) {
  Canvas canvas(color.width(), color.height());
  canvas.image(color_image(color), 0, 0, color.width(), color.height());
  std::vector<NamedBox> named;
  for (const VisibleObject& object : missed)
    named.push_back({{0, static_cast<double>(object.left), static_cast<double>(object.top),
                      static_cast<double>(object.width()), static_cast<double>(object.height())},
                     std::string(classes()[object.class_id].name),
                     {220, 30, 30}});
  for (const DetectedBox& box : found)
    named.push_back({image_box(box), caption(box, names), {255, 255, 255}});
  draw_boxes(canvas, named);
  return canvas.finish();
}

}  // namespace mh
