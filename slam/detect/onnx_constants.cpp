// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>

#include "slam/detect/onnx_call.hpp"

namespace mh {
namespace {

/// Larger tensors are not precomputed.
constexpr std::size_t kMostComputed = std::size_t{1} << 24;

/// Strides of a shape's axes in its row-major values; 0 for axes along which the values repeat.
std::vector<std::size_t> steps_of(const OnnxShape& shape, std::size_t rank) {
  std::vector<std::size_t> steps(rank, 0);
  std::size_t step = 1;
  for (std::size_t k = shape.size(); k-- > 0;) {
    if (shape[k] != 1) steps[rank - shape.size() + k] = step;
    step *= static_cast<std::size_t>(shape[k]);
  }
  return steps;
}

/// Calls visit(place) for each place of a shape, row-major.
void for_each_place(const OnnxShape& shape,
                    const std::function<void(const std::vector<std::size_t>&)>& visit) {
  std::size_t count = value_count(shape).value_or(0);
  std::vector<std::size_t> place(shape.size(), 0);
  for (; count > 0; --count) {
    visit(place);
    for (std::size_t k = shape.size(); k-- > 0;) {
      if (++place[k] < static_cast<std::size_t>(shape[k])) break;
      place[k] = 0;
    }
  }
}

std::size_t index_at(const std::vector<std::size_t>& place, const std::vector<std::size_t>& steps) {
  std::size_t index = 0;
  for (std::size_t k = 0; k < place.size(); ++k) index += place[k] * steps[k];
  return index;
}

/// A tensor whose values are those of `in` at the places that `from` returns.
OnnxTensor picked(const OnnxTensor& in, const OnnxShape& shape,
                  const std::function<std::size_t(const std::vector<std::size_t>&)>& from) {
  OnnxTensor out{.shape = shape, .is_float = in.is_float, .values = {}};
  for_each_place(shape, [&](const auto& place) { out.values.push_back(in.values[from(place)]); });
  return out;
}

double of_two(std::string_view op, double a, double b, bool is_float) {
  if (op == "Add") return a + b;
  if (op == "Sub") return a - b;
  if (op == "Mul") return a * b;
  if (op == "Div") return is_float ? a / b : b == 0 ? 0 : std::trunc(a / b);
  if (op == "Pow") return std::pow(a, b);
  if (op == "Min") return std::min(a, b);
  if (op == "Max") return std::max(a, b);
  if (op == "Equal") return a == b ? 1 : 0;
  if (op == "Greater") return a > b ? 1 : 0;
  if (op == "Less") return a < b ? 1 : 0;
  if (op == "And") return a != 0 && b != 0 ? 1 : 0;
  return a != 0 || b != 0 ? 1 : 0;  // Or
}

constexpr std::array<std::string_view, 12> kOfTwo = {
    "Add", "Sub", "Mul", "Div", "Pow", "Min", "Max", "Equal", "Greater", "Less", "And", "Or"};

std::optional<double> of_one(std::string_view op, double v) {
  if (op == "Neg") return -v;
  if (op == "Sqrt") return std::sqrt(v);
  if (op == "Exp") return std::exp(v);
  if (op == "Log") return std::log(v);
  if (op == "Floor") return std::floor(v);
  if (op == "Ceil") return std::ceil(v);
  if (op == "Abs") return std::abs(v);
  if (op == "Not") return v == 0 ? 1 : 0;
  if (op == "Reciprocal") return 1 / v;
  if (op == "Identity" || op == "Dropout") return v;
  return std::nullopt;
}

/// TensorProto.DataType of floats: 32, 16 and 64 bits.
bool is_float_type(std::int64_t type) {
  return type == 1 || type == 10 || type == 11;
}

OnnxTensor cast(const OnnxTensor& in, std::int64_t type) {
  OnnxTensor out = in;
  out.is_float = is_float_type(type);
  for (double& v : out.values)
    if (type == 9)
      v = v != 0 ? 1 : 0;
    else if (!out.is_float)
      v = std::trunc(v);
  return out;
}

std::optional<OnnxTensor> gathered(const OnnxCall& call, const OnnxShape& shape) {
  const OnnxTensor &in = *call.constants[0], &indices = *call.constants[1];
  const std::size_t axis = *call.axis(0, in.shape.size()), ranks = indices.shape.size();
  for (const double index : indices.values)
    if (!normal_axis(static_cast<std::int64_t>(index), static_cast<std::size_t>(in.shape[axis])))
      return std::nullopt;
  const auto steps = steps_of(in.shape, in.shape.size()), at = steps_of(indices.shape, ranks);
  return picked(in, shape, [&](const std::vector<std::size_t>& place) {
    std::size_t which = 0, index = 0;
    for (std::size_t k = 0; k < ranks; ++k) which += place[axis + k] * at[k];
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const std::size_t side = k < axis ? place[k]
                               : k > axis
                                   ? place[k + ranks - 1]
                                   : *normal_axis(static_cast<std::int64_t>(indices.values[which]),
                                                  static_cast<std::size_t>(in.shape[axis]));
      index += side * steps[k];
    }
    return index;
  });
}

OnnxTensor joined(const OnnxCall& call, const OnnxShape& shape) {
  const std::size_t axis = *call.axis(1, shape.size());
  OnnxTensor out{.shape = shape, .is_float = call.constants[0]->is_float, .values = {}};
  for_each_place(shape, [&](std::vector<std::size_t> place) {
    std::size_t which = 0;
    for (; place[axis] >= static_cast<std::size_t>(call.constants[which]->shape[axis]); ++which)
      place[axis] -= static_cast<std::size_t>(call.constants[which]->shape[axis]);
    const OnnxTensor& in = *call.constants[which];
    out.values.push_back(in.values[index_at(place, steps_of(in.shape, place.size()))]);
  });
  return out;
}

OnnxTensor transposed(const OnnxCall& call, const OnnxShape& shape) {
  const OnnxTensor& in = *call.constants[0];
  const auto order = call.node.integers("perm");
  const auto steps = steps_of(in.shape, shape.size());
  return picked(in, shape, [&](const std::vector<std::size_t>& place) {
    std::size_t index = 0;
    for (std::size_t k = 0; k < place.size(); ++k)
      index +=
          place[k] * steps[order ? *normal_axis((*order)[k], place.size()) : place.size() - 1 - k];
    return index;
  });
}

OnnxTensor sliced(const OnnxCall& call, const OnnxShape& shape) {
  const OnnxTensor& in = *call.constants[0];
  const auto steps = steps_of(in.shape, shape.size());
  const std::vector<OnnxCut> cuts = *cuts_of(call);
  return picked(in, shape, [&](const std::vector<std::size_t>& place) {
    std::size_t index = 0;
    for (std::size_t k = 0; k < place.size(); ++k)
      index += static_cast<std::size_t>(cuts[k].start +
                                        cuts[k].step * static_cast<std::int64_t>(place[k])) *
               steps[k];
    return index;
  });
}

OnnxTensor tiled(const OnnxTensor& in, const OnnxShape& shape) {
  const auto steps = steps_of(in.shape, shape.size());
  return picked(in, shape, [&](std::vector<std::size_t> place) {
    for (std::size_t k = 0; k < place.size(); ++k)
      place[k] %= static_cast<std::size_t>(in.shape[k]);
    return index_at(place, steps);
  });
}

std::vector<OnnxTensor> split(const OnnxCall& call,
                              const std::vector<std::optional<OnnxShape>>& shapes) {
  const OnnxTensor& in = *call.constants[0];
  const std::size_t axis = *call.axis(0, in.shape.size());
  const auto steps = steps_of(in.shape, in.shape.size());
  std::vector<OnnxTensor> parts;
  std::size_t begin = 0;
  for (const auto& shape : shapes) {
    parts.push_back(picked(in, *shape, [&](std::vector<std::size_t> place) {
      place[axis] += begin;
      return index_at(place, steps);
    }));
    begin += static_cast<std::size_t>((*shape)[axis]);
  }
  return parts;
}

OnnxTensor counted_up(const OnnxCall& call, const OnnxShape& shape) {
  OnnxTensor out{.shape = shape, .is_float = call.constants[0]->is_float, .values = {}};
  for (std::int64_t i = 0; i < shape[0]; ++i)
    out.values.push_back(call.constants[0]->values[0] +
                         static_cast<double>(i) * call.constants[2]->values[0]);
  return out;
}

OnnxTensor filled(const OnnxCall& call, const OnnxShape& shape) {
  const auto value = call.node.tensor("value");
  const bool given = value && !value->values.empty();
  return {shape, given ? value->is_float : true,
          std::vector<double>(*value_count(shape), given ? value->values[0] : 0)};
}

OnnxTensor chosen(const OnnxCall& call, const OnnxShape& shape) {
  const OnnxTensor condition = expanded(*call.constants[0], shape),
                   yes = expanded(*call.constants[1], shape),
                   no = expanded(*call.constants[2], shape);
  OnnxTensor out = yes;
  for (std::size_t i = 0; i < out.values.size(); ++i)
    if (condition.values[i] == 0) out.values[i] = no.values[i];
  return out;
}

OnnxTensor of_two_tensors(const OnnxCall& call, const OnnxShape& shape) {
  OnnxTensor out = expanded(*call.constants[0], shape);
  const OnnxTensor b = expanded(*call.constants[1], shape);
  const std::string_view op = call.node.op;
  const bool truth = std::ranges::find(kOfTwo, op) - kOfTwo.begin() >= 7;
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = of_two(op, out.values[i], b.values[i], out.is_float);
  if (truth) out.is_float = false;
  return out;
}

std::optional<OnnxTensor> first_value(const OnnxCall& call, const OnnxShape& shape) {
  const std::string& op = call.node.op;
  const OnnxTensor& in = *call.constants[0];
  if (call.constants.size() == 2 && std::ranges::find(kOfTwo, op) != kOfTwo.end())
    return of_two_tensors(call, shape);
  if (op == "Cast") return cast(in, call.node.integer("to", 1));
  if (op == "Reshape" || op == "Flatten" || op == "Squeeze" || op == "Unsqueeze")
    return OnnxTensor{shape, in.is_float, in.values};
  if (op == "Gather") return gathered(call, shape);
  if (op == "Concat") return joined(call, shape);
  if (op == "Transpose") return transposed(call, shape);
  if (op == "Slice") return sliced(call, shape);
  if (op == "Tile") return tiled(in, shape);
  if (op == "Expand") return expanded(in, shape);
  if (op == "Range") return counted_up(call, shape);
  if (op == "ConstantOfShape") return filled(call, shape);
  if (op == "Where") return chosen(call, shape);
  OnnxTensor out = in;
  for (double& v : out.values) {
    const auto value = of_one(op, v);
    if (!value) return std::nullopt;
    v = *value;
  }
  return out;
}

}  // namespace

