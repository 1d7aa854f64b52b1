// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/ply.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/held_bytes.hpp"

namespace mh {
namespace {

static_assert(std::endian::native == std::endian::little,
              "values are read and written as they lie");

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

std::optional<Type> type_by_name(std::string_view name) {
  constexpr std::pair<std::string_view, Type> kNames[] = {
      {"char", Type::kInt8},     {"int8", Type::kInt8},     {"uchar", Type::kUint8},
      {"uint8", Type::kUint8},   {"short", Type::kInt16},   {"int16", Type::kInt16},
      {"ushort", Type::kUint16}, {"uint16", Type::kUint16}, {"int", Type::kInt32},
      {"int32", Type::kInt32},   {"uint", Type::kUint32},   {"uint32", Type::kUint32},
      {"float", Type::kFloat},   {"float32", Type::kFloat}, {"double", Type::kDouble},
      {"float64", Type::kDouble}};
  for (const auto& [known, type] : kNames)
    if (known == name) return type;
  return std::nullopt;
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

template <class T>
T load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Any scalar as a number that holds it exactly.
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

struct Property {
  std::string name;
  Type type = Type::kInt8;           ///< of the value, or of a list's items
  std::optional<Type> count_type{};  ///< set for a list
  std::size_t offset = 0;            ///< within the record; lists have none
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  bool has_list = false;
  std::size_t stride = 0;  ///< bytes of a record; without lists only

  const Property* find(std::string_view wanted) const {
    const auto found = std::ranges::find(properties, wanted, &Property::name);
    return found == properties.end() ? nullptr : &*found;
  }
};

struct Header {
  bool binary_little_endian = false;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes up to and with the line end of end_header
};

/// Splits a header line at blanks.
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
      throw InputError(fmt::format("{}:1: is no PLY: the first line must be 'ply'", name_));
    next_line();
    for (;;) {
      const auto words = words_of(next_line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() == 3)
        header_.binary_little_endian = words[1] == "binary_little_endian" && words[2] == "1.0";
      else if (words[0] == "element" && words.size() == 3)
        add_element(words);
      else if (words[0] == "property")
        add_property(words);
      else
        fail(fmt::format("'{}' is no line of a PLY header", words[0].substr(0, 40)));
    }
    header_.size = at_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_, what));
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
      fail(fmt::format("'{}' is no number of elements", words[2].substr(0, 40)));
    header_.elements.push_back(std::move(element));
  }

  Type type_of(std::string_view word) const {
    const auto type = type_by_name(word);
    if (!type) fail(fmt::format("'{}' is no type", word.substr(0, 40)));
    return *type;
  }

  void add_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before the first element");
    Element& element = header_.elements.back();
    if (words.size() == 5 && words[1] == "list") {
      const Type count_type = type_of(words[2]);
      if (count_type == Type::kFloat || count_type == Type::kDouble)
        fail("a list counts in whole numbers");
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

/// Reads the elements after the header.
class BodyParser {
 public:
  BodyParser(std::string_view body, const std::string& name, const PlyParts& parts)
      : body_(body), name_(name), parts_(parts) {}

  PlyMesh parse(const Header& header) {
    bool has_vertices = false, has_faces = false;
    for (const Element& element : header.elements) {
      if (element.name == "vertex" && !has_vertices) {
        has_vertices = true;
        read_vertices(element);
        if (!parts_.geometry) return std::move(mesh_);
      } else if (element.name == "face" && !has_faces) {
        if (!has_vertices) fail("the faces come before the vertices");
        has_faces = true;
        read_faces(element);
      } else {
        skip(element);
      }
    }
    if (!has_vertices) fail("the header names no element 'vertex'");
    if (!has_faces) fail("the header names no element 'face'");
    const std::size_t last = body_.substr(at_).find_last_not_of(" \t\r\n");
    mesh_.bytes_left = last == body_.npos ? 0 : last + 1;
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", name_, what));
  }

  /// Claims the records of an element without lists. @returns where they begin
  const char* claim(const Element& element) {
    const std::size_t left = body_.size() - at_;
    if (element.stride > 0 && element.count > left / element.stride)
      fail(fmt::format("is cut short: {} records of element '{}' need {} bytes each, {} are left",
                       element.count, element.name, element.stride, left));
    const char* begin = body_.data() + at_;
    at_ += static_cast<std::size_t>(element.count) * element.stride;
    return begin;
  }

  const Property& need(const Element& element, std::string_view property) const {
    const Property* found = element.find(property);
    if (found == nullptr) fail(fmt::format("vertices have no property '{}'", property));
    return *found;
  }

  void read_vertices(const Element& element) {
    if (element.has_list) fail("vertices have a list property, which is not supported");
    const std::array<const Property*, 3> axes = {&need(element, "x"), &need(element, "y"),
                                                 &need(element, "z")};
    if (element.count > std::numeric_limits<std::uint32_t>::max())
      fail(fmt::format("{} vertices are more than 32 bits can name", element.count));
    const char* begin = claim(element);
    vertices_ = static_cast<std::size_t>(element.count);
    if (parts_.geometry) {
      read_positions(begin, element.stride, axes);
      read_colours(begin, element);
    }
    if (parts_.labels) read_labels(begin, element);
  }

  void read_positions(const char* begin, std::size_t stride,
                      const std::array<const Property*, 3>& axes) {
    const bool floats =
        std::ranges::all_of(axes, [](const Property* axis) { return axis->type == Type::kFloat; });
    mesh_.positions_m.resize(vertices_);
    for (std::size_t i = 0; i < vertices_; ++i) {
      const char* record = begin + i * stride;
      Eigen::Vector3f& p = mesh_.positions_m[i];
      if (floats)
        p = {load<float>(record + axes[0]->offset), load<float>(record + axes[1]->offset),
             load<float>(record + axes[2]->offset)};
      else
        for (int k = 0; k < 3; ++k)
          p[k] = static_cast<float>(load_number(axes[k]->type, record + axes[k]->offset));
      if (!p.allFinite())
        fail(fmt::format("vertex {} has a position that is not finite: {} {} {}", i, p.x(), p.y(),
                         p.z()));
    }
  }

  void read_colours(const char* begin, const Element& element) {
    const std::array<const Property*, 3> channels = {element.find("red"), element.find("green"),
                                                     element.find("blue")};
    if (std::ranges::count(channels, nullptr) > 0) return;
    const auto level = [&](const char* record, const Property& channel) {
      const char* at = record + channel.offset;
      if (channel.type == Type::kUint8) return load<std::uint8_t>(at);
      double value = load_number(channel.type, at);
      if (channel.type == Type::kFloat || channel.type == Type::kDouble) value *= 255.0;
      if (!(value > 0.0)) return std::uint8_t{0};  // also what is no number
      return static_cast<std::uint8_t>(std::min(value, 255.0) + 0.5);
    };
    mesh_.colours.resize(vertices_);
    for (std::size_t i = 0; i < vertices_; ++i) {
      const char* record = begin + i * element.stride;
      mesh_.colours[i] = {level(record, *channels[0]), level(record, *channels[1]),
                          level(record, *channels[2])};
    }
  }

  void read_labels(const char* begin, const Element& element) {
    const Property* label = element.find("label");
    if (label == nullptr) return;
    mesh_.labels.resize(vertices_);
    for (std::size_t i = 0; i < vertices_; ++i) {
      const char* at = begin + i * element.stride + label->offset;
      if (label->type == Type::kUint16) {
        mesh_.labels[i] = load<std::uint16_t>(at);
        continue;
      }
      const double value = load_number(label->type, at);
      if (!(value >= 0 && value <= 65535) || value != std::floor(value))
        fail(fmt::format("vertex {} has label {}, which is no 16-bit id", i, value));
      mesh_.labels[i] = static_cast<std::uint16_t>(value);
    }
  }

  void read_faces(const Element& element) {
    const Property* indices = element.find("vertex_indices");
    if (indices == nullptr) indices = element.find("vertex_index");
    if (indices == nullptr || !indices->count_type) fail("faces have no list 'vertex_indices'");
    if (indices->type == Type::kFloat || indices->type == Type::kDouble)
      fail("faces name vertices by numbers that are not whole");
    // The usual record, 3 and three 32-bit indices, has a loop of its own.
    const bool usual = element.properties.size() == 1 && size_of(*indices->count_type) == 1 &&
                       size_of(indices->type) == 4;
    mesh_.triangles.reserve(static_cast<std::size_t>(
        std::min<std::uint64_t>(element.count, (body_.size() - at_) / 13 + 1)));
    for (std::uint64_t face = 0; face < element.count; ++face) {
      if (usual && body_.size() - at_ >= 13 && body_[at_] == 3) {
        const char* at = body_.data() + at_ + 1;
        add_triangle(
            face, indices->type,
            {load<std::uint32_t>(at), load<std::uint32_t>(at + 4), load<std::uint32_t>(at + 8)});
        at_ += 13;
      } else {
        read_face(element, indices, face);
      }
    }
  }

  /// @pre type has 32 bits
  void add_triangle(std::uint64_t face, Type type, const std::array<std::uint32_t, 3>& triangle) {
    for (const std::uint32_t vertex : triangle)
      if (vertex >= vertices_)
        fail_index(face, type == Type::kInt32 ? std::int64_t{static_cast<std::int32_t>(vertex)}
                                              : std::int64_t{vertex});
    mesh_.triangles.push_back(triangle);
  }

  [[noreturn]] void fail_index(std::uint64_t face, std::int64_t vertex) const {
    fail(fmt::format("face {} names vertex {} of {}", face, vertex, vertices_));
  }

  void need_bytes(std::size_t size, const Element& element, std::uint64_t record) const {
    if (body_.size() - at_ < size)
      fail(fmt::format("is cut short in record {} of {} of element '{}'", record, element.count,
                       element.name));
  }

  /// The items of a list, which are `bytes` long together; at_ is then behind them.
  struct List {
    const char* items;
    std::size_t count;
  };
  List read_list(const Element& element, const Property& list, std::uint64_t record) {
    need_bytes(size_of(*list.count_type), element, record);
    const double count = load_number(*list.count_type, body_.data() + at_);
    at_ += size_of(*list.count_type);
    const std::size_t left = (body_.size() - at_) / size_of(list.type);
    if (count < 0 || count > static_cast<double>(left))
      fail(fmt::format("record {} of element '{}' announces a list of {} items, {} are left",
                       record, element.name, count, left));
    const List result{body_.data() + at_, static_cast<std::size_t>(count)};
    at_ += result.count * size_of(list.type);
    return result;
  }

  void read_face(const Element& element, const Property* indices, std::uint64_t face) {
    for (const Property& property : element.properties) {
      if (!property.count_type) {
        need_bytes(size_of(property.type), element, face);
        at_ += size_of(property.type);
        continue;
      }
      const List list = read_list(element, property, face);
      if (&property != indices) continue;
      // Nothing to be seen; and where a count is damaged, all that follows is read askew.
      if (list.count < 3)
        fail(fmt::format("face {} has {} corners: 3 are needed", face, list.count));
      const auto corner = [&](std::size_t k) {
        const double vertex = load_number(property.type, list.items + k * size_of(property.type));
        if (vertex < 0 || vertex >= static_cast<double>(vertices_))
          fail_index(face, static_cast<std::int64_t>(vertex));
        return static_cast<std::uint32_t>(vertex);
      };
      for (std::size_t k = 2; k < list.count; ++k)
        mesh_.triangles.push_back({corner(0), corner(k - 1), corner(k)});
    }
  }

  void skip(const Element& element) {
    if (!element.has_list) {
      claim(element);
      return;
    }
    for (std::uint64_t record = 0; record < element.count; ++record)
      for (const Property& property : element.properties) {
        if (property.count_type) {
          read_list(element, property, record);
          continue;
        }
        need_bytes(size_of(property.type), element, record);
        at_ += size_of(property.type);
      }
  }

  std::string_view body_;
  const std::string& name_;
  PlyParts parts_;
  PlyMesh mesh_;
  std::size_t at_ = 0, vertices_ = 0;
};

}  // namespace

