// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/recordings/messages/types.hpp"
#include "scenes/recordings/messages/wire.hpp"

namespace mh::ros {

/// Collects the text of a message's definition in the language of .msg files, with the definitions
/// of the messages that it contains.
class Definer {
 public:
  explicit Definer(Wire wire) : wire_(wire) {}

  template <class T>
  void operator()(const char* name, const T& field) {
    text_ += fmt::format("{} {}\n", type_of(field), name);
  }
  void operator()(const char* ros1_name, const char* ros2_name, const auto& field) {
    (*this)(wire_ == Wire::kRos1 ? ros1_name : ros2_name, field);
  }
  void ros1(const char* name, const auto& field) {
    if (wire_ == Wire::kRos1) (*this)(name, field);
  }
  void ros2(const char* name, const auto& field) {
    if (wire_ == Wire::kCdr) (*this)(name, field);
  }
  template <class T>
  void constant(const char* name, T value) {
    text_ += fmt::format("{} {}={}\n", type_of(value), name, value);
  }

  /// The definition, followed by those of the messages that it contains, each once.
  std::string text() const {
    std::string all = text_;
    for (const auto& [type, part] : parts_)
      all += fmt::format("{}\nMSG: {}\n{}", std::string(80, '='), type, part);
    return all;
  }

 private:
  static std::string type_of(bool) { return "bool"; }
  static std::string type_of(std::int8_t) { return "int8"; }
  static std::string type_of(std::uint8_t) { return "uint8"; }
  static std::string type_of(std::int32_t) { return "int32"; }
  static std::string type_of(std::uint32_t) { return "uint32"; }
  static std::string type_of(std::int64_t) { return "int64"; }
  static std::string type_of(float) { return "float32"; }
  static std::string type_of(double) { return "float64"; }
  static std::string type_of(const std::string&) { return "string"; }
  static std::string type_of(Bytes) { return "uint8[]"; }
  std::string type_of(const Time&) {
    if (wire_ == Wire::kRos1) return "time";
    add("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
    return "builtin_interfaces/Time";
  }
  std::string type_of(const Duration&) {
    if (wire_ == Wire::kRos1) return "duration";
    add("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n");
    return "builtin_interfaces/Duration";
  }
  template <class T>
  std::string type_of(const std::vector<T>&) {
    return type_of(T{}) + "[]";
  }
  template <class T, std::size_t N>
  std::string type_of(const std::array<T, N>&) {
    return fmt::format("{}[{}]", type_of(T{}), N);
  }
  template <class M>
  requires requires { M::kType; }
  std::string type_of(const M& message) {
    Definer inner(wire_);
    M::fields(message, inner);
    add(M::kType, inner.text_);
    for (const auto& [type, part] : inner.parts_) add(type, part);
    return M::kType;
  }
  void add(const std::string& type, const std::string& text) {
    if (std::ranges::find(parts_, type, &Part::first) == parts_.end())
      parts_.emplace_back(type, text);
  }

  using Part = std::pair<std::string, std::string>;
  Wire wire_;
  std::string text_;
  std::vector<Part> parts_;
};

/// The text of a message's definition, as stored in bags and MCAP files.
template <class M>
std::string definition(Wire wire) {
  Definer definer(wire);
  const M message;
  M::fields(message, definer);
  return definer.text();
}

/// "sensor_msgs/Image" in ROS 1, "sensor_msgs/msg/Image" in ROS 2.
inline std::string type_name(const std::string& type, Wire wire) {
  if (wire == Wire::kRos1) return type;
  const std::size_t slash = type.find('/');
  return type.substr(0, slash) + "/msg" + type.substr(slash);
}

}  // namespace mh::ros
