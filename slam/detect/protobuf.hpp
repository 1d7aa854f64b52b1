// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

// Protocol Buffers' wire format, as far as onnx.proto needs it.

/// One field of a message: a number, or the bytes of a text or a message.
struct ProtoField {
  std::uint64_t tag = 0, number = 0;
  std::string_view bytes;
  bool is_number = false;
  std::string_view whole;  ///< its bytes with tag and size, to be copied
};

/// Walks the fields of a message; stops at the first that is incomplete.
class ProtoMessage {
 public:
  explicit ProtoMessage(std::string_view bytes) : rest_(bytes) {}
  std::optional<ProtoField> next();
  bool at_end() const { return rest_.empty(); }

 private:
  std::optional<std::uint64_t> varint();
  std::string_view rest_;
};

/// The fields of a message with that tag.
std::vector<ProtoField> proto_fields(std::string_view message, std::uint64_t tag);

/// The bytes of the last field with that tag; "" if there is none.
std::string_view proto_bytes(std::string_view message, std::uint64_t tag);

/// The varints of a repeated field, packed or one by one.
std::vector<std::uint64_t> proto_varints(std::string_view message, std::uint64_t tag);

std::string proto_number(std::uint64_t tag, std::int64_t value);
std::string proto_bytes_field(std::uint64_t tag, std::string_view content);
std::string proto_float(std::uint64_t tag, float value);

}  // namespace mh
