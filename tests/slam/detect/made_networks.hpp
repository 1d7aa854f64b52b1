// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mh::test {

// Small networks, written as the bytes of their formats.

/// An ONNX model that segments: a 1 x 1 convolution that gives each class a value linear in red,
/// green and blue (0 to 255). `weights` holds three numbers per class.
std::string onnx_segmentation(int width, int height, const std::vector<float>& weights);

/// What the boxes of a detecting network are: the same in each cell, with the red of the cell's
/// center pixel / 255 as objectness (YOLOX) or factor of the first class (YOLOv8).
struct MadeHead {
  std::vector<float> box = {0.5F, 0.5F, 0, 0};  ///< the first four values
  std::vector<float> classes = {1, 0};          ///< probabilities
  bool yolov8 = false;                          ///< (4 + C) x N without objectness
  int boxes_per_cell = 1;
};

/// An ONNX model with cells of the strides 8, 16 and 32.
std::string onnx_detection(int width, int height, const MadeHead& head);

/// An ONNX model of one operator that nobody implements.
std::string onnx_unknown_operator();

/// A Darknet network of one yolo layer with a grid of 8 px, three anchors of 8, 16 and 24 px, and
/// two classes; a cell shows the first class with the first anchor where its pixels are red.
std::string darknet_config(int width, int height);
std::string darknet_weights();

}  // namespace mh::test
