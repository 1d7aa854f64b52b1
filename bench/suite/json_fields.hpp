// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/digest.hpp"
#include "slam/core/se3.hpp"
#include "slam/io/error.hpp"
#include "slam/io/fields.hpp"
#include "slam/io/setting.hpp"
#include "slam/io/words.hpp"

// Records as JSON, via their lists of fields (slam/io/fields.hpp). Values that are unknown or not
// finite become null; a digest becomes 16 hexadecimal digits; a pose becomes [x, y, z, qx, qy, qz,
// qw]; an enumerator becomes its word in words(value).

namespace mh {

template <class T>
inline constexpr bool kIsDigest = false;
template <class T>
inline constexpr bool kIsDigest<Digest<T>> = true;

/// JSON key of a field in a list of fields: its name, or the name of its metric
/// (bench/protocol/metrics).
inline std::string key_of(const char* name) {
  return name;
}
template <class Metric>
std::string key_of(const Metric& metric) {
  return metric.name;
}

template <class T>
nlohmann::ordered_json json_of(const T& value) {
  using Node = nlohmann::ordered_json;
  if constexpr (std::is_same_v<T, double>) {
    return std::isfinite(value) ? Node(value) : Node();
  } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    return value;
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    return value.string();
  } else if constexpr (kIsOptional<T>) {
    return value ? json_of(*value) : Node();
  } else if constexpr (kIsShared<T>) {
    return json_of(*value);
  } else if constexpr (kIsVector<T> || kIsArray<T>) {
    Node list = Node::array();
    for (const auto& element : value) list.push_back(json_of(element));
    return list;
  } else if constexpr (std::is_enum_v<T>) {
    return name_of(value, words(value));
  } else if constexpr (kIsDigest<T>) {
    return hex(value.value);
  } else if constexpr (std::is_same_v<T, SE3>) {
    return value.numbers();
  } else if constexpr (kAsList<T>) {
    Node list = Node::array();
    for_each_field(value, [&](const char*, const auto& field) { list.push_back(json_of(field)); });
    return list;
  } else {
    Node object = Node::object();
    for_each_field(
        value, [&](const auto& name, const auto& field) { object[key_of(name)] = json_of(field); });
    return object;
  }
}

/// Reads back what json_of() wrote. @throws nlohmann::json::exception, InputError if it is
/// something else.
template <class T>
void read_json(const nlohmann::ordered_json& json, T&& value) {
  using Value = std::decay_t<T>;
  if constexpr (std::is_same_v<Value, double>) {
    value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
    value = json.get<Value>();
  } else if constexpr (std::is_same_v<Value, std::filesystem::path>) {
    value = json.get<std::string>();
  } else if constexpr (kIsOptional<Value>) {
    value.reset();
    if (!json.is_null()) read_json(json, value.emplace());
  } else if constexpr (kIsShared<Value>) {
    auto whole = *value;
    read_json(json, whole);
    value = whole;
  } else if constexpr (kIsVector<Value>) {
    value.clear();
    for (const auto& element : json) read_json(element, value.emplace_back());
  } else if constexpr (kIsArray<Value>) {
    for (std::size_t m = 0; m < value.size(); ++m) read_json(json.at(m), value[m]);
  } else if constexpr (std::is_enum_v<Value>) {
    const auto word = json.get<std::string>();
    const auto known = value_of(word, words(Value{}));
    if (!known) throw InputError(fmt::format("'{}' is not a known word", word));
    value = *known;
  } else if constexpr (kIsDigest<Value>) {
    value.value = std::strtoull(json.get<std::string>().c_str(), nullptr, 16);
  } else if constexpr (std::is_same_v<Value, SE3>) {
    const auto v = [&](std::size_t i) { return json.at(i).get<double>(); };
    value = SE3(Eigen::Quaterniond(v(6), v(3), v(4), v(5)), Eigen::Vector3d(v(0), v(1), v(2)));
  } else if constexpr (kAsList<Value>) {
    std::size_t i = 0;
    for_each_field(value, [&](const char*, auto& field) { read_json(json.at(i++), field); });
  } else {
    for_each_field(
        value, [&](const auto& name, auto&& field) { read_json(json.at(key_of(name)), field); });
  }
}

}  // namespace mh