std::optional<OnnxShape> OnnxCall::list(const char* attribute, std::size_t input) const {
  if (auto stated = node.integers(attribute)) return stated;
  const OnnxTensor* given = constant(input);
  if (given == nullptr || given->shape.size() > 1) return std::nullopt;
  OnnxShape values;
  constexpr double kMost = 1 << 30;  // a larger value means "to the end"
  for (const double v : given->values)
    values.push_back(static_cast<std::int64_t>(std::clamp(v, -kMost, kMost)));
  return values;
}

std::optional<OnnxShape> OnnxCall::axes(std::size_t input, std::size_t rank) const {
  auto stated = list("axes", input);
  if (!stated) return std::nullopt;
  for (std::int64_t& axis : *stated) {
    const auto normal = normal_axis(axis, rank);
    if (!normal) return std::nullopt;
    axis = static_cast<std::int64_t>(*normal);
  }
  return stated;
}

std::optional<std::size_t> OnnxCall::axis(std::int64_t otherwise, std::size_t rank) const {
  return normal_axis(node.integer("axis", otherwise), rank);
}

std::optional<std::vector<OnnxCut>> cuts_of(const OnnxCall& call) {
  if (call.shape(0) == nullptr) return std::nullopt;
  const OnnxShape& in = *call.shape(0);
  const auto starts = call.list("starts", 1), ends = call.list("ends", 2);
  if (!starts || !ends || starts->size() != ends->size()) return std::nullopt;
  auto axes = call.axes(3, in.size());
  auto steps = call.list("steps", 4);
  if ((!axes && (call.has_input(3) || call.node.attributes.contains("axes"))) ||
      (!steps && call.has_input(4)))
    return std::nullopt;
  if (!axes) {
    axes.emplace();
    for (std::size_t k = 0; k < starts->size(); ++k) axes->push_back(static_cast<std::int64_t>(k));
  }
  if (!steps) steps.emplace(starts->size(), 1);
  if (axes->size() != starts->size() || steps->size() != starts->size() || axes->size() > in.size())
    return std::nullopt;
  std::vector<OnnxCut> cuts;
  for (const std::int64_t side : in) cuts.push_back({0, 1, side});
  for (std::size_t i = 0; i < axes->size(); ++i) {
    const auto axis = static_cast<std::size_t>((*axes)[i]);
    const std::int64_t side = in[axis], step = (*steps)[i];
    if (step == 0) return std::nullopt;
    const auto place = [&](std::int64_t v) { return v < 0 ? v + side : v; };
    const std::int64_t least = step > 0 ? 0 : -1, most = step > 0 ? side : side - 1;
    const std::int64_t start = std::clamp(place((*starts)[i]), step > 0 ? 0 : std::int64_t{0},
                                          std::max<std::int64_t>(most, 0)),
                       end = std::clamp(place((*ends)[i]), least, std::max(most, least));
    const std::int64_t length = step > 0 ? end - start : start - end;
    const std::int64_t by = std::abs(step);
    cuts[axis] = {start, step, length > 0 ? (length + by - 1) / by : 0};
  }
  return cuts;
}

