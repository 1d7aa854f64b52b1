// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "slam/core/rgbd_frame.hpp"
#include "slam/detect/settings.hpp"

namespace mh {

/// A box that a detector found. Pixel x covers [x, x + 1): a box of the whole image is 0, 0, width,
/// height.
struct DetectedBox {
  float left = 0, top = 0, right = 0, bottom = 0;
  float score = 0;            ///< of its best class
  int network_class = 0;      ///< the detector's own index of its best class
  ClassDistribution classes;  ///< in our classes; empty (void) if its best class is not ours
  friend bool operator==(const DetectedBox&, const DetectedBox&) = default;
};

/// What a detector found in an image.
struct Detected {
  std::vector<DetectedBox> boxes;  ///< best first
  SemanticImage pixels;            ///< from a segmentation network; otherwise empty
  /// Boxes of a file that reached more than a pixel beyond the image: they were cut, or left out
  /// if nothing remained.
  int clipped = 0;
  friend bool operator==(const Detected&, const Detected&) = default;
};

/// Labels of each pixel. Each box is one palette entry, boxes with higher scores cover those with
/// lower ones, and pixels outside all boxes are background. BoxFill::kForeground leaves out pixels
/// of a box if their depth is known and outside the depths of the box's surface: see
/// foreground_depth().
/// @param depth_m  of the same pixels; may be empty with BoxFill::kBox
SemanticImage labels_of(const Detected& detected, const Grid2d<float>& depth_m, int width,
                        int height, BoxFill fill);

/// Depths from `near_m` to `far_m`.
struct DepthRange {
  float near_m = 0, far_m = 1e9F;
  bool contains(float depth_m) const { return depth_m >= near_m && depth_m <= far_m; }
};

/// The depths of the surface that a box encloses. The inverse depths in the box are split in two
/// where the variance between the parts is largest (Otsu 1979). If the nearer part is at least 10 %
/// nearer on average, and most neighbors across the cut differ by a step (4 %), the box has two
/// surfaces, and only the nearer one is kept. But if the nearer one covers less than 30 % of the
/// box's middle (half of its width and height), it is something in front of the object, and the
/// farther one is kept instead. This is repeated up to three times.
DepthRange foreground_depth(const DetectedBox& box, const Grid2d<float>& depth_m);

/// Encodes detections for a cache, and decodes them. @throws InputError if the bytes are not a
/// valid encoding.
std::string encode(const Detected& detected);
Detected decode_detected(std::string_view bytes);

}  // namespace mh
