// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "scenes/recordings/messages/types.hpp"
#include "slam/io/error.hpp"

namespace mh::ros {

/// How messages are serialized: packed, as in ROS 1, or in the Common Data Representation (CDR,
/// version 1), as in ROS 2, where numbers are aligned to their size.
enum class Wire : std::uint8_t { kRos1, kCdr };

static_assert(std::endian::native == std::endian::little);

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

template <class T>
concept Number = std::is_arithmetic_v<T>;

/// Appends a message's fields to a string of bytes.
class Serializer {
 public:
  Serializer(std::string& out, Wire wire) : out_(out), wire_(wire) {
    if (wire == Wire::kCdr) out_.append("\0\1\0\0", 4);  // little-endian
    origin_ = out_.size();
  }

  void operator()(const char*, const auto& field) { put(field); }
  void operator()(const char*, const char*, const auto& field) { put(field); }
  void ros1(const char*, const auto& field) {
    if (wire_ == Wire::kRos1) put(field);
  }
  void ros2(const char*, const auto& field) {
    if (wire_ == Wire::kCdr) put(field);
  }
  void constant(const char*, auto) {}

 private:
  template <Number T>
  void put(T value) {
    if (wire_ == Wire::kCdr) out_.append(-(out_.size() - origin_) % sizeof(T), '\0');
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out_.append(bytes, sizeof(T));
  }
  void put(const std::string& text) {
    const std::size_t zero = wire_ == Wire::kCdr ? 1 : 0;
    put(static_cast<std::uint32_t>(text.size() + zero));
    out_.append(text).append(zero, '\0');
  }
  void put(Bytes bytes) {
    put(static_cast<std::uint32_t>(bytes.size()));
    out_.append(bytes);
  }
  void put(const Time& time) {
    put(static_cast<std::uint32_t>(time.ns / kSecond_ns));
    put(static_cast<std::uint32_t>(time.ns % kSecond_ns));
  }
  void put(const Duration& time) { put(Time{time.ns}); }  // never negative
  template <class T>
  void put(const std::vector<T>& list) {
    put(static_cast<std::uint32_t>(list.size()));
    for (const T& element : list) put(element);
  }
  template <class T, std::size_t N>
  void put(const std::array<T, N>& list) {
    for (const T& element : list) put(element);
  }
  template <class M>
  requires requires { M::kType; }
  void put(const M& message) { M::fields(message, *this); }

  std::string& out_;
  Wire wire_;
  std::size_t origin_ = 0;  ///< what CDR counts positions from
};

template <class M>
std::string serialized(const M& message, Wire wire) {
  std::string bytes;
  if constexpr (requires { message.data.size(); })
    bytes.reserve(message.data.size() * sizeof(*message.data.data()) + 256);
  Serializer to(bytes, wire);
  M::fields(message, to);
  return bytes;
}

/// Reads a message's fields from bytes.
class Parser {
 public:
  /// @throws InputError if the bytes do not begin with the representation CDR 1.
  Parser(std::string_view bytes, Wire wire) : all_(bytes), wire_(wire) {
    if (wire == Wire::kRos1) return;
    if (bytes.size() < 4) fail();
    if (bytes[0] != 0 || (bytes[1] != 0 && bytes[1] != 1))
      throw InputError("is not in CDR, version 1");
    swap_ = bytes[1] == 0;
    all_.remove_prefix(4);
  }

  void operator()(const char*, auto& field) { get(field); }
  void operator()(const char*, const char*, auto& field) { get(field); }
  void ros1(const char*, auto& field) {
    if (wire_ == Wire::kRos1) get(field);
  }
  void ros2(const char*, auto& field) {
    if (wire_ == Wire::kCdr) get(field);
  }
  void constant(const char*, auto) {}

 private:
  [[noreturn]] static void fail() { throw InputError("is shorter than its type"); }

  std::string_view take(std::size_t size) {
    if (size > all_.size() - at_) fail();
    at_ += size;
    return all_.substr(at_ - size, size);
  }
  template <Number T>
  void get(T& value) {
    if (wire_ == Wire::kCdr) take(-at_ % sizeof(T));
    char bytes[sizeof(T)];
    std::memcpy(bytes, take(sizeof(T)).data(), sizeof(T));
    if (swap_) std::reverse(bytes, bytes + sizeof(T));
    if constexpr (std::is_same_v<T, bool>)
      value = bytes[0] != 0;
    else
      std::memcpy(&value, bytes, sizeof(T));
  }
  std::uint32_t length() {
    std::uint32_t count = 0;
    get(count);
    if (count > all_.size() - at_) fail();  // an element has at least one byte
    return count;
  }
  void get(std::string& text) {
    text = take(length());
    if (wire_ == Wire::kCdr && !text.empty()) text.pop_back();  // its final zero
  }
  void get(Bytes& bytes) { bytes = take(length()); }
  void get(Time& time) {
    std::int32_t seconds = 0;  // unsigned in ROS 1, which makes no difference until 2038
    std::uint32_t rest_ns = 0;
    get(seconds);
    get(rest_ns);
    time.ns = wire_ == Wire::kRos1 ? kSecond_ns * static_cast<std::uint32_t>(seconds)
                                   : kSecond_ns * seconds;
    time.ns += rest_ns;
  }
  void get(Duration& time) {
    std::int32_t seconds = 0, rest_ns = 0;
    get(seconds);
    get(rest_ns);
    time.ns = kSecond_ns * seconds + rest_ns;
  }
  template <class T>
  void get(std::vector<T>& list) {
    list.clear();
    for (std::uint32_t left = length(); left > 0; --left) get(list.emplace_back());
  }
  template <class T, std::size_t N>
  void get(std::array<T, N>& list) {
    for (T& element : list) get(element);
  }
  template <class M>
  requires requires { M::kType; }
  void get(M& message) { M::fields(message, *this); }

  std::string_view all_;
  Wire wire_;
  std::size_t at_ = 0;
  bool swap_ = false;  ///< numbers are big-endian
};

/// @returns the message; its Bytes are views of `bytes`
/// @throws InputError "is ..." if the bytes do not hold such a message.
template <class M>
M parsed(std::string_view bytes, Wire wire) {
  M message;
  Parser from(bytes, wire);
  M::fields(message, from);
  return message;
}

}  // namespace mh::ros
