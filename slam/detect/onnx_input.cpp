// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/onnx_input.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "slam/detect/protobuf.hpp"

namespace mh {
namespace {

// Tags of onnx.proto (ONNX 1.x): ModelProto.graph, GraphProto.input, ValueInfoProto.type,
// TypeProto.tensor_type, Tensor.shape, TensorShapeProto.dim, Dimension.dim_value.
constexpr std::uint64_t kGraph = 7, kInput = 11, kType = 2, kTensor = 1, kShape = 2, kDim = 1,
                        kValue = 1;

// ModelProto.metadata_props, StringStringEntryProto.key, .value.
constexpr std::uint64_t kMetadata = 14, kMetadataKey = 1, kMetadataValue = 2;

// GraphProto.node and .initializer, NodeProto.attribute, AttributeProto.t; TensorProto.dims,
// .data_type, .name, .raw_data, .data_location, and the typed lists of values.
constexpr std::uint64_t kNode = 1, kInitializer = 5, kAttribute = 5, kAttributeTensor = 5;
constexpr std::uint64_t kDims = 1, kDataType = 2, kFloats = 4, kInt32s = 5, kInt64s = 7, kName = 8,
                        kRaw = 9, kDoubles = 10, kUint64s = 11, kLocation = 14;
constexpr std::uint64_t kFloat = 1;  // TensorProto.DataType

std::size_t bytes_of(std::string_view message, std::uint64_t tag) {
  std::size_t size = 0;
  for (const ProtoField& field : proto_fields(message, tag)) size += field.bytes.size();
  return size;
}

/// Whether any of a field's 32-bit floats is NaN.
bool any_nan(std::string_view message, std::uint64_t tag) {
  for (const ProtoField& field : proto_fields(message, tag))
    for (std::size_t at = 0; at + sizeof(float) <= field.bytes.size(); at += sizeof(float)) {
      float value = 0;
      std::memcpy(&value, field.bytes.data() + at, sizeof value);
      if (std::isnan(value)) return true;
    }
  return false;
}

/// Bytes of one value of a TensorProto.DataType; 0 = not a type of weights.
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

/// What is wrong with a TensorProto; empty if nothing is.
std::string fault_of(std::string_view tensor) {
  std::string name = "a constant";
  for (const ProtoField& field : proto_fields(tensor, kName))
    name = fmt::format("'{}'", field.bytes);
  for (const std::uint64_t where : proto_varints(tensor, kLocation))
    if (where == 1)
      return fmt::format("weights {} are in another file: export with them inside", name);
  double values = 1;
  for (const std::uint64_t dim : proto_varints(tensor, kDims)) values *= static_cast<double>(dim);
  std::uint64_t type = 0;
  for (const std::uint64_t stated : proto_varints(tensor, kDataType)) type = stated;
  const std::size_t size = value_size(type);
  if (size == 0) return "";
  const std::size_t raw = bytes_of(tensor, kRaw);
  const std::size_t held =
      raw > 0 ? raw / size
              : bytes_of(tensor, kFloats) / 4 + bytes_of(tensor, kDoubles) / 8 +
                    proto_varints(tensor, kInt32s).size() + proto_varints(tensor, kInt64s).size() +
                    proto_varints(tensor, kUint64s).size();
  if (static_cast<double>(held) == values) {
    const bool nan = type == kFloat && (any_nan(tensor, kRaw) || any_nan(tensor, kFloats));
    return nan ? fmt::format("weights {} hold a value that is not a number", name) : "";
  }
  return fmt::format("weights {} hold {} values, but their shape needs {}", name, held, values);
}

/// The size of a dimension; 0 if it is dynamic, that is, named or -1.
std::uint64_t size_of(const ProtoField& dim) {
  for (const ProtoField& value : proto_fields(dim.bytes, kValue))
    if (value.is_number && static_cast<std::int64_t>(value.number) > 0) return value.number;
  return 0;
}

}  // namespace

std::optional<OnnxInput> onnx_input(std::string_view model) {
  for (const ProtoField& graph : proto_fields(model, kGraph))
    for (const ProtoField& input : proto_fields(graph.bytes, kInput))
      for (const ProtoField& type : proto_fields(input.bytes, kType))
        for (const ProtoField& tensor : proto_fields(type.bytes, kTensor))
          for (const ProtoField& shape : proto_fields(tensor.bytes, kShape)) {
            const std::vector<ProtoField> dims = proto_fields(shape.bytes, kDim);
            // Weights may be listed as inputs, too. An image has three channels, or their number is
            // left open.
            if (dims.size() != 4 || (size_of(dims[1]) != 3 && size_of(dims[1]) != 0)) continue;
            return OnnxInput{size_of(dims[0]), size_of(dims[3]), size_of(dims[2])};
          }
  return std::nullopt;
}

std::string onnx_weights_fault(std::string_view model) {
  for (const ProtoField& graph : proto_fields(model, kGraph)) {
    for (const ProtoField& weights : proto_fields(graph.bytes, kInitializer))
      if (std::string fault = fault_of(weights.bytes); !fault.empty()) return fault;
    for (const ProtoField& node : proto_fields(graph.bytes, kNode))
      for (const ProtoField& attribute : proto_fields(node.bytes, kAttribute))
        for (const ProtoField& constant : proto_fields(attribute.bytes, kAttributeTensor))
          if (std::string fault = fault_of(constant.bytes); !fault.empty()) return fault;
  }
  return "";
}

std::map<std::string, std::string> onnx_metadata(std::string_view model) {
  std::map<std::string, std::string> metadata;
  for (const ProtoField& entry : proto_fields(model, kMetadata))
    metadata[std::string(proto_bytes(entry.bytes, kMetadataKey))] =
        proto_bytes(entry.bytes, kMetadataValue);
  return metadata;
}

}  // namespace mh
