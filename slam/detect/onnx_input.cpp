// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/onnx_input.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include <fmt/format.h>

namespace mh {
namespace {

/// One field of a Protocol Buffers message: a number, or the bytes of a text or a message.
struct Field {
  std::uint64_t tag = 0, number = 0;
  std::string_view bytes;
  bool is_number = false;
};

/// Walks the fields of a message; stops at the first that is not whole.
class Message {
 public:
  explicit Message(std::string_view bytes) : rest_(bytes) {}

  std::optional<Field> next() {
    Field field;
    const auto key = varint();
    if (!key) return std::nullopt;
    field.tag = *key >> 3;
    std::optional<std::uint64_t> size;
    switch (*key & 7) {
      case 0:
        size = varint();
        if (!size) return std::nullopt;
        field.number = *size;
        field.is_number = true;
        return field;
      case 1:
        size = 8;
        break;
      case 2:
        size = varint();
        break;
      case 5:
        size = 4;
        break;
      default:
        return std::nullopt;
    }
    if (!size || *size > rest_.size()) return std::nullopt;
    field.bytes = rest_.substr(0, *size);
    rest_.remove_prefix(*size);
    return field;
  }

 private:
  std::optional<std::uint64_t> varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(rest_.front());
      rest_.remove_prefix(1);
      value |= std::uint64_t{byte & 0x7fU} << shift;
      if (byte < 0x80) return value;
    }
    return std::nullopt;
  }

  std::string_view rest_;
};

/// The fields of a message with that tag.
std::vector<Field> all(std::string_view message, std::uint64_t tag) {
  std::vector<Field> found;
  Message walk(message);
  while (const auto field = walk.next())
    if (field->tag == tag) found.push_back(*field);
  return found;
}

// Tags of onnx.proto (ONNX 1.x): ModelProto.graph, GraphProto.input, ValueInfoProto.type,
// TypeProto.tensor_type, Tensor.shape, TensorShapeProto.dim, Dimension.dim_value.
constexpr std::uint64_t kGraph = 7, kInput = 11, kType = 2, kTensor = 1, kShape = 2, kDim = 1,
                        kValue = 1;

// GraphProto.node and .initializer, NodeProto.attribute, AttributeProto.t; TensorProto.dims,
// .data_type, .name, .raw_data, .data_location, and the typed lists of values.
constexpr std::uint64_t kNode = 1, kInitializer = 5, kAttribute = 5, kAttributeTensor = 5;
constexpr std::uint64_t kDims = 1, kDataType = 2, kFloats = 4, kInt32s = 5, kInt64s = 7, kName = 8,
                        kRaw = 9, kDoubles = 10, kUint64s = 11, kLocation = 14;
constexpr std::uint64_t kFloat = 1;  // TensorProto.DataType

/// The varints of a repeated field, packed or one by one.
std::vector<std::uint64_t> varints(std::string_view message, std::uint64_t tag) {
  std::vector<std::uint64_t> values;
  for (const Field& field : all(message, tag)) {
    if (field.is_number) values.push_back(field.number);
    std::uint64_t value = 0;
    int shift = 0;
    for (const char c : field.bytes) {
      const auto byte = static_cast<unsigned char>(c);
      if (shift < 64) value |= std::uint64_t{byte & 0x7fU} << shift;
      shift += 7;
      if (byte >= 0x80) continue;
      values.push_back(value);
      value = 0, shift = 0;
    }
  }
  return values;
}

std::size_t bytes_of(std::string_view message, std::uint64_t tag) {
  std::size_t size = 0;
  for (const Field& field : all(message, tag)) size += field.bytes.size();
  return size;
}

/// Whether the 32-bit floats of a field hold one that is not a number.
bool any_nan(std::string_view message, std::uint64_t tag) {
  for (const Field& field : all(message, tag))
    for (std::size_t at = 0; at + sizeof(float) <= field.bytes.size(); at += sizeof(float)) {
      float value = 0;
      std::memcpy(&value, field.bytes.data() + at, sizeof value);
      if (std::isnan(value)) return true;
    }
  return false;
}

/// Bytes of one value of a TensorProto.DataType; 0 = none that weights have.
std::size_t value_size(std::uint64_t type) {
  switch (type) {
    case 2:
    case 3:
    case 9:
      return 1;  // uint8, int8, bool
    case 4:
    case 5:
    case 10:
    case 16:
      return 2;  // uint16, int16, float16, bfloat16
    case 1:
    case 6:
    case 12:
      return 4;  // float, int32, uint32
    case 7:
    case 11:
    case 13:
      return 8;  // int64, double, uint64
    default:
      return 0;
  }
}

/// What is wrong with a TensorProto; "" = nothing.
std::string fault_of(std::string_view tensor) {
  std::string name = "a constant";
  for (const Field& field : all(tensor, kName)) name = fmt::format("'{}'", field.bytes);
  for (const std::uint64_t where : varints(tensor, kLocation))
    if (where == 1)
      return fmt::format("weights {} are in another file: export with them inside", name);
  double values = 1;
  for (const std::uint64_t dim : varints(tensor, kDims)) values *= static_cast<double>(dim);
  std::uint64_t type = 0;
  for (const std::uint64_t stated : varints(tensor, kDataType)) type = stated;
  const std::size_t size = value_size(type);
  if (size == 0) return "";
  const std::size_t raw = bytes_of(tensor, kRaw);
  const std::size_t held =
      raw > 0 ? raw / size
              : bytes_of(tensor, kFloats) / 4 + bytes_of(tensor, kDoubles) / 8 +
                    varints(tensor, kInt32s).size() + varints(tensor, kInt64s).size() +
                    varints(tensor, kUint64s).size();
  if (static_cast<double>(held) == values) {
    const bool nan = type == kFloat && (any_nan(tensor, kRaw) || any_nan(tensor, kFloats));
    return nan ? fmt::format("weights {} hold a value that is not a number", name) : "";
  }
  return fmt::format("weights {} hold {} values where their shape states {}", name, held, values);
}

/// 0 where a dimension is open: by a name, or by -1.
std::uint64_t size_of(const Field& dim) {
  for (const Field& value : all(dim.bytes, kValue))
    if (value.is_number && static_cast<std::int64_t>(value.number) > 0) return value.number;
  return 0;
}

}  // namespace

std::optional<OnnxInput> onnx_input(std::string_view model) {
  for (const Field& graph : all(model, kGraph))
    for (const Field& input : all(graph.bytes, kInput))
      for (const Field& type : all(input.bytes, kType))
        for (const Field& tensor : all(type.bytes, kTensor))
          for (const Field& shape : all(tensor.bytes, kShape)) {
            const std::vector<Field> dims = all(shape.bytes, kDim);
            // Weights may be listed as inputs: an image has three channels, or leaves them open.
            if (dims.size() != 4 || (size_of(dims[1]) != 3 && size_of(dims[1]) != 0)) continue;
            return OnnxInput{size_of(dims[0]), size_of(dims[3]), size_of(dims[2])};
          }
  return std::nullopt;
}

std::string onnx_weights_fault(std::string_view model) {
  for (const Field& graph : all(model, kGraph)) {
    for (const Field& weights : all(graph.bytes, kInitializer))
      if (std::string fault = fault_of(weights.bytes); !fault.empty()) return fault;
    for (const Field& node : all(graph.bytes, kNode))
      for (const Field& attribute : all(node.bytes, kAttribute))
        for (const Field& constant : all(attribute.bytes, kAttributeTensor))
          if (std::string fault = fault_of(constant.bytes); !fault.empty()) return fault;
  }
  return "";
}

}  // namespace mh
