// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/onnx_graph.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "slam/detect/protobuf.hpp"

namespace mh {
namespace {

// Tags of onnx.proto (ONNX 1.x).
namespace model {
constexpr std::uint64_t kGraph = 7, kOpset = 8, kOpsetDomain = 1, kOpsetVersion = 2;
}
namespace graph {
constexpr std::uint64_t kNode = 1, kName = 2, kInitializer = 5, kInput = 11, kOutput = 12;
}
namespace node {
constexpr std::uint64_t kInput = 1, kOutput = 2, kOp = 4, kAttribute = 5;
}
namespace attribute {
constexpr std::uint64_t kName = 1, kFloat = 2, kInteger = 3, kText = 4, kTensor = 5, kFloats = 7,
                        kIntegers = 8, kType = 20;
constexpr std::int64_t kIsFloat = 1, kIsInteger = 2, kIsIntegers = 7;
}  // namespace attribute
namespace tensor {
constexpr std::uint64_t kDims = 1, kType = 2, kFloats = 4, kInt32s = 5, kInt64s = 7, kName = 8,
                        kRaw = 9, kDoubles = 10, kUint64s = 11;
constexpr std::uint64_t kFloat = 1, kUint8 = 2, kInt8 = 3, kInt32 = 6, kInt64 = 7, kBool = 9,
                        kHalf = 10, kDouble = 11;
}  // namespace tensor
namespace value_info {  // ValueInfoProto.type, .tensor_type, .shape, .dim, .dim_value
constexpr std::uint64_t kName = 1, kType = 2, kTensor = 1, kElement = 1, kShape = 2, kDim = 1,
                        kSize = 1;
}

constexpr std::size_t kMostValues = std::size_t{1} << 28;
constexpr std::int64_t kMostWhole = std::int64_t{1} << 30;

/// Clamped to the range used in computations: a larger value means "to the end".
std::int64_t bounded(std::uint64_t value) {
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(value), -kMostWhole, kMostWhole);
}

std::string text_of(std::string_view message, std::uint64_t tag) {
  return std::string(proto_bytes(message, tag));
}

/// IEEE 754 half precision.
double from_half(std::uint16_t half) {
  const int exponent = half >> 10 & 0x1f, mantissa = half & 0x3ff;
  const double value = exponent == 0    ? std::ldexp(mantissa, -24)
                       : exponent == 31 ? (mantissa == 0 ? INFINITY : NAN)
                                        : std::ldexp(1024 + mantissa, exponent - 25);
  return (half & 0x8000) != 0 ? -value : value;
}

template <class T>
std::vector<double> packed(std::string_view bytes) {
  std::vector<double> values(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) {
    T value{};
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    values[i] = static_cast<double>(value);
  }
  return values;
}

std::vector<double> halves(std::vector<double> bits) {
  for (double& value : bits) value = from_half(static_cast<std::uint16_t>(value));
  return bits;
}

double bounded(double value) {
  const auto most = static_cast<double>(kMostWhole);
  return std::isnan(value) ? 0 : std::clamp(value, -most, most);
}

std::vector<double> whole_numbers(std::string_view message, std::uint64_t tag) {
  std::vector<double> values;
  for (const std::uint64_t v : proto_varints(message, tag))
    values.push_back(static_cast<double>(static_cast<std::int64_t>(v)));
  return values;
}

/// All fields of fixed width, packed or one by one.
template <class T>
std::vector<double> fixed(std::string_view message, std::uint64_t tag) {
  std::string bytes;
  for (const ProtoField& field : proto_fields(message, tag)) bytes += field.bytes;
  return packed<T>(bytes);
}

std::vector<double> values_of(std::string_view bytes, std::uint64_t type) {
  const std::string_view raw = proto_bytes(bytes, tensor::kRaw);
  switch (type) {
    case tensor::kFloat:
      return raw.empty() ? fixed<float>(bytes, tensor::kFloats) : packed<float>(raw);
    case tensor::kDouble:
      return raw.empty() ? fixed<double>(bytes, tensor::kDoubles) : packed<double>(raw);
    case tensor::kHalf:
      return halves(raw.empty() ? whole_numbers(bytes, tensor::kInt32s)
                                : packed<std::uint16_t>(raw));
    case tensor::kInt64:
      return raw.empty() ? whole_numbers(bytes, tensor::kInt64s) : packed<std::int64_t>(raw);
    case tensor::kInt32:
      return raw.empty() ? whole_numbers(bytes, tensor::kInt32s) : packed<std::int32_t>(raw);
    case tensor::kBool:
      return raw.empty() ? whole_numbers(bytes, tensor::kInt32s) : packed<std::uint8_t>(raw);
    default:
      return {};
  }
}

std::uint64_t type_of(std::string_view bytes) {
  const auto types = proto_varints(bytes, tensor::kType);
  return types.empty() ? 0 : types.back();
}

OnnxNode read_node(std::string_view bytes) {
  OnnxNode read;
  ProtoMessage walk(bytes);
  while (const auto field = walk.next()) {
    if (field->tag == node::kInput)
      read.inputs.emplace_back(field->bytes);
    else if (field->tag == node::kOutput)
      read.outputs.emplace_back(field->bytes);
    else if (field->tag == node::kOp)
      read.op = field->bytes;
    else if (field->tag == node::kAttribute)
      read.attributes[text_of(field->bytes, attribute::kName)] = field->bytes;
    else
      read.others += field->whole;
  }
  return read;
}

std::string write_node(const OnnxNode& written) {
  std::string bytes;
  for (const std::string& name : written.inputs) bytes += proto_bytes_field(node::kInput, name);
  for (const std::string& name : written.outputs) bytes += proto_bytes_field(node::kOutput, name);
  bytes += written.others + proto_bytes_field(node::kOp, written.op);
  for (const auto& [name, content] : written.attributes)
    bytes += proto_bytes_field(node::kAttribute, content);
  return bytes;
}

/// The shape of an input; a dimension that the model leaves open is 0.
OnnxShape read_input_shape(std::string_view info) {
  OnnxShape sides;
  const std::string_view type = proto_bytes(info, value_info::kType),
                         tensor_type = proto_bytes(type, value_info::kTensor),
                         shape = proto_bytes(tensor_type, value_info::kShape);
  for (const ProtoField& dim : proto_fields(shape, value_info::kDim)) {
    const auto stated = proto_varints(dim.bytes, value_info::kSize);
    sides.push_back(stated.empty() ? 0 : bounded(stated.back()));
  }
  return sides;
}

std::string write_value(const std::string& name, const OnnxShape& shape) {
  std::string dims;
  for (const std::int64_t side : shape)
    dims += proto_bytes_field(value_info::kDim, proto_number(value_info::kSize, side));
  const std::string type =
      proto_number(value_info::kElement, static_cast<std::int64_t>(tensor::kFloat)) +
      proto_bytes_field(value_info::kShape, dims);
  return proto_bytes_field(value_info::kName, name) +
         proto_bytes_field(value_info::kType, proto_bytes_field(value_info::kTensor, type));
}

std::string attribute_of(const std::string& name, const std::string& value, std::int64_t type) {
  return proto_bytes_field(attribute::kName, name) + value + proto_number(attribute::kType, type);
}

}  // namespace