std::optional<OnnxShape> split_sizes(const OnnxCall& call) {
  const std::size_t parts = call.node.outputs.size();
  const auto axis = call.shape(0) != nullptr ? call.axis(0, call.shape(0)->size()) : std::nullopt;
  if (!axis || parts == 0) return std::nullopt;
  const std::int64_t side = (*call.shape(0))[*axis];
  auto sizes = call.list("split", 1);
  if (!sizes) {
    if (call.has_input(1)) return std::nullopt;
    const auto count = static_cast<std::int64_t>(parts);
    const std::int64_t each = (side + count - 1) / count;
    sizes.emplace(parts, each);
    sizes->back() = side - each * (count - 1);
  }
  std::int64_t sum = 0;
  for (const std::int64_t size : *sizes) {
    if (size < 0 || size > side) return std::nullopt;
    sum += size;
  }
  return sizes->size() == parts && sum == side ? sizes : std::nullopt;
}

std::optional<std::vector<OnnxTensor>> evaluate(
    const OnnxCall& call, const std::vector<std::optional<OnnxShape>>& shapes) {
  for (const auto& shape : shapes)
    if (!shape || value_count(*shape).value_or(kMostComputed + 1) > kMostComputed)
      return std::nullopt;
  if (shapes.empty()) return std::nullopt;
  if (call.node.op == "Shape" && call.node.attributes.empty()) {
    OnnxTensor sides{.shape = *shapes[0], .is_float = false, .values = {}};
    for (const std::int64_t side : *call.shape(0))
      sides.values.push_back(static_cast<double>(side));
    return std::vector{sides};
  }
  if (call.constants.empty()) return std::nullopt;
  for (std::size_t i = 0; i < call.constants.size(); ++i)
    if (call.constants[i] == nullptr && (i == 0 || call.has_input(i))) return std::nullopt;
  if (call.node.op == "Split") return split(call, shapes);
  auto value = first_value(call, *shapes[0]);
  if (!value || value->values.size() != value_count(*shapes[0])) return std::nullopt;
  value->shape = *shapes[0];
  if (value->is_float)
    for (double& v : value->values) v = static_cast<float>(v);
  return std::vector{*std::move(value)};
}

OnnxTensor expanded(const OnnxTensor& constant, const OnnxShape& shape) {
  const auto steps = steps_of(constant.shape, shape.size());
  return picked(constant, shape,
                [&](const std::vector<std::size_t>& place) { return index_at(place, steps); });
}

}  // namespace mh
