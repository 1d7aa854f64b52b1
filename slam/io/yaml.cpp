// SPDX-License-Identifier: Apache-2.0
#include "slam/io/yaml.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "slam/io/suggest.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

/// "file:line"; only the file if the node has no position.
std::string place_in(const std::string& file, const YAML::Node& node) {
  const int line = node.Mark().line + 1;
  return line > 0 ? fmt::format("{}:{}", file, line) : file;
}

/// Visits every node once for each path that leads to it. Finds duplicate keys, and aliases that
/// contain themselves or lead to so many values that reading would never end.
class Walk {
 public:
  explicit Walk(const std::string& file) : file_(file) {}

  void visit(const YAML::Node& node, int depth = 0) {
    constexpr int kDeepest = 64, kMost = 500'000;
    if (depth > kDeepest || ++visited_ > kMost)
      fail(node, depth > kDeepest
                     ? fmt::format("nested deeper than {} levels, or an alias that holds itself",
                                   kDeepest)
                     : fmt::format("more than {} values, aliases counted each time", kMost));
    if (node.IsMap()) {
      std::set<std::string> seen;
      for (const auto& entry : node) {
        if (!entry.first.IsScalar()) fail(entry.first, "a key must be a plain word");
        if (!seen.insert(entry.first.Scalar()).second)
          fail(entry.first, fmt::format("key '{}' appears twice", entry.first.Scalar()));
        visit(entry.second, depth + 1);
      }
    } else if (node.IsSequence()) {
      for (const auto& item : node) visit(item, depth + 1);
    }
  }

 private:
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
    throw InputError(fmt::format("{}: {}", place_in(file_, node), what));
  }

  const std::string& file_;
  int visited_ = 0;
};

}  // namespace

YamlReader::YamlReader(const YAML::Node& node, std::string file, std::string place)
    : node_(std::make_shared<YAML::Node>(node)), file_(std::move(file)), place_(std::move(place)) {}

YamlReader YamlReader::load(const std::filesystem::path& file) {
  return parse(read_text(file), file.string());
}

YamlReader YamlReader::parse(const std::string& text, const std::string& name) {
  constexpr std::size_t kMostBytes = 4 << 20;  // yaml-cpp takes a second for each megabyte
  if (text.size() > kMostBytes)
    throw InputError(fmt::format("{}: has {} bytes: YAML files may have at most {}", name,
                                 text.size(), kMostBytes));
  try {
    YAML::Node node = YAML::Load(text);
    Walk(name).visit(node);
    return {node, name, ""};
  } catch (const YAML::Exception& e) {
    const bool braces = text.find("${") != std::string::npos;
    throw InputError(fmt::format("{}:{}: is not valid YAML: {}{}", name, e.mark.line + 1, e.msg,
                                 braces ? "; within { } or [ ], ${...} must be quoted" : ""));
  }
}

namespace {

/// Text with each ${name} replaced.
std::string replaced(const std::string& text,
                     const std::function<std::string(const std::string&)>& value_of) {
  std::string result;
  std::size_t from = 0;
  for (std::size_t at = text.find("${"); at != std::string::npos; at = text.find("${", from)) {
    const std::size_t end = text.find('}', at);
    if (end == std::string::npos) break;
    result += text.substr(from, at - from) + value_of(text.substr(at + 2, end - at - 2));
    from = end + 1;
  }
  return result + text.substr(from);
}

/// Replaces each ${name} in every word below a node, in place.
void replace_words(YAML::Node node, const std::string& file,
                   const std::function<std::string(const std::string&)>& value_of) {
  if (node.IsScalar() && node.Scalar().find("${") != std::string::npos) {
    try {
      node = replaced(node.Scalar(), value_of);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", place_in(file, node), error.what()));
    }
  } else if (node.IsSequence()) {
    for (YAML::Node item : node) replace_words(item, file, value_of);
  } else if (node.IsMap()) {
    for (auto entry : node) replace_words(entry.second, file, value_of);
  }
}

}  // namespace

YamlReader YamlReader::parse(const std::string& text, const std::string& name,
                             const std::function<std::string(const std::string&)>& value_of) {
  const YamlReader reader = parse(text, name);
  replace_words(*reader.node_, name, value_of);
  return reader;
}

bool YamlReader::is_scalar() const {
  return node_->IsScalar();
}

bool YamlReader::is_sequence() const {
  return node_->IsSequence();
}

bool YamlReader::is_map() const {
  return node_->IsMap();
}

int YamlReader::line() const {
  return node_->Mark().line + 1;
}

void YamlReader::fail(const std::string& what) const {
  const std::string where = place_.empty() ? "" : place_ + ": ";
  if (place_.empty() && node_->IsNull()) throw InputError(file_ + ": the file is empty");
  throw InputError(fmt::format("{}: {}{}", place_in(file_, *node_), where, what));
}

