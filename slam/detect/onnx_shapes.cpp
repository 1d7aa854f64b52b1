// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "slam/detect/onnx_call.hpp"

namespace mh {
namespace {

using MaybeShape = std::optional<OnnxShape>;

// Rules for each operator: https://onnx.ai/onnx/operators

bool is_one_of(const std::string& op, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, op) != names.end();
}

std::int64_t at_or(const MaybeShape& list, std::size_t i, std::int64_t otherwise) {
  return list && i < list->size() ? (*list)[i] : otherwise;
}

/// The output shape of an operator whose window moves over all axes from the third on.
MaybeShape windowed(const OnnxCall& call, const OnnxShape& in, std::int64_t channels,
                    const OnnxShape& kernel) {
  if (in.size() != kernel.size() + 2) return std::nullopt;
  const OnnxNode& node = call.node;
  const MaybeShape strides = node.integers("strides"), dilations = node.integers("dilations"),
                   pads = node.integers("pads");
  const std::string padding = node.text("auto_pad");
  const bool same = padding.starts_with("SAME"), up = node.integer("ceil_mode", 0) != 0;
  OnnxShape out = {in[0], channels};
  for (std::size_t k = 0; k < kernel.size(); ++k) {
    const std::int64_t stride = at_or(strides, k, 1), side = in[k + 2];
    if (stride < 1) return std::nullopt;
    const std::int64_t room = side + at_or(pads, k, 0) + at_or(pads, k + kernel.size(), 0) -
                              at_or(dilations, k, 1) * (kernel[k] - 1) - 1;
    if (!same && room < 0) return std::nullopt;
    out.push_back(same ? (side + stride - 1) / stride
                       : (room + (up ? stride - 1 : 0)) / stride + 1);
  }
  return out;
}

MaybeShape convolved(const OnnxCall& call) {
  const OnnxShape *in = call.shape(0), *weights = call.shape(1);
  if (in == nullptr || weights == nullptr || weights->size() < 3) return std::nullopt;
  return windowed(call, *in, (*weights)[0], OnnxShape(weights->begin() + 2, weights->end()));
}

MaybeShape pooled(const OnnxCall& call) {
  const MaybeShape kernel = call.node.integers("kernel_shape");
  if (call.shape(0) == nullptr || call.shape(0)->size() < 3 || !kernel) return std::nullopt;
  return windowed(call, *call.shape(0), (*call.shape(0))[1], *kernel);
}

MaybeShape deconvolved(const OnnxCall& call) {
  const OnnxShape *in = call.shape(0), *weights = call.shape(1);
  if (in == nullptr || weights == nullptr || weights->size() < 3 || in->size() != weights->size() ||
      !call.node.text("auto_pad").empty())
    return std::nullopt;
  const MaybeShape strides = call.node.integers("strides"),
                   dilations = call.node.integers("dilations"), pads = call.node.integers("pads"),
                   more = call.node.integers("output_padding");
  OnnxShape out = {(*in)[0], (*weights)[1] * call.node.integer("group", 1)};
  const std::size_t sides = in->size() - 2;
  for (std::size_t k = 0; k < sides; ++k)
    out.push_back(at_or(strides, k, 1) * ((*in)[k + 2] - 1) + at_or(more, k, 0) +
                  at_or(dilations, k, 1) * ((*weights)[k + 2] - 1) + 1 - at_or(pads, k, 0) -
                  at_or(pads, k + sides, 0));
  return out;
}

MaybeShape resized(const OnnxCall& call) {
  const OnnxShape* in = call.shape(0);
  if (in == nullptr || call.node.attributes.contains("axes")) return std::nullopt;
  const bool early = call.node.op == "Upsample" || call.opset < 11;
  if (const OnnxTensor* sizes = call.constant(3); sizes != nullptr && !sizes->values.empty())
    return call.list("", 3);
  std::vector<double> scales;
  if (const OnnxTensor* given = call.constant(early ? 1 : 2)) scales = given->values;
  if (early && scales.empty())
    for (const float scale : call.node.floats("scales")) scales.push_back(scale);
  if (scales.size() != in->size()) return std::nullopt;
  OnnxShape out;
  for (std::size_t k = 0; k < scales.size(); ++k) {
    const double side = std::floor(static_cast<double>((*in)[k]) * scales[k]);
    if (!(side >= 0 && side < 1e9)) return std::nullopt;
    out.push_back(static_cast<std::int64_t>(side));
  }
  return out;
}

MaybeShape joined(const OnnxCall& call) {
  if (call.shape(0) == nullptr) return std::nullopt;
  OnnxShape out = *call.shape(0);
  const auto axis = call.axis(1, out.size());
  if (!axis) return std::nullopt;
  for (std::size_t i = 1; i < call.shapes.size(); ++i) {
    if (call.shapes[i] == nullptr || call.shapes[i]->size() != out.size()) return std::nullopt;
    for (std::size_t k = 0; k < out.size(); ++k)
      if (k != *axis && (*call.shapes[i])[k] != out[k]) return std::nullopt;
    out[*axis] += (*call.shapes[i])[*axis];
  }
  return out;
}

MaybeShape reshaped(const OnnxCall& call) {
  const OnnxShape* in = call.shape(0);
  MaybeShape out = call.list("shape", 1);
  if (in == nullptr || !out) return std::nullopt;
  if (call.node.integer("allowzero", 0) == 0)
    for (std::size_t k = 0; k < out->size(); ++k)
      if ((*out)[k] == 0) (*out)[k] = k < in->size() ? (*in)[k] : 0;
  const auto open = std::ranges::find(*out, -1);
  const auto all = value_count(*in);
  if (!all) return std::nullopt;
  if (open != out->end()) {
    *open = 1;
    const auto others = value_count(*out);
    if (!others || *others == 0) return std::nullopt;
    *open = static_cast<std::int64_t>(*all / *others);
  }
  return value_count(*out) == all ? out : std::nullopt;
}

MaybeShape flattened(const OnnxCall& call) {
  const OnnxShape* in = call.shape(0);
  if (in == nullptr) return std::nullopt;
  const std::int64_t stated = call.node.integer("axis", 1);
  const auto rank = static_cast<std::int64_t>(in->size());
  const std::int64_t axis = stated < 0 ? stated + rank : stated;
  if (axis < 0 || axis > rank) return std::nullopt;
  OnnxShape out = {1, 1};
  for (std::size_t k = 0; k < in->size(); ++k)
    out[static_cast<std::int64_t>(k) < axis ? 0 : 1] *= (*in)[k];
  return out;
}

MaybeShape transposed(const OnnxCall& call) {
  const OnnxShape* in = call.shape(0);
  if (in == nullptr) return std::nullopt;
  const MaybeShape order = call.node.integers("perm");
  OnnxShape out(in->rbegin(), in->rend());
  if (!order) return out;
  if (order->size() != in->size()) return std::nullopt;
  std::set<std::size_t> taken;
  for (std::size_t k = 0; k < order->size(); ++k) {
    const auto from = normal_axis((*order)[k], in->size());
    if (!from || !taken.insert(*from).second) return std::nullopt;
    out[k] = (*in)[*from];
  }
  return out;
}

MaybeShape squeezed(const OnnxCall& call) {
  const OnnxShape* in = call.shape(0);
  if (in == nullptr) return std::nullopt;
  const MaybeShape axes = call.axes(1, in->size());
  if (!axes && (call.has_input(1) || call.node.attributes.contains("axes"))) return std::nullopt;
  OnnxShape out;
  for (std::size_t k = 0; k < in->size(); ++k) {
    const bool named = axes && std::ranges::count(*axes, static_cast<std::int64_t>(k)) > 0;
    if (!(axes ? named : (*in)[k] == 1)) out.push_back((*in)[k]);
  }
  return out;
}

MaybeShape unsqueezed(const OnnxCall& call) {
  const OnnxShape* in = call.shape(0);
  const MaybeShape stated = call.list("axes", 1);
  if (in == nullptr || !stated || stated->size() > 16) return std::nullopt;
  const std::size_t rank = in->size() + stated->size();
  const MaybeShape axes = call.axes(1, rank);
  if (!axes) return std::nullopt;
  const std::set<std::int64_t> added(axes->begin(), axes->end());
  if (added.size() != axes->size()) return std::nullopt;
  OnnxShape out;
  auto next = in->begin();
  for (std::size_t k = 0; k < rank; ++k)
    out.push_back(added.contains(static_cast<std::int64_t>(k)) ? 1 : *next++);
  return out;
}

MaybeShape gathered(const OnnxCall& call) {
  const OnnxShape *in = call.shape(0), *indices = call.shape(1);
  if (in == nullptr || indices == nullptr) return std::nullopt;
  const auto axis = call.axis(0, in->size());
  if (!axis) return std::nullopt;
  const auto at = static_cast<std::ptrdiff_t>(*axis);
  OnnxShape out(in->begin(), in->begin() + at);
  out.insert(out.end(), indices->begin(), indices->end());
  out.insert(out.end(), in->begin() + at + 1, in->end());
  return out;
}

MaybeShape tiled(const OnnxCall& call) {
  const MaybeShape times = call.list("", 1);
  if (call.shape(0) == nullptr || !times || times->size() != call.shape(0)->size())
    return std::nullopt;
  OnnxShape out = *call.shape(0);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] *= (*times)[k];
  return out;
}

