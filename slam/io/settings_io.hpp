// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/names.hpp"
#include "slam/io/setting.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

// Visitors of settings' field lists. A setting is an int, a double, a bool, a text, an enumeration
// E whose names words(E) returns, or an optional or a vector of one of these.

/// "[0, 1)"
inline std::string interval(const SettingRange& range) {
  return fmt::format("{}{}, {}{}", range.above ? "(" : "[", range.min, range.max,
                     range.open ? ")" : "]");
}

inline bool allows(const SettingRange& range, double value) {
  return std::isfinite(value) && value >= range.min && value <= range.max &&
         !(range.open && value == range.max) && !(range.above && value == range.min);
}

/// Reads fields from one YAML mapping; absent keys keep their values unless they are required.
class MappingReader {
 public:
  explicit MappingReader(YamlReader& mapping) : mapping_(mapping) {}

  template <class T>
  void operator()(const char* key, T& value, const SettingRange& range, const char*) {
    if (range.required)
      read(mapping_.at(key), value, range);
    else if (const auto node = mapping_.find(key))
      read(*node, value, range);
  }

  /// Reads one value. @throws InputError at its place.
  template <class T>
  static void read(const YamlReader& node, T& value, const SettingRange& range) {
    if constexpr (kIsOptional<T>) {
      read(node, value.emplace(), range);
    } else if constexpr (kIsVector<T>) {
      value.clear();
      for (const YamlReader& item : node.items()) read(item, value.emplace_back(), range);
      if (value.empty()) node.fail("is empty: at least one is needed");
    } else if constexpr (std::is_same_v<T, bool>) {
      value = node.as_bool();
    } else if constexpr (std::is_same_v<T, std::string>) {
      value = node.as_string();
    } else if constexpr (std::is_enum_v<T>) {
      value = one_of(node, words(T{}));
    } else if constexpr (std::is_integral_v<T>) {
      value = static_cast<T>(
          node.as_int(static_cast<std::int64_t>(range.min), static_cast<std::int64_t>(range.max)));
    } else {
      const double number = node.as_double();
      if (!allows(range, number))
        node.fail(fmt::format("{} is outside {}", node.as_string(), interval(range)));
      value = number;
    }
  }

 private:
  YamlReader& mapping_;
};

/// Reads sections of a YAML mapping; absent keys keep their values. Call finish() at the end.
class SettingsReader {
 public:
  explicit SettingsReader(YamlReader& yaml) : yaml_(yaml) {}

  void section(const char* name) {
    finish();
    section_ = yaml_.find(name);
  }
  /// The section that was read last; nullopt if the file lacks it.
  const std::optional<YamlReader>& place() const { return section_; }
  /// @throws InputError if the last section has a key that is not one of its fields.
  void finish() const {
    if (section_) section_->finish();
  }

  template <class T>
  void operator()(const char* key, T& value, const SettingRange& range, const char* note) {
    if (section_) MappingReader{*section_}(key, value, range, note);
  }

 private:
  YamlReader& yaml_;
  std::optional<YamlReader> section_;
};

/// Writes settings as YAML that SettingsReader reads back bit for bit; with notes, each line ends
/// in a comment stating the meaning and the allowed values.
class SettingsWriter {
 public:
  explicit SettingsWriter(bool notes = false) : notes_(notes) {}

  void section(const char* name) { text_ += fmt::format("{}:\n", name); }

  template <class T>
  void operator()(const char* key, const T& value, const SettingRange& range, const char* note) {
    const std::string line = fmt::format("  {}: {}", key, word_of(value));
    if (!notes_) {
      text_ += line + "\n";
      return;
    }
    std::string comment = note;
    if constexpr (!std::is_enum_v<T> && !std::is_same_v<T, bool>)
      comment = interval(range) + (comment.empty() ? "" : "  " + comment);
    text_ += fmt::format("{:<30} # {}\n", line, comment);
  }
  const std::string& text() const { return text_; }

  template <class T>
  static std::string word_of(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return std::string(name_of(value, words(T{})));
    } else if constexpr (kIsOptional<T>) {
      return value ? word_of(*value) : "none";
    } else if constexpr (kIsVector<T>) {
      std::string list;
      for (const auto& item : value) list += (list.empty() ? "" : ", ") + word_of(item);
      return "[" + list + "]";
    } else {
      return fmt::format("{}", value);  // doubles: the shortest text that reads back equal
    }
  }

 private:
  bool notes_;
  std::string text_;
};

/// Finds the first number that is out of range. @throws InputError naming it.
class SettingsCheck {
 public:
  /// @param what  starts the message: "slam settings"
  explicit SettingsCheck(std::string what) : what_(std::move(what)) {}

  void section(const char* name) { section_ = name; }

  template <class T>
  void operator()(const char* key, const T& value, const SettingRange& range, const char*) const {
    if constexpr (!std::is_enum_v<T>)
      if (!allows(range, static_cast<double>(value)))
        throw InputError(fmt::format("{}: {}.{} = {} is outside {}", what_, section_, key, value,
                                     interval(range)));
  }

 private:
  std::string what_, section_;
};

}  // namespace mh
