// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

using OnnxShape = std::vector<std::int64_t>;

/// A constant: its values row-major. Booleans and integers of all widths are stored as integers.
struct OnnxTensor {
  OnnxShape shape;
  bool is_float = true;
  std::vector<double> values;
};

/// How many values a tensor of that shape has; nullopt if a side is negative, or if there are too
/// many to compute with.
std::optional<std::size_t> value_count(const OnnxShape& shape);

/// nullopt if the bytes are not a TensorProto with as many values as its shape states.
std::optional<OnnxTensor> read_onnx_tensor(std::string_view bytes);
OnnxShape onnx_tensor_shape(std::string_view bytes);
bool is_half_precision(std::string_view tensor_bytes);
/// Written as 32-bit floats, or 64-bit integers.
std::string write_onnx_tensor(const std::string& name, const OnnxTensor& tensor);

/// An operation of a graph.
struct OnnxNode {
  std::string op;
  std::vector<std::string> inputs, outputs;
  std::map<std::string, std::string, std::less<>> attributes;  ///< bytes of each AttributeProto
  std::string others;  ///< bytes of the other fields, unchanged

  std::int64_t integer(std::string_view name, std::int64_t otherwise) const;
  std::optional<OnnxShape> integers(std::string_view name) const;
  std::vector<float> floats(std::string_view name) const;
  std::string text(std::string_view name) const;
  std::optional<OnnxTensor> tensor(std::string_view name) const;
  void set(const std::string& name, std::int64_t value);
  void set(const std::string& name, const OnnxShape& values);
  void set(const std::string& name, float value);
};

/// A network's graph. Points into the bytes from which it was read.
struct OnnxGraph {
  std::int64_t opset = 0;
  std::vector<OnnxNode> nodes;  ///< in an order in which they can be computed
  std::map<std::string, std::string_view, std::less<>> weights;  ///< TensorProto by name
  std::map<std::string, OnnxTensor> constants;                   ///< additional weights
  std::map<std::string, OnnxShape> inputs;  ///< shapes of the inputs that are not weights
  std::vector<std::string> outputs;
  std::string_view model;  ///< the bytes from which the graph was read
};

/// nullopt if the bytes are not a complete model.
std::optional<OnnxGraph> read_onnx_graph(std::string_view model);
/// The same model with this graph.
std::string write_onnx_graph(const OnnxGraph& graph);

}  // namespace mh