std::optional<std::size_t> value_count(const OnnxShape& shape) {
  std::size_t count = 1;
  for (const std::int64_t side : shape) {
    if (side < 0 || static_cast<std::uint64_t>(side) > kMostValues) return std::nullopt;
    count *= static_cast<std::size_t>(side);
    if (count > kMostValues) return std::nullopt;
  }
  return count;
}

OnnxShape onnx_tensor_shape(std::string_view bytes) {
  OnnxShape shape;
  for (const std::uint64_t side : proto_varints(bytes, tensor::kDims))
    shape.push_back(bounded(side));
  return shape;
}

bool is_half_precision(std::string_view tensor_bytes) {
  return type_of(tensor_bytes) == tensor::kHalf;
}

std::optional<OnnxTensor> read_onnx_tensor(std::string_view bytes) {
  const std::uint64_t type = type_of(bytes);
  OnnxTensor read{.shape = onnx_tensor_shape(bytes), .is_float = true, .values = {}};
  read.is_float = type == tensor::kFloat || type == tensor::kHalf || type == tensor::kDouble;
  const auto count = value_count(read.shape);
  if (!count) return std::nullopt;
  read.values = values_of(bytes, type);
  if (read.values.size() != *count) return std::nullopt;
  if (!read.is_float)
    for (double& value : read.values) value = bounded(value);
  return read;
}

std::string write_onnx_tensor(const std::string& name, const OnnxTensor& tensor) {
  std::string bytes, raw;
  for (const std::int64_t side : tensor.shape) bytes += proto_number(tensor::kDims, side);
  const auto add = [&](auto value) {
    raw.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const double value : tensor.values)
    if (tensor.is_float)
      add(static_cast<float>(value));
    else
      add(static_cast<std::int64_t>(bounded(value)));
  const auto type = static_cast<std::int64_t>(tensor.is_float ? tensor::kFloat : tensor::kInt64);
  return bytes + proto_number(tensor::kType, type) + proto_bytes_field(tensor::kName, name) +
         proto_bytes_field(tensor::kRaw, raw);
}