bool YamlReader::has(const std::string& key) const {
  return node_->IsMap() && (*node_)[key].IsDefined();
}

std::optional<YamlReader> YamlReader::find(const std::string& key) {
  if (!node_->IsMap()) fail("must be a mapping");
  read_.insert(key);
  const YAML::Node child = (*node_)[key];
  if (!child.IsDefined()) return std::nullopt;
  return YamlReader{child, file_, place_.empty() ? key : place_ + "." + key};
}

YamlReader YamlReader::at(const std::string& key) {
  if (auto child = find(key)) return *child;
  std::vector<std::string> others;
  for (const auto& entry : *node_)
    if (!read_.contains(entry.first.Scalar())) others.push_back(entry.first.Scalar());
  const auto slip = nearest_word(key, others);
  fail(fmt::format("key '{}' is missing{}", key,
                   slip ? fmt::format("; is '{}' a typo for it?", *slip) : ""));
}

std::vector<YamlReader> YamlReader::items() const {
  if (!node_->IsSequence()) fail("must be a list");
  std::vector<YamlReader> result;
  for (std::size_t i = 0; i < node_->size(); ++i)
    result.push_back(YamlReader{(*node_)[i], file_, fmt::format("{}[{}]", place_, i)});
  return result;
}

std::vector<std::pair<std::string, YamlReader>> YamlReader::entries() {
  if (!node_->IsMap()) fail("must be a mapping");
  std::vector<std::pair<std::string, YamlReader>> result;
  for (const auto& entry : *node_) {
    const std::string& key = entry.first.Scalar();
    read_.insert(key);
    result.emplace_back(key,
                        YamlReader{entry.second, file_, place_.empty() ? key : place_ + "." + key});
  }
  return result;
}

std::string YamlReader::as_string() const {
  if (!node_->IsScalar()) fail("must be a word");
  return node_->Scalar();
}

bool YamlReader::as_bool() const {
  if (!node_->IsScalar()) fail("must be true or false");
  try {
    return node_->as<bool>();
  } catch (const YAML::Exception&) {
    fail(fmt::format("'{}' is not true or false", node_->Scalar()));
  }
}

double YamlReader::as_double(double min, double max) const {
  if (!node_->IsScalar()) fail("must be a number");
  double value = 0;
  try {
    value = node_->as<double>();
  } catch (const YAML::Exception&) {
    fail(fmt::format("'{}' is not a number", node_->Scalar()));
  }
  if (!std::isfinite(value)) fail(fmt::format("'{}' is not a finite number", node_->Scalar()));
  if (value < min || value > max)
    fail(fmt::format("{} is outside [{}, {}]", node_->Scalar(), min, max));
  return value;
}

std::int64_t YamlReader::as_int(std::int64_t min, std::int64_t max) const {
  if (!node_->IsScalar()) fail("must be a whole number");
  std::int64_t value = 0;
  try {
    value = node_->as<std::int64_t>();
  } catch (const YAML::Exception&) {
    const std::string& text = node_->Scalar();
    const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    if (digits) fail(fmt::format("{} is outside [{}, {}]", text, min, max));
    fail(fmt::format("'{}' is not an integer", text));
  }
  if (value < min || value > max) fail(fmt::format("{} is outside [{}, {}]", value, min, max));
  return value;
}

std::vector<double> YamlReader::as_numbers(std::size_t n) const {
  std::vector<double> numbers;
  for (const YamlReader& item : items()) numbers.push_back(item.as_double());
  if (n != 0 && numbers.size() != n)
    fail(fmt::format("has {} numbers, {} are needed", numbers.size(), n));
  return numbers;
}

std::string YamlReader::string(const std::string& key, const std::string& fallback) {
  const auto child = find(key);
  return child ? child->as_string() : fallback;
}

bool YamlReader::boolean(const std::string& key, bool fallback) {
  const auto child = find(key);
  return child ? child->as_bool() : fallback;
}

double YamlReader::number_or(const std::string& key, double fallback, double min, double max) {
  const auto child = find(key);
  return child ? child->as_double(min, max) : fallback;
}

std::int64_t YamlReader::integer_or(const std::string& key, std::int64_t fallback, std::int64_t min,
                                    std::int64_t max) {
  const auto child = find(key);
  return child ? child->as_int(min, max) : fallback;
}

void YamlReader::finish() const {
  for (const auto& entry : *node_) {
    const std::string& key = entry.first.Scalar();
    if (read_.contains(key)) continue;
    throw InputError(fmt::format("{}:{}: unknown key '{}{}' (known here: {}){}", file_,
                                 entry.first.Mark().line + 1, place_.empty() ? "" : place_ + ".",
                                 key, fmt::join(read_, ", "), did_you_mean(key, words_of(read_))));
  }
}

}  // namespace mh
