// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "slam/io/error.hpp"

namespace mh {

static_assert(std::endian::native == std::endian::little);

/// Takes little-endian numbers and texts from the front of a sequence of bytes.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  bool done() const { return rest_.empty(); }
  std::size_t left() const { return rest_.size(); }
  std::string_view rest() const { return rest_; }

  /// @throws InputError "ends too early"
  std::string_view take(std::uint64_t size) {
    if (size > rest_.size()) throw InputError("ends too early");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }
  template <class T>
  requires std::is_integral_v<T> T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  /// Takes bytes that are preceded by their count as u32.
  std::string_view text() { return take(number<std::uint32_t>()); }

 private:
  std::string_view rest_;
};

/// Appends little-endian numbers and texts, as ByteReader takes them.
class ByteWriter {
 public:
  template <class T>
  requires std::is_integral_v<T>
  void number(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    bytes_.append(bytes, sizeof(T));
  }
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    bytes_.append(text);
  }
  void raw(std::string_view bytes) { bytes_.append(bytes); }
  std::size_t size() const { return bytes_.size(); }
  const std::string& bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }

 private:
  std::string bytes_;
};

}  // namespace mh
