// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/protobuf.hpp"

namespace mh {
namespace {

std::string varint_bytes(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
  return bytes + static_cast<char>(value);
}

}  // namespace

std::optional<ProtoField> ProtoMessage::next() {
  const std::string_view before = rest_;
  ProtoField field;
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
      field.whole = before.substr(0, before.size() - rest_.size());
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
  field.whole = before.substr(0, before.size() - rest_.size());
  return field;
}

std::optional<std::uint64_t> ProtoMessage::varint() {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    value |= std::uint64_t{byte & 0x7fU} << shift;
    if (byte < 0x80) return value;
  }
  return std::nullopt;
}

std::vector<ProtoField> proto_fields(std::string_view message, std::uint64_t tag) {
  std::vector<ProtoField> found;
  ProtoMessage walk(message);
  while (const auto field = walk.next())
    if (field->tag == tag) found.push_back(*field);
  return found;
}

std::string_view proto_bytes(std::string_view message, std::uint64_t tag) {
  const std::vector<ProtoField> found = proto_fields(message, tag);
  return found.empty() ? std::string_view() : found.back().bytes;
}

std::vector<std::uint64_t> proto_varints(std::string_view message, std::uint64_t tag) {
  std::vector<std::uint64_t> values;
  for (const ProtoField& field : proto_fields(message, tag)) {
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

std::string proto_number(std::uint64_t tag, std::int64_t value) {
  return varint_bytes(tag << 3) + varint_bytes(static_cast<std::uint64_t>(value));
}

std::string proto_bytes_field(std::uint64_t tag, std::string_view content) {
  return varint_bytes(tag << 3 | 2) + varint_bytes(content.size()) + std::string(content);
}

std::string proto_float(std::uint64_t tag, float value) {
  return varint_bytes(tag << 3 | 5) +
         std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace mh
