// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/onnx_rewrite.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "slam/detect/onnx_call.hpp"

namespace mh {
namespace {

class Rewriter {
 public:
  explicit Rewriter(OnnxGraph graph) : graph_(std::move(graph)) {
    for (const auto& [name, shape] : graph_.inputs) shapes_[name] = shape;
    for (const auto& [name, bytes] : graph_.weights) shapes_[name] = onnx_tensor_shape(bytes);
    for (const OnnxNode& node : graph_.nodes)
      names_.insert(node.outputs.begin(), node.outputs.end());
    for (const auto& [name, shape] : shapes_) names_.insert(name);
  }

  OnnxGraph run() {
    for (const OnnxNode& node : std::exchange(graph_.nodes, {})) visit(node);
    for (const auto& name : halves()) {  // OpenCV 4.6 cannot read them
      constant(name);
      keep(name);
    }
    return std::move(graph_);
  }

 private:
  const OnnxShape* shape(const std::string& name) const {
    const auto found = shapes_.find(name);
    return found == shapes_.end() ? nullptr : &found->second;
  }

  const OnnxTensor* constant(const std::string& name) {
    if (const auto found = constants_.find(name); found != constants_.end()) return &found->second;
    const auto weights = graph_.weights.find(name);
    if (weights == graph_.weights.end()) return nullptr;
    auto values = read_onnx_tensor(weights->second);
    return values ? &constants_.emplace(name, *std::move(values)).first->second : nullptr;
  }

  std::vector<std::string> halves() const {
    std::vector<std::string> names;
    for (const auto& [name, bytes] : graph_.weights)
      if (is_half_precision(bytes)) names.push_back(name);
    return names;
  }

  /// Adds a constant to the graph unless the graph already contains it.
  void keep(const std::string& name) {
    const auto found = constants_.find(name);
    if (found == constants_.end()) return;
    const auto weights = graph_.weights.find(name);
    if (weights != graph_.weights.end()) {
      if (!is_half_precision(weights->second)) return;
      graph_.weights.erase(weights);
    }
    graph_.constants.emplace(name, found->second);
  }

  std::string unused_name() {
    for (;; ++made_)
      if (std::string name = fmt::format("rewritten_{}", made_); names_.insert(name).second)
        return name;
  }

  std::string add_constant(OnnxTensor tensor) {
    std::string name = unused_name();
    shapes_[name] = tensor.shape;
    constants_.emplace(name, std::move(tensor));
    return name;
  }

  std::string add_list(const OnnxShape& values) {
    OnnxTensor tensor{.shape = {static_cast<std::int64_t>(values.size())},
                      .is_float = false,
                      .values = {values.begin(), values.end()}};
    return add_constant(std::move(tensor));
  }

  void add(OnnxNode node) {
    for (const std::string& name : node.inputs) keep(name);
    graph_.nodes.push_back(std::move(node));
  }

  /// A node with the same name and outputs.
  static OnnxNode like(const OnnxNode& node, std::string op, std::vector<std::string> inputs) {
    return {.op = std::move(op),
            .inputs = std::move(inputs),
            .outputs = node.outputs,
            .attributes = {},
            .others = node.others};
  }

  OnnxCall call_of(const OnnxNode& node) {
    OnnxCall call{.node = node, .opset = graph_.opset, .shapes = {}, .constants = {}};
    for (const std::string& name : node.inputs) {
      call.shapes.push_back(shape(name));
      call.constants.push_back(constant_in(node, name));
    }
    return call;
  }

  /// Only the shape of convolution weights is read, since they are large.
  const OnnxTensor* constant_in(const OnnxNode& node, const std::string& name) {
    const bool weighs = node.op == "Conv" || node.op == "ConvTranspose" || node.op == "Gemm" ||
                        node.op == "BatchNormalization";
    return weighs ? nullptr : constant(name);
  }

  void visit(const OnnxNode& node) {
    if (node.op == "Constant" && node.outputs.size() == 1) {
      if (auto value = constant_value(node)) {
        set_constant(node.outputs[0], *std::move(value));
        return;
      }
    }
    const OnnxCall call = call_of(node);
    const auto shapes = output_shapes(call);
    if (auto values = evaluate(call, shapes)) {
      for (std::size_t i = 0; i < values->size(); ++i)
        set_constant(node.outputs[i], std::move((*values)[i]));
      return;
    }
    for (std::size_t i = 0; i < shapes.size(); ++i)
      if (shapes[i] && !node.outputs[i].empty()) shapes_[node.outputs[i]] = *shapes[i];
    rewrite(call, shapes.empty() ? std::nullopt : shapes[0]);
  }