MaybeShape padded(const OnnxCall& call) {
  const MaybeShape pads = call.list("pads", 1);
  if (call.shape(0) == nullptr || !pads || pads->size() != 2 * call.shape(0)->size() ||
      call.has_input(3))
    return std::nullopt;
  OnnxShape out = *call.shape(0);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] += (*pads)[k] + (*pads)[k + out.size()];
  return out;
}

MaybeShape multiplied(const OnnxCall& call) {
  const OnnxShape *a = call.shape(0), *b = call.shape(1);
  if (a == nullptr || b == nullptr || a->size() < 2 || b->size() < 2) return std::nullopt;
  auto out = broadcast(OnnxShape(a->begin(), a->end() - 2), OnnxShape(b->begin(), b->end() - 2));
  if (!out) return std::nullopt;
  out->push_back((*a)[a->size() - 2]);
  out->push_back(b->back());
  return out;
}

MaybeShape reduced(const OnnxCall& call) {
  const OnnxShape* in = call.shape(0);
  if (in == nullptr) return std::nullopt;
  const MaybeShape axes = call.axes(1, in->size());
  if (!axes && (call.has_input(1) || call.node.attributes.contains("axes"))) return std::nullopt;
  OnnxShape out;
  for (std::size_t k = 0; k < in->size(); ++k) {
    if (axes && std::ranges::count(*axes, static_cast<std::int64_t>(k)) == 0)
      out.push_back((*in)[k]);
    else if (call.node.integer("keepdims", 1) != 0)
      out.push_back(1);
  }
  return out;
}