std::int64_t OnnxNode::integer(std::string_view name, std::int64_t otherwise) const {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return otherwise;
  const auto values = proto_varints(found->second, attribute::kInteger);
  return values.empty() ? 0 : bounded(values.back());
}

std::optional<OnnxShape> OnnxNode::integers(std::string_view name) const {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return std::nullopt;
  OnnxShape values;
  for (const std::uint64_t v : proto_varints(found->second, attribute::kIntegers))
    values.push_back(bounded(v));
  return values;
}

std::vector<float> OnnxNode::floats(std::string_view name) const {
  std::vector<float> values;
  if (const auto found = attributes.find(name); found != attributes.end())
    for (const double v : fixed<float>(found->second, attribute::kFloats))
      values.push_back(static_cast<float>(v));
  return values;
}

std::string OnnxNode::text(std::string_view name) const {
  const auto found = attributes.find(name);
  return found == attributes.end() ? "" : text_of(found->second, attribute::kText);
}

std::optional<OnnxTensor> OnnxNode::tensor(std::string_view name) const {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return std::nullopt;
  return read_onnx_tensor(proto_bytes(found->second, attribute::kTensor));
}

void OnnxNode::set(const std::string& name, std::int64_t value) {
  attributes[name] =
      attribute_of(name, proto_number(attribute::kInteger, value), attribute::kIsInteger);
}

void OnnxNode::set(const std::string& name, const OnnxShape& values) {
  std::string bytes;
  for (const std::int64_t value : values) bytes += proto_number(attribute::kIntegers, value);
  attributes[name] = attribute_of(name, bytes, attribute::kIsIntegers);
}

void OnnxNode::set(const std::string& name, float value) {
  attributes[name] = attribute_of(name, proto_float(attribute::kFloat, value), attribute::kIsFloat);
}

std::optional<OnnxGraph> read_onnx_graph(std::string_view model) {
  OnnxGraph read;
  ProtoMessage parts(model);
  while (parts.next()) {
  }
  if (!parts.at_end()) return std::nullopt;
  read.model = model;
  for (const ProtoField& set : proto_fields(model, model::kOpset))
    if (const auto domain = proto_bytes(set.bytes, model::kOpsetDomain);
        domain.empty() || domain == "ai.onnx")
      for (const std::uint64_t version : proto_varints(set.bytes, model::kOpsetVersion))
        read.opset = static_cast<std::int64_t>(version);
  std::vector<std::string_view> inputs;
  ProtoMessage walk(proto_bytes(model, model::kGraph));
  while (const auto field = walk.next()) {
    if (field->tag == graph::kNode) read.nodes.push_back(read_node(field->bytes));
    if (field->tag == graph::kInitializer)
      read.weights[text_of(field->bytes, tensor::kName)] = field->bytes;
    if (field->tag == graph::kInput) inputs.push_back(field->bytes);
    if (field->tag == graph::kOutput)
      read.outputs.push_back(text_of(field->bytes, value_info::kName));
  }
  if (!walk.at_end()) return std::nullopt;
  for (const std::string_view info : inputs)
    if (const std::string name = text_of(info, value_info::kName); !read.weights.contains(name))
      read.inputs[name] = read_input_shape(info);
  return read;
}

std::string write_onnx_graph(const OnnxGraph& written) {
  std::string content, bytes;
  for (const OnnxNode& n : written.nodes) content += proto_bytes_field(graph::kNode, write_node(n));
  content += proto_bytes_field(graph::kName, "rewritten");
  for (const auto& [name, weights] : written.weights)
    content += proto_bytes_field(graph::kInitializer, weights);
  for (const auto& [name, values] : written.constants)
    content += proto_bytes_field(graph::kInitializer, write_onnx_tensor(name, values));
  for (const auto& [name, shape] : written.inputs)
    content += proto_bytes_field(graph::kInput, write_value(name, shape));
  for (const std::string& name : written.outputs)  // OpenCV requires a shape but ignores it
    content += proto_bytes_field(graph::kOutput, write_value(name, {}));
  ProtoMessage walk(written.model);
  while (const auto field = walk.next())
    bytes += field->tag == model::kGraph ? proto_bytes_field(model::kGraph, content) : field->whole;
  return bytes;
}

}  // namespace mh
