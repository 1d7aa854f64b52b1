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
  double area = 0;      ///< of the object itself, px: its visible pixels
  bool ignore = false;  ///< too small to be required: neither finding nor missing it counts
};

struct ScoredBox {
  ImageBox box;
  double score = 0;
};

/// Objects of COCO's size classes: below 32 x 32 px, between, and from 96 x 96 px on.
enum class ObjectSize { kAll, kSmall, kMedium, kLarge };

/// Average precision of one class by COCO's definition (Lin et al., ECCV 2014; detection
/// evaluation, cocodataset.org); NaN without any truth.
struct AveragePrecision {
  double ap = 0;  ///< mean over overlaps of 0.50, 0.55, ..., 0.95
  double ap50 = 0, ap75 = 0;
  double small = 0, medium = 0, large = 0;  ///< as `ap`, for objects of one size
  std::size_t truths = 0;                   ///< number of truths that count
};

/// The best 100 detections of an image are assigned in order of their scores, each to the free
/// truth that it overlaps most, if the overlap reaches the threshold. Precision is interpolated at
/// 101 recalls (0, 0.01, ..., 1) by its maximum at that recall or a higher one. Truths of a
/// different size are ignored, and so are unassigned detections of a different size. There are no
/// crowds.
AveragePrecision average_precision(std::span<const TruthBox> truths,
                                   std::span<const ScoredBox> found);

/// Average precision at one overlap and size. @returns NaN without any truth
double average_precision(std::span<const TruthBox> truths, std::span<const ScoredBox> found,
                         double overlap, ObjectSize size);

}  // namespace mh