/// The output shape of an element-wise operator on all inputs.
MaybeShape by_value(const OnnxCall& call) {
  MaybeShape out = OnnxShape{};
  for (const OnnxShape* in : call.shapes) {
    if (in == nullptr) return std::nullopt;
    out = broadcast(*out, *in);
    if (!out) return std::nullopt;
  }
  return out;
}

MaybeShape range_shape(const OnnxCall& call) {
  for (std::size_t i = 0; i < 3; ++i)
    if (call.constant(i) == nullptr || call.constant(i)->values.size() != 1) return std::nullopt;
  const double count = std::ceil((call.constants[1]->values[0] - call.constants[0]->values[0]) /
                                 call.constants[2]->values[0]);
  if (!(std::abs(count) < 1e9)) return std::nullopt;
  return OnnxShape{std::max<std::int64_t>(0, static_cast<std::int64_t>(count))};
}

MaybeShape first_shape(const OnnxCall& call) {
  const std::string& op = call.node.op;
  const OnnxShape* in = call.shape(0);
  if (is_one_of(op, {"Add", "Sub", "Mul", "Div", "Pow", "Min", "Max", "Sum", "Equal", "Greater",
                     "Less", "And", "Or", "Where"}))
    return by_value(call);
  if (op == "Conv") return convolved(call);
  if (op == "ConvTranspose") return deconvolved(call);
  if (is_one_of(op, {"MaxPool", "AveragePool"})) return pooled(call);
  if (is_one_of(op, {"Resize", "Upsample"})) return resized(call);
  if (op == "Concat") return joined(call);
  if (op == "Reshape") return reshaped(call);
  if (op == "Flatten") return flattened(call);
  if (op == "Transpose") return transposed(call);
  if (op == "Squeeze") return squeezed(call);
  if (op == "Unsqueeze") return unsqueezed(call);
  if (op == "Gather") return gathered(call);
  if (op == "Tile") return tiled(call);
  if (op == "Pad") return padded(call);
  if (op == "MatMul") return multiplied(call);
  if (op.starts_with("Reduce")) return reduced(call);
  if (op == "Range") return range_shape(call);
  if (op == "ConstantOfShape") return call.list("", 0);
  if (op == "Expand") {
    const MaybeShape to = call.list("", 1);
    return in != nullptr && to ? broadcast(*in, *to) : std::nullopt;
  }
  if (in == nullptr) return std::nullopt;
  if (op == "Shape") return OnnxShape{static_cast<std::int64_t>(in->size())};
  if (op == "Slice") {
    const auto cuts = cuts_of(call);
    if (!cuts) return std::nullopt;
    OnnxShape out;
    for (const OnnxCut& cut : *cuts) out.push_back(cut.count);
    return out;
  }
  if (is_one_of(op, {"GlobalAveragePool", "GlobalMaxPool"}) && in->size() >= 2) {
    OnnxShape out(in->size(), 1);
    out[0] = (*in)[0], out[1] = (*in)[1];
    return out;
  }
  if (is_one_of(op, {"Sigmoid",
                     "Relu",
                     "LeakyRelu",
                     "PRelu",
                     "HardSwish",
                     "HardSigmoid",
                     "Tanh",
                     "Exp",
                     "Log",
                     "Softplus",
                     "Mish",
                     "Clip",
                     "Cast",
                     "Identity",
                     "Softmax",
                     "BatchNormalization",
                     "InstanceNormalization",
                     "Neg",
                     "Sqrt",
                     "Elu",
                     "Selu",
                     "Celu",
                     "Abs",
                     "Floor",
                     "Ceil",
                     "Round",
                     "Erf",
                     "Gelu",
                     "Dropout",
                     "Not",
                     "Reciprocal",
                     "LayerNormalization",
                     "Softsign",
                     "Sin",
                     "Cos"}))
    return *in;
  return std::nullopt;
}

}  // namespace

