// SPDX-License-Identifier: Apache-2.0
#include "bench/studies/draw_detections.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "bench/drawing/canvas.hpp"
#include "bench/drawing/false_colors.hpp"
#include "bench/metrics/average_precision.hpp"
#include "scenes/images/write_image.hpp"

namespace mh {
namespace {

/// A box with its name on a plate of the same color.
void draw_box(Canvas& canvas, const ImageBox& box, const std::string& text, Rgb8 color) {
  constexpr double kText = 9, kThickness = 2;
  const double right = box.left + box.width, bottom = box.top + box.height;
  canvas.line({box.left, box.top}, {right, box.top}, color, kThickness);
  canvas.line({right, box.top}, {right, bottom}, color, kThickness);
  canvas.line({right, bottom}, {box.left, bottom}, color, kThickness);
  canvas.line({box.left, bottom}, {box.left, box.top}, color, kThickness);
  const double width = Canvas::text_width(text, kText) + 6;
  const double top = std::max(0.0, box.top - kText - 6);
  canvas.fill(box.left, top, width, kText + 6, color);
  const bool bright = 299 * color.r + 587 * color.g + 114 * color.b > 140'000;
  canvas.text(text, {box.left + 3, top + kText + 3}, kText,
              bright ? Rgb8{0, 0, 0} : Rgb8{255, 255, 255});
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
  for (std::size_t i = boxes.size(); i-- > 0;)  // the best on top
    draw_box(canvas, image_box(boxes[i]), caption(boxes[i], names),
             class_color(boxes[i].classes.most_probable()));
  return canvas.finish();
}

cv::Mat draw_missed(const Grid2d<Rgb8>& color, const std::vector<VisibleObject>& missed,
                    const std::vector<DetectedBox>& found, const ClassNames& names) {
  Canvas canvas(color.width(), color.height());
  canvas.image(color_image(color), 0, 0, color.width(), color.height());
  for (const VisibleObject& object : missed)
    draw_box(canvas,
             {0, static_cast<double>(object.left), static_cast<double>(object.top),
              static_cast<double>(object.width()), static_cast<double>(object.height())},
             std::string(classes()[object.class_id].name), {220, 30, 30});
  for (const DetectedBox& box : found)
    draw_box(canvas, image_box(box), caption(box, names), {255, 255, 255});
  return canvas.finish();
}

}  // namespace mh