  void set_constant(const std::string& name, OnnxTensor value) {
    shapes_[name] = value.shape;
    constants_.insert_or_assign(name, std::move(value));
  }

  static std::optional<OnnxTensor> constant_value(const OnnxNode& node) {
    if (node.attributes.contains("value_int"))
      return OnnxTensor{{}, false, {static_cast<double>(node.integer("value_int", 0))}};
    if (const auto list = node.integers("value_ints"))
      return OnnxTensor{
          {static_cast<std::int64_t>(list->size())}, false, {list->begin(), list->end()}};
    return node.tensor("value");
  }

  void rewrite(const OnnxCall& call, const std::optional<OnnxShape>& out) {
    const OnnxNode& node = call.node;
    const std::string& op = node.op;
    const bool arithmetic = op == "Add" || op == "Sub" || op == "Mul" || op == "Div";
    if (op == "Split")
      rewrite_split(call);
    else if (arithmetic && out && call.shapes.size() == 2)
      rewrite_arithmetic(call, *out);
    else if ((op == "Squeeze" || op == "Unsqueeze") && out)
      reshape(node, node.inputs[0], *out);
    else if (op.starts_with("Reduce") && call.has_input(1) && call.shape(0) != nullptr)
      rewrite_reduce(call);
    else if (op == "Slice")
      rewrite_slice(call);
    else if (op == "Gather" && out)
      rewrite_gather(call, *out);
    else if (op == "Clip" && node.inputs.size() > 1)
      rewrite_clip(call);
    else if (op == "Expand" && out && call.shape(0) != nullptr && *call.shape(0) == *out)
      add(like(node, "Identity", {node.inputs[0]}));
    else if (op == "Reshape" && out)
      reshape(node, node.inputs[0], *out);
    else if (op == "Softmax" && graph_.opset >= 13 && !node.attributes.contains("axis"))
      with_axis(node, -1);
    else
      add(node);
  }

  void with_axis(OnnxNode node, std::int64_t axis) {
    node.set("axis", axis);
    add(std::move(node));
  }

  void reshape(const OnnxNode& node, const std::string& from, const OnnxShape& to) {
    add(like(node, "Reshape", {from, add_list(to)}));
  }

  void rewrite_split(const OnnxCall& call) {
    const auto sizes = split_sizes(call);
    if (!sizes) return add(call.node);
    if (sizes->size() == 1) return add(like(call.node, "Identity", {call.node.inputs[0]}));
    OnnxNode node = like(call.node, "Split", {call.node.inputs[0]});
    node.set("axis", static_cast<std::int64_t>(*call.axis(0, call.shape(0)->size())));
    node.set("split", *sizes);
    add(std::move(node));
  }

  /// A constant of several values is expanded to the shape of the other input. OpenCV itself
  /// handles constants of one value, or of one value per channel.
  void rewrite_arithmetic(const OnnxCall& call, const OnnxShape& out) {
    const bool first = call.constants[0] != nullptr;
    const std::size_t of = first ? 0 : 1;
    const OnnxTensor* given = call.constants[of];
    const OnnxShape& other = *call.shapes[1 - of];
    const bool inverse = first && call.node.op == "Div";
    if (given == nullptr || given->values.size() == 1 || other != out || out.empty() ||
        (is_per_channel(given->shape, out) && !inverse))
      return add(call.node);
    OnnxNode node = call.node;
    std::string input = node.inputs[1 - of];
    if (inverse) {  // OpenCV computes c / x as x / c
      const std::string one = add_constant({{}, true, {1}}), inverted = unused_name();
      add({.op = "Div",
           .inputs = {one, input},
           .outputs = {inverted},
           .attributes = {},
           .others = ""});
      node = like(node, "Mul", {});
      input = inverted;
    }
    const std::string repeated = add_constant(expanded(*given, out));
    node.inputs = first ? std::vector{repeated, input} : std::vector{input, repeated};
    if (node.op == "Mul" || node.op == "Div")
      node.set("axis", std::int64_t{0});  // for OpenCV's Scale layer
    add(std::move(node));
  }