std::optional<std::size_t> normal_axis(std::int64_t axis, std::size_t rank) {
  const auto sides = static_cast<std::int64_t>(rank);
  if (axis < -sides || axis >= sides) return std::nullopt;
  return static_cast<std::size_t>(axis < 0 ? axis + sides : axis);
}

std::optional<OnnxShape> broadcast(const OnnxShape& a, const OnnxShape& b) {
  OnnxShape out(std::max(a.size(), b.size()), 1);
  const auto side = [&](const OnnxShape& of, std::size_t k) {
    const std::size_t missing = out.size() - of.size();
    return k < missing ? 1 : of[k - missing];
  };
  for (std::size_t k = 0; k < out.size(); ++k) {
    const std::int64_t p = side(a, k), q = side(b, k);
    if (p != q && p != 1 && q != 1) return std::nullopt;
    out[k] = p == 1 ? q : p;
  }
  return out;
}

std::vector<std::optional<OnnxShape>> output_shapes(const OnnxCall& call) {
  std::vector<std::optional<OnnxShape>> shapes(call.node.outputs.size());
  const OnnxShape* in = call.shape(0);
  if (call.node.op == "Split") {
    const auto sizes = split_sizes(call);
    const auto axis = in != nullptr ? call.axis(0, in->size()) : std::nullopt;
    for (std::size_t i = 0; sizes && axis && i < shapes.size() && i < sizes->size(); ++i) {
      shapes[i] = *in;
      (*shapes[i])[*axis] = (*sizes)[i];
    }
  } else if (!shapes.empty()) {
    shapes[0] = first_shape(call);
  }
  for (auto& shape : shapes)
    if (shape && !value_count(*shape)) shape.reset();
  return shapes;
}

}  // namespace mh
