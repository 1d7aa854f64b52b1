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
/// @param dims  0: left open
std::string value(int tag, const std::string& name, const std::vector<std::int64_t>& dims);
std::string model(const std::string& graph, int opset = 11);
/// To be appended to a model.
std::string metadata(const std::string& key, const std::string& content);

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

/// How a YOLOv8 is exported.
struct MadeExport {
  int opset = 17;           ///< from 13 on, Split takes its sizes as an input
  bool open_sides = false;  ///< dynamic axes
  std::string metadata = {};
};

/// The head of YOLOv8 as Ultralytics exports it, of two classes. Each box reaches from its cell's
/// center 1 cell to the left, 2 up, 2 to the right and 4 down. The first class has the score
/// sigmoid(20 red - 10) of the red (0 to 1) of the cell's center pixel, the second sigmoid(-10).
std::string onnx_yolov8_export(int width, int height, const MadeExport& as);

/// An ONNX model of one operator that nobody implements.
std::string onnx_unknown_operator();

/// A Darknet network of one yolo layer with a grid of 8 px, three anchors of 8, 16 and 24 px, and
/// two classes; a cell shows the first class with the first anchor where its pixels are red.
std::string darknet_config(int width, int height);
std::string darknet_weights();

}  // namespace mh::test
