// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace mh {

/// A box of one class in one of several images, in pixels.
struct ImageBox {
  std::size_t image = 0;
  double left = 0, top = 0, width = 0, height = 0;
};

/// Intersection over union; 0 if both have no area.
double box_overlap(const ImageBox& a, const ImageBox& b);

struct TruthBox {
  ImageBox box;
  double area = 0;      ///< of the object itself: the number of its visible pixels
  bool ignore = false;  ///< too small to be required: neither finding nor missing it counts
};

struct ScoredBox {
  ImageBox box;
  double score = 0;
};

/// COCO's size classes of objects: smaller than 32 x 32 px, from there to 96 x 96 px, and at least
/// 96 x 96 px.
enum class ObjectSize { kAll, kSmall, kMedium, kLarge };

/// Average precision of one class by COCO's definition (Lin et al., ECCV 2014; detection
/// evaluation, cocodataset.org); NaN if there is no truth.
struct AveragePrecision {
  double ap = 0;  ///< mean over overlaps of 0.50, 0.55, ..., 0.95
  double ap50 = 0, ap75 = 0;
  double small = 0, medium = 0, large = 0;  ///< like `ap`, for objects of one size class
  std::size_t truths = 0;                   ///< number of truths that count
};

/// The best 100 detections of an image are assigned in order of their scores, each to the free
/// truth that it overlaps most, if the overlap reaches the threshold. At each of 101 recalls (0,
/// 0.01, ..., 1), precision is its maximum at that recall or any higher one. Truths outside the
/// size class are ignored, and so are unassigned detections outside it. There are no crowd regions.
AveragePrecision average_precision(std::span<const TruthBox> truths,
                                   std::span<const ScoredBox> found);

/// Average precision at one overlap and size. @returns NaN if there is no truth
double average_precision(std::span<const TruthBox> truths, std::span<const ScoredBox> found,
                         double overlap, ObjectSize size);

}  // namespace mh
