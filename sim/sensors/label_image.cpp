// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>
#include <vector>

#include "sim/sensors/sensors.hpp"

namespace mh {
namespace {

/// Palette entry c is the certain class c; void is the empty distribution.
std::vector<ClassDistribution> one_hot_palette() {
  std::vector<ClassDistribution> palette;
  for (const ClassInfo& info : classes()) palette.push_back(ClassDistribution::one_hot(info.id));
  return palette;
}

/// A box of pixels, all bounds included.
struct Box {
  int left = 0, top = 0, right = 0, bottom = 0;
  ClassId class_id = kVoid;
  InstanceId instance = 0;
  int pixels = 0;  ///< visible ones

  void include(int x, int y) {
    left = pixels ? std::min(left, x) : x;
    right = pixels ? std::max(right, x) : x;
    top = pixels ? std::min(top, y) : y;
    bottom = pixels ? std::max(bottom, y) : y;
    ++pixels;
  }
  std::int64_t area() const {
    return static_cast<std::int64_t>(right - left + 1) * (bottom - top + 1);
  }
};

/// The boxes that a perfect detector of the COCO classes would draw, largest first.
std::vector<Box> visible_boxes(const RenderedFrame& truth) {
  std::vector<Box> boxes;  // by instance
  for (int y = 0; y < truth.classes.height(); ++y)
    for (int x = 0; x < truth.classes.width(); ++x) {
      const ClassId class_id = truth.classes(x, y);
      const InstanceId instance = truth.instances(x, y);
      if (instance == 0 || classes()[class_id].coco80 < 0) continue;
      if (instance >= boxes.size()) boxes.resize(instance + 1U);
      boxes[instance].class_id = class_id;
      boxes[instance].instance = instance;
      boxes[instance].include(x, y);
    }
  std::erase_if(boxes, [](const Box& box) { return box.pixels < kMinBoxPixels; });
  std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) {
    return std::tuple(-a.area(), a.instance) < std::tuple(-b.area(), b.instance);
  });
  return boxes;
}

}  // namespace

SemanticImage label_image(const RenderedFrame& truth, LabelMode mode) {
  if (mode == LabelMode::kNone) return {};
  SemanticImage image{truth.classes, one_hot_palette()};
  if (mode == LabelMode::kExact) return image;
  std::fill(image.index.begin(), image.index.end(), kBackground);
  for (const Box& box : visible_boxes(truth))
    for (int y = box.top; y <= box.bottom; ++y)
      std::fill_n(&image.index(box.left, y), box.right - box.left + 1, box.class_id);
  return image;
}

}  // namespace mh
