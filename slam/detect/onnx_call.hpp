// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "slam/detect/onnx_graph.hpp"

namespace mh {

/// A node with what is known about its inputs.
struct OnnxCall {
  const OnnxNode& node;
  std::int64_t opset = 0;
  std::vector<const OnnxShape*> shapes;      ///< of its inputs; null: unknown, or no input
  std::vector<const OnnxTensor*> constants;  ///< null: not constant, or no input

  const OnnxShape* shape(std::size_t i) const { return i < shapes.size() ? shapes[i] : nullptr; }
  const OnnxTensor* constant(std::size_t i) const {
    return i < constants.size() ? constants[i] : nullptr;
  }
  bool has_input(std::size_t i) const { return i < node.inputs.size() && !node.inputs[i].empty(); }
  /// A list of whole numbers that older operator sets keep in an attribute, newer ones in an input.
  std::optional<OnnxShape> list(const char* attribute, std::size_t input) const;
  /// A list() of axes of the first input, counted from 0; nullopt if there is none or an axis is
  /// out of range.
  std::optional<OnnxShape> axes(std::size_t input, std::size_t rank) const;
  /// The attribute `axis`, counted from 0; `otherwise` if absent.
  std::optional<std::size_t> axis(std::int64_t otherwise, std::size_t rank) const;
};

/// Converts an operator's axis, counted from the end if negative, to one counted from 0; nullopt if
/// out of range.
std::optional<std::size_t> normal_axis(std::int64_t axis, std::size_t rank);

/// The part of an axis that Slice takes.
struct OnnxCut {
  std::int64_t start = 0, step = 1, count = 0;
};
/// The cut of each axis of the first input.
std::optional<std::vector<OnnxCut>> cuts_of(const OnnxCall& call);

/// Sizes of the parts into which Split divides its axis.
std::optional<OnnxShape> split_sizes(const OnnxCall& call);

/// The broadcast shape by ONNX's rules (those of NumPy); nullopt if the shapes do not fit.
std::optional<OnnxShape> broadcast(const OnnxShape& a, const OnnxShape& b);

/// The shapes of the outputs, for those operators that detectors are made of; nullopt where
/// unknown.
std::vector<std::optional<OnnxShape>> output_shapes(const OnnxCall& call);

/// The values of the outputs, if all inputs are constant; otherwise nullopt.
/// @param shapes  from output_shapes()
std::optional<std::vector<OnnxTensor>> evaluate(
    const OnnxCall& call, const std::vector<std::optional<OnnxShape>>& shapes);

/// A constant repeated to a shape that it can be broadcast to.
OnnxTensor expanded(const OnnxTensor& constant, const OnnxShape& shape);

}  // namespace mh
