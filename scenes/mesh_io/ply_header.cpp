// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/ply_header.hpp"

#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh::ply {

namespace {

/// The first name of each type is the one in the PLY format's original definition.
constexpr std::pair<std::string_view, Type> kNames[] = {
    {"char", Type::kInt8},     {"int8", Type::kInt8},     {"uchar", Type::kUint8},
    {"uint8", Type::kUint8},   {"short", Type::kInt16},   {"int16", Type::kInt16},
    {"ushort", Type::kUint16}, {"uint16", Type::kUint16}, {"int", Type::kInt32},
    {"int32", Type::kInt32},   {"uint", Type::kUint32},   {"uint32", Type::kUint32},
    {"float", Type::kFloat},   {"float32", Type::kFloat}, {"double", Type::kDouble},
    {"float64", Type::kDouble}};

std::optional<Type> type_by_name(std::string_view name) {
  for (const auto& [known, type] : kNames)
    if (known == name) return type;
  return std::nullopt;
}

/// Splits a header line at whitespace.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while ((at = line.find_first_not_of(" \t\r", at)) != line.npos) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Header parse() {
    if (!bytes_.starts_with("ply\n") && !bytes_.starts_with("ply\r\n"))
      throw InputError(fmt::format("{}:1: is not a PLY: the first line must be 'ply'", name_));
    next_line();
    for (;;) {
      const auto words = words_of(next_line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() == 3)
        header_.encoding = encoding_of(words[1], words[2]);
      else if (words[0] == "element" && words.size() == 3)
        add_element(words);
      else if (words[0] == "property")
        add_property(words);
      else
        fail(fmt::format("'{}' is not a line of a PLY header", words[0].substr(0, 40)));
    }
    if (!header_.encoding) fail("the header names no format");
    header_.size = at_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_, what));
  }

  Encoding encoding_of(std::string_view word, std::string_view version) const {
    if (version == "1.0") {
      if (word == "ascii") return Encoding::kText;
      if (word == "binary_little_endian") return Encoding::kLittleEndian;
      if (word == "binary_big_endian") return Encoding::kBigEndian;
    }
    fail(fmt::format("'{} {}' is not a format", word.substr(0, 40), version.substr(0, 40)));
  }

  std::string_view next_line() {
    const std::size_t end = bytes_.find('\n', at_);
    ++line_;
    if (end == bytes_.npos || end - at_ > 4096) fail("the header has no end_header");
    const std::string_view line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return line;
  }

  void add_element(const std::vector<std::string_view>& words) {
    Element element{.name = std::string(words[1]), .count = 0, .properties = {}};
    const char* end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc() || stop != end)
      fail(fmt::format("'{}' is not a number of elements", words[2].substr(0, 40)));
    header_.elements.push_back(std::move(element));
  }

  Type type_of(std::string_view word) const {
    const auto type = type_by_name(word);
    if (!type) fail(fmt::format("'{}' is not a type", word.substr(0, 40)));
    return *type;
  }

  void add_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before the first element");
    Element& element = header_.elements.back();
    if (words.size() == 5 && words[1] == "list") {
      const Type count_type = type_of(words[2]);
      if (count_type == Type::kFloat || count_type == Type::kDouble)
        fail("a list's count must be of an integer type");
      element.has_list = true;
      element.properties.push_back({std::string(words[4]), type_of(words[3]), count_type});
    } else if (words.size() == 3) {
      const Type type = type_of(words[1]);
      element.properties.push_back({std::string(words[2]), type, {}, element.stride});
      element.stride += size_of(type);
    } else {
      fail("a property needs a type and a name");
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  Header header_;
  std::size_t at_ = 0;
  int line_ = 0;
};

}  // namespace

std::string_view name_of(Type type) {
  return std::ranges::find(kNames, type, [](const auto& named) { return named.second; })->first;
}

std::size_t size_of(Type type) {
  switch (type) {
    case Type::kInt8:
    case Type::kUint8:
      return 1;
    case Type::kInt16:
    case Type::kUint16:
      return 2;
    case Type::kInt32:
    case Type::kUint32:
    case Type::kFloat:
      return 4;
    case Type::kDouble:
      return 8;
  }
  return 0;
}

double load_number(Type type, const char* at) {
  switch (type) {
    case Type::kInt8:
      return load<std::int8_t>(at);
    case Type::kUint8:
      return load<std::uint8_t>(at);
    case Type::kInt16:
      return load<std::int16_t>(at);
    case Type::kUint16:
      return load<std::uint16_t>(at);
    case Type::kInt32:
      return load<std::int32_t>(at);
    case Type::kUint32:
      return load<std::uint32_t>(at);
    case Type::kFloat:
      return load<float>(at);
    case Type::kDouble:
      return load<double>(at);
  }
  return 0;
}

Header parse_header(std::string_view bytes, const std::string& name) {
  return HeaderParser(bytes, name).parse();
}

}  // namespace mh::ply
