// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "slam/detect/class_names.hpp"
#include "slam/detect/detected.hpp"
#include "slam/detect/fit_image.hpp"

namespace mh {

/// One output of a network: its shape and its values, row-major.
struct Tensor {
  std::vector<int> shape;
  std::span<const float> values;
};

/// "1 x 3549 x 85"
std::string shape_text(const Tensor& tensor);

/// What a network's outputs mean, judging by their shapes. A YOLOX with decoded boxes and one with
/// raw boxes have outputs of the same shape; their values tell them apart.
/// @param darknet  whether the network comes from a Darknet .cfg
/// @returns kAuto if no head fits
Head recognize_head(std::span<const Tensor> outputs, const InputSize& input, bool darknet);

/// Whether outputs are boxes and masks of objects, from a network for instance segmentation: these
/// are not supported.
bool gives_boxes_and_masks(std::span<const Tensor> outputs, const InputSize& input);

/// The output of a segmenting head: the first with a channel per class; null if there is none.
const Tensor* segmentation_in(std::span<const Tensor> outputs, const InputSize& input);

/// The number of classes of a network that has this head and these outputs; 0 if the head cannot
/// have such outputs.
int class_count(Head head, std::span<const Tensor> outputs, const InputSize& input);

/// A box in a network's output, before the image is known.
struct Candidate {
  double x = 0, y = 0, width = 0, height = 0;  ///< center and size, px of the input
  int best = 0;                                ///< class of the highest score
  std::vector<float> scores;                   ///< one for each of the network's classes
};

/// Returns the boxes of a detecting head whose best score is at least `confidence`, in the order of
/// the output. A score is objectness times class probability, where a head has both. Boxes with
/// values that are not finite are skipped. @throws InputError if a score is more than 1.
std::vector<Candidate> decode(Head head, std::span<const Tensor> outputs, const InputSize& input,
                              double confidence);

/// Applies non-maximum suppression within each class, best box first, ties in the order of the
/// input. Returns the best `max_detections` boxes, in pixels of the image. Parts of a box outside
/// the image are cut off.
std::vector<DetectedBox> select_boxes(const std::vector<Candidate>& candidates, const Placement& at,
                                      int width, int height, const ClassNames& names,
                                      const DetectorSettings& settings);

/// Converts scores to a distribution over our classes: each of our classes gets the scores of the
/// network's classes of the same name. All of them sum to at most 1. Empty if the best class is not
/// ours; scores below 0.01 are left out.
ClassDistribution our_classes(std::span<const float> scores, int best, const ClassNames& names);

/// Labels of an image from a segmenting head: values of each class are probabilities, or are turned
/// into them (softmax), and are interpolated between the output's cells. A palette entry is the
/// mean over the pixels with the same best class and about the same certainty (steps of a quarter),
/// limited to its three most probable classes. Pixels where no class reaches `confidence` are void.
SemanticImage segmented(const Tensor& output, const Placement& at, const InputSize& input,
                        const InputSize& of_image, const ClassNames& names, double confidence);

}  // namespace mh
