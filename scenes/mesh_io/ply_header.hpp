// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mh::ply {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

/// A type's name in files: "uchar".
std::string_view name_of(Type type);

/// Size of a value, bytes.
std::size_t size_of(Type type);

/// Loads a value from memory of any alignment.
template <class T>
T load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Loads any scalar as a double, which represents it exactly.
double load_number(Type type, const char* at);

struct Property {
  std::string name;
  Type type = Type::kInt8;           ///< of the value, or of a list's items
  std::optional<Type> count_type{};  ///< set for a list
  std::size_t offset = 0;            ///< within the record; unused for lists
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  bool has_list = false;
  std::size_t stride = 0;  ///< bytes of a record; only for elements without lists

  const Property* find(std::string_view wanted) const {
    const auto found = std::ranges::find(properties, wanted, &Property::name);
    return found == properties.end() ? nullptr : &*found;
  }
};

enum class Encoding { kText, kLittleEndian, kBigEndian };

struct Header {
  std::optional<Encoding> encoding;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes up to and including the line end of end_header
};

/// Parses the header of a PLY. @param name  names the file in messages
/// @throws InputError naming the line.
Header parse_header(std::string_view bytes, const std::string& name);

/// Converts a body in another encoding to little-endian binary.
/// @throws InputError naming element and record: truncated, not a number, or too large for its
/// type.
std::string as_little_endian(std::string_view body, const Header& header, const std::string& name);

}  // namespace mh::ply
