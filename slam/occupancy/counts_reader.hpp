// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {

/// Takes numbers from the front of a byte string, little-endian.
class CountsReader {
 public:
  CountsReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}
  bool at_end() const { return bytes_.empty(); }
  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(fmt::format("{}: is damaged: {}", name_, what));
  }
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) fail("it is truncated");
    const std::string_view front = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return front;
  }
  template <class T>
  T get() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::uint16_t number() {
    unsigned value = 0;
    for (unsigned shift = 0;; shift += 7) {
      const auto byte = static_cast<unsigned char>(take(1)[0]);
      if (shift > 14) fail("a number is too long");
      value |= (byte & 127U) << shift;
      if (byte < 128) break;
    }
    if (value > UINT16_MAX) fail("a number is too large");
    return static_cast<std::uint16_t>(value);
  }

 private:
  std::string_view bytes_;
  const std::string& name_;
};

}  // namespace mh
