// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sim/render/renderer.hpp"

namespace mh {

/// The visible part of an instance in an image. The box's bounds are inclusive.
struct VisibleObject {
  int left = 0, top = 0, right = 0, bottom = 0;
  ClassId class_id = kVoid;
  InstanceId instance = 0;
  int pixels = 0;

  void include(int x, int y) {
    left = pixels ? std::min(left, x) : x;
    right = pixels ? std::max(right, x) : x;
    top = pixels ? std::min(top, y) : y;
    bottom = pixels ? std::max(bottom, y) : y;
    ++pixels;
  }
  int width() const { return right - left + 1; }
  int height() const { return bottom - top + 1; }
  std::int64_t area() const { return static_cast<std::int64_t>(width()) * height(); }
};

/// Returns every instance in the image with a class, by ascending id.
std::vector<VisibleObject> visible_objects(const RenderedFrame& truth);

/// Whether boxes are drawn for a class.
inline bool is_coco(ClassId class_id) {
  return classes()[class_id].coco80 >= 0;
}

/// Sorts larger objects first, so that smaller boxes are painted over them; then by instance.
void sort_for_painting(std::vector<VisibleObject>& objects);

}  // namespace mh