bool is_plain_binary_ply(std::string_view bytes) {
  try {
    const std::string name;
    const Header header = HeaderParser(bytes, name).parse();
    for (const Element& element : header.elements)
      for (const char* uv : {"s", "u", "texture_u", "texcoord"})
        if (element.find(uv) != nullptr) return false;
    return header.binary_little_endian;
  } catch (const InputError&) {
    return false;
  }
}

PlyMesh parse_ply(std::string_view bytes, const std::string& name, const PlyParts& parts) {
  const Header header = HeaderParser(bytes, name).parse();
  if (!header.binary_little_endian)
    throw InputError(fmt::format("{}: its format must be binary_little_endian 1.0", name));
  return BodyParser(bytes.substr(header.size), name, parts).parse(header);
}

PlyMesh read_ply(const std::filesystem::path& file, const PlyParts& parts) {
  const HeldBytes held = map_file(file);
  return parse_ply(held.view, file.string(), parts);
}

void warn_of_bytes_left(const PlyMesh& mesh, const std::filesystem::path& file,
                        std::vector<std::string>* warnings) {
  if (mesh.bytes_left > 0 && warnings != nullptr)
    warnings->push_back(fmt::format("{}: {} bytes follow the last element and are not read",
                                    file.string(), mesh.bytes_left));
}

std::string ply_bytes(const PlyMesh& mesh) {
  const std::size_t vertices = mesh.positions_m.size();
  const bool labelled = !mesh.labels.empty();
  assert(mesh.colours.size() == vertices && (!labelled || mesh.labels.size() == vertices));
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment Modelhouse\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n{}"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      vertices, labelled ? "property ushort label\n" : "", mesh.triangles.size());
  const auto append = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  bytes.reserve(bytes.size() + 18 * vertices + 13 * mesh.triangles.size());
  for (std::size_t v = 0; v < vertices; ++v) {
    for (int axis = 0; axis < 3; ++axis) append(mesh.positions_m[v][axis]);
    append(mesh.colours[v]);
    append(std::uint8_t{255});
    if (labelled) append(mesh.labels[v]);
  }
  for (const auto& triangle : mesh.triangles) {
    append(std::uint8_t{3});
    append(triangle);
  }
  return bytes;
}

}  // namespace mh
