// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "slam/io/error.hpp"

namespace YAML {
class Node;  // declared here so that including files do not need yaml-cpp
}

namespace mh {

/// A strict view of one YAML mapping or value. Every error is an InputError of the form "file:line:
/// place: what is wrong with which value". Keys that were never read are errors too: call finish()
/// after reading a mapping.
class YamlReader {
 public:
  /// Parses a file. @throws InputError if it is missing or not YAML.
  static YamlReader load(const std::filesystem::path& file);
  /// Parses text; `name` names the file in messages.
  static YamlReader parse(const std::string& text, const std::string& name);
  /// The same, with `${name}` in each of its words replaced by value_of(name).
  /// @param value_of  may throw InputError, which is then reported with the place
  static YamlReader parse(const std::string& text, const std::string& name,
                          const std::function<std::string(const std::string&)>& value_of);

  bool has(const std::string& key) const;
  /// The child under a key. @throws InputError if absent.
  YamlReader at(const std::string& key);
  /// The child under a key, nullopt if absent.
  std::optional<YamlReader> find(const std::string& key);
  /// The elements of this sequence. @throws InputError if it is not one.
  std::vector<YamlReader> items() const;
  /// The entries of this mapping in file order, all marked as read. @throws InputError if it is not
  /// a mapping.
  std::vector<std::pair<std::string, YamlReader>> entries();

  bool is_scalar() const;
  bool is_sequence() const;
  bool is_map() const;

  /// This scalar's value. @throws InputError on the wrong type.
  std::string as_string() const;
  bool as_bool() const;
  double as_double(double min = -kInf, double max = kInf) const;  ///< finite, within [min, max]
  std::int64_t as_int(std::int64_t min, std::int64_t max) const;
  /// A sequence of exactly n numbers (n = 0: any count).
  std::vector<double> as_numbers(std::size_t n = 0) const;

  std::string string(const std::string& key) { return at(key).as_string(); }
  std::string string(const std::string& key, const std::string& fallback);
  bool boolean(const std::string& key, bool fallback);
  double number(const std::string& key, double min = -kInf, double max = kInf) {
    return at(key).as_double(min, max);
  }
  double number_or(const std::string& key, double fallback, double min = -kInf, double max = kInf);
  std::int64_t integer(const std::string& key, std::int64_t min, std::int64_t max) {
    return at(key).as_int(min, max);
  }
  std::int64_t integer_or(const std::string& key, std::int64_t fallback, std::int64_t min,
                          std::int64_t max);

  /// @throws InputError if this mapping has a key that was never read.
  void finish() const;
  /// Throws an InputError at this place.
  [[noreturn]] void fail(const std::string& what) const;

  const std::string& file() const { return file_; }
  int line() const;  ///< 1-based

 private:
  static constexpr double kInf = std::numeric_limits<double>::infinity();
  YamlReader(const YAML::Node& node, std::string file, std::string place);

  std::shared_ptr<const YAML::Node> node_;
  std::string file_;
  std::string place_;
  std::set<std::string> read_;
};

}  // namespace mh
