// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mh::test {

// Small networks, written as the bytes of their formats.

// Parts of an ONNX model: onnx.proto's messages as bytes.

std::string floats(const std::string& name, const std::vector<std::int64_t>& dims,
                   const std::vector<float>& values);
std::string halves(const std::string& name, const std::vector<std::int64_t>& dims,
                   const std::vector<std::uint16_t>& bits);
std::string integers(const std::string& name, const std::vector<std::int64_t>& values);
std::string whole(const std::string& name, std::int64_t number);
std::string constant_node(const std::string& name, const std::vector<std::int64_t>& dims,
                          const std::vector<std::int64_t>& values);
std::string list(const std::string& name, const std::vector<std::int64_t>& values);
std::string integer(const std::string& name, std::int64_t value);
std::string node(const std::string& op, const std::vector<std::string>& in,
                 const std::vector<std::string>& out, const std::string& attributes = "");
/// @param tag   11: an input, 12: an output
/// @param dims  0: dynamic
std::string value(int tag, const std::string& name, const std::vector<std::int64_t>& dims);
std::string model(const std::string& graph, int opset = 11);
/// A metadata entry, to be appended to a model.
std::string metadata(const std::string& key, const std::string& content);

/// An ONNX model for segmentation: a 1 x 1 convolution that gives each class a linear function of
/// red, green and blue (0 to 255). `weights` contains three numbers per class.
std::string onnx_segmentation(int width, int height, const std::vector<float>& weights);

/// The boxes of a detection network: the same in each cell, with the red of the cell's center pixel
/// / 255 as objectness (YOLOX) or as a factor for the first class (YOLOv8).
struct MadeHead {
  std::vector<float> box = {0.5F, 0.5F, 0, 0};  ///< the first four values
  std::vector<float> classes = {1, 0};          ///< probabilities
  bool yolov8 = false;                          ///< (4 + C) x N without objectness
  int boxes_per_cell = 1;
};

/// An ONNX model with cells of strides 8, 16 and 32.
std::string onnx_detection(int width, int height, const MadeHead& head);

/// How a YOLOv8 is exported.
struct MadeExport {
  int opset = 17;           ///< from 13 on, Split gets its sizes as an input
  bool open_sides = false;  ///< dynamic axes
  std::string metadata = {};
};

/// The head of a YOLOv8 with two classes as exported by Ultralytics. Each box extends from the
/// center of its cell by 1 cell to the left, 2 up, 2 to the right and 4 down. The score of the
/// first class is sigmoid(20 red - 10), with the red (0 to 1) of the cell's center pixel, that of
/// the second class sigmoid(-10).
std::string onnx_yolov8_export(int width, int height, const MadeExport& as);

/// An ONNX model of a single operator that does not exist.
std::string onnx_unknown_operator();

/// A Darknet network of one yolo layer with a grid of 8 px, three anchors of 8, 16 and 24 px, and
/// two classes; a cell whose pixels are red contains the first class with the first anchor.
std::string darknet_config(int width, int height);
std::string darknet_weights();

}  // namespace mh::test