  static bool is_per_channel(const OnnxShape& constant, const OnnxShape& out) {
    const std::size_t missing = out.size() - constant.size();
    for (std::size_t k = 0; k < constant.size(); ++k)
      if (constant[k] != 1 && missing + k != 1) return false;
    return true;
  }

  void rewrite_reduce(const OnnxCall& call) {
    const auto axes = call.axes(1, call.shape(0)->size());
    if (!axes) return add(call.node);
    OnnxNode node = call.node;
    node.inputs.resize(1);
    node.set("axes", *axes);
    add(std::move(node));
  }

  void rewrite_slice(const OnnxCall& call) {
    const auto cuts = cuts_of(call);
    if (!cuts || std::ranges::any_of(
                     *cuts, [](const OnnxCut& cut) { return cut.step < 1 || cut.count < 1; }))
      return add(call.node);
    slice(call.node, call.node.outputs, *cuts);
  }

  void slice(const OnnxNode& node, const std::vector<std::string>& to,
             const std::vector<OnnxCut>& cuts) {
    OnnxShape starts, ends, axes, steps;
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      starts.push_back(cuts[k].start);
      ends.push_back(cuts[k].start + (cuts[k].count - 1) * cuts[k].step + 1);
      axes.push_back(static_cast<std::int64_t>(k));
      steps.push_back(cuts[k].step);
    }
    OnnxNode sliced =
        like(node, "Slice", {node.inputs[0], add_list(starts), add_list(ends), add_list(axes)});
    if (std::ranges::any_of(steps, [](std::int64_t step) { return step != 1; }))
      sliced.inputs.push_back(add_list(steps));
    sliced.outputs = to;
    add(std::move(sliced));
  }

  /// Rewrites a Gather of consecutive indices as a Slice.
  void rewrite_gather(const OnnxCall& call, const OnnxShape& out) {
    const OnnxTensor* indices = call.constant(1);
    if (indices == nullptr || indices->values.empty() || call.shape(0) == nullptr)
      return add(call.node);
    const OnnxShape& in = *call.shape(0);
    const std::size_t axis = *call.axis(0, in.size());
    const auto side = static_cast<std::size_t>(in[axis]);
    const auto first = normal_axis(static_cast<std::int64_t>(indices->values[0]), side);
    for (std::size_t i = 0; i < indices->values.size(); ++i)
      if (const auto index = normal_axis(static_cast<std::int64_t>(indices->values[i]), side);
          !first || index != *first + i)
        return add(call.node);
    std::vector<OnnxCut> cuts;
    for (const std::int64_t length : in) cuts.push_back({0, 1, length});
    cuts[axis] = {static_cast<std::int64_t>(*first), 1,
                  static_cast<std::int64_t>(indices->values.size())};
    if (indices->shape.size() == 1) return slice(call.node, call.node.outputs, cuts);
    OnnxNode unnamed = call.node;
    unnamed.others = "";
    const std::string sliced = unused_name();
    slice(unnamed, {sliced}, cuts);
    reshape(call.node, sliced, out);
  }

  void rewrite_clip(const OnnxCall& call) {
    OnnxNode node = like(call.node, "Clip", {call.node.inputs[0]});
    for (const auto& [name, i] : {std::pair("min", std::size_t{1}), {"max", std::size_t{2}}}) {
      if (!call.has_input(i)) continue;
      const OnnxTensor* limit = call.constant(i);
      if (limit == nullptr || limit->values.size() != 1) return add(call.node);
      node.set(name, static_cast<float>(limit->values[0]));
    }
    add(std::move(node));
  }

  OnnxGraph graph_;
  std::map<std::string, OnnxShape> shapes_;
  std::map<std::string, OnnxTensor> constants_;
  std::set<std::string> names_;
  int made_ = 0;
};

}  // namespace

std::optional<std::string> rewrite_onnx(std::string_view model, const InputSize& input) {
  auto graph = read_onnx_graph(model);
  if (!graph || graph->nodes.empty() || graph->inputs.size() != 1) return std::nullopt;
  OnnxShape& shape = graph->inputs.begin()->second;
  if (shape.size() != 4) return std::nullopt;
  const OnnxShape sides = {1, 3, input.height, input.width};
  for (std::size_t k = 0; k < sides.size(); ++k)
    if (shape[k] <= 0) shape[k] = sides[k];
  return write_onnx_graph(Rewriter(*std::move(graph)).run());
}

}  // namespace mh
