// SPDX-License-Identifier: Apache-2.0
// Text and big-endian bodies of PLYs.
#include <algorithm>
#include <charconv>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "scenes/mesh_io/ply_header.hpp"
#include "slam/io/error.hpp"

namespace mh::ply {

namespace {

/// Rewrites a body as binary, little-endian.
class Transcoder {
 public:
  Transcoder(std::string_view body, Encoding encoding, const std::string& name)
      : body_(body), is_text_(encoding == Encoding::kText), name_(name) {}

  std::string run(const Header& header) {
    for (const Element& element : header.elements) {
      // A value takes at least one byte as text, and an element without properties takes none.
      std::size_t least = 0;
      for (const Property& property : element.properties)
        least += is_text_ ? 1 : size_of(property.count_type.value_or(property.type));
      if (least > 0 && element.count > (body_.size() - at_ + 1) / least)
        fail(element, 0, "is truncated");
      if (least == 0) continue;
      for (std::uint64_t record = 0; record < element.count; ++record)
        for (const Property& property : element.properties) copy(element, record, property);
    }
    out_ += body_.substr(std::min(at_, body_.size()));
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const Element& element, std::uint64_t record,
                         const std::string& what) const {
    throw InputError(fmt::format("{}: {} in record {} of {} of element '{}'", name_, what, record,
                                 element.count, element.name));
  }

  void copy(const Element& element, std::uint64_t record, const Property& property) {
    double count = 1;
    if (property.count_type) {
      count = value(element, record, *property.count_type);
      if (count < 0 || count > static_cast<double>(body_.size() - at_))
        fail(element, record, fmt::format("a list of {} items", count));
    }
    for (double i = 0; i < count; ++i) value(element, record, property.type);
  }

  double value(const Element& element, std::uint64_t record, Type type) {
    const std::size_t begin = out_.size();
    if (is_text_) {
      append_text(element, record, type);
    } else {
      const std::size_t size = size_of(type);
      if (body_.size() - at_ < size) fail(element, record, "is truncated");
      out_.append(body_.substr(at_, size));
      std::reverse(out_.begin() + static_cast<std::ptrdiff_t>(begin), out_.end());
      at_ += size;
    }
    return load_number(type, out_.data() + begin);
  }

  void append_text(const Element& element, std::uint64_t record, Type type) {
    const std::size_t begin = body_.find_first_not_of(" \t\r\n", at_);
    if (begin == body_.npos) fail(element, record, "is truncated");
    const std::size_t end = std::min(body_.find_first_of(" \t\r\n", begin), body_.size());
    std::string_view word = body_.substr(begin, end - begin);
    at_ = end;
    if (word.starts_with('+')) word.remove_prefix(1);
    double number = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error == std::errc::invalid_argument || stop != word.data() + word.size())
      fail(element, record, fmt::format("'{}' is not a number", word.substr(0, 40)));
    const auto append = [&]<class T>(T) {
      if constexpr (std::is_integral_v<T>)
        if (!(number >= static_cast<double>(std::numeric_limits<T>::min()) &&
              number <= static_cast<double>(std::numeric_limits<T>::max())))
          fail(element, record, fmt::format("{} is out of its type's range", number));
      const T value = static_cast<T>(number);
      out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    with_type(type, append);
  }

  template <class Use>
  static void with_type(Type type, const Use& use) {
    switch (type) {
      case Type::kInt8:
        return use(std::int8_t{});
      case Type::kUint8:
        return use(std::uint8_t{});
      case Type::kInt16:
        return use(std::int16_t{});
      case Type::kUint16:
        return use(std::uint16_t{});
      case Type::kInt32:
        return use(std::int32_t{});
      case Type::kUint32:
        return use(std::uint32_t{});
      case Type::kFloat:
        return use(float{});
      case Type::kDouble:
        return use(double{});
    }
  }

  std::string_view body_;
  bool is_text_;
  const std::string& name_;
  std::string out_;
  std::size_t at_ = 0;
};

}  // namespace

std::string as_little_endian(std::string_view body, const Header& header, const std::string& name) {
  return Transcoder(body, *header.encoding, name).run(header);
}

}  // namespace mh::ply
