// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/onnx_input.hpp"

#include <cstdint>
#include <vector>

namespace mh {
namespace {

/// One field of a Protocol Buffers message: a number, or the bytes of a text or a message.
struct Field {
  std::uint64_t tag = 0, number = 0;
  std::string_view bytes;
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

int size_of(const Field& dim) {
  for (const Field& value : all(dim.bytes, kValue))
    if (value.bytes.empty() && value.number <= 8192) return static_cast<int>(value.number);
  return 0;
}

}  // namespace

std::optional<InputSize> onnx_input_size(std::string_view model) {
  for (const Field& graph : all(model, kGraph))
    for (const Field& input : all(graph.bytes, kInput))
      for (const Field& type : all(input.bytes, kType))
        for (const Field& tensor : all(type.bytes, kTensor))
          for (const Field& shape : all(tensor.bytes, kShape)) {
            const std::vector<Field> dims = all(shape.bytes, kDim);
            // Weights may be listed as inputs: an image has three channels, or leaves them open.
            if (dims.size() != 4 || (size_of(dims[1]) != 3 && size_of(dims[1]) != 0)) continue;
            return InputSize{size_of(dims[3]), size_of(dims[2])};
          }
  return std::nullopt;
}

}  // namespace mh
