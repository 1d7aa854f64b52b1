// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/ply.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "scenes/mesh_io/ply_header.hpp"
#include "slam/io/error.hpp"
#include "slam/io/held_bytes.hpp"

namespace mh {
namespace {

static_assert(std::endian::native == std::endian::little,
              "values are read and written as they lie");

using ply::Element;
using ply::Encoding;
using ply::Header;
using ply::load;
using ply::load_number;
using ply::Property;
using ply::size_of;
using ply::Type;

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

  /// Moves past the records of an element without lists. @returns where they start
  const char* claim(const Element& element) {
    const std::size_t left = body_.size() - at_;
    if (element.stride > 0 && element.count > left / element.stride)
      fail(fmt::format("is truncated: {} records of element '{}' need {} bytes each, {} are left",
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
      fail(fmt::format("{} vertices are more than 32 bits can index", element.count));
    const char* begin = claim(element);
    vertices_ = static_cast<std::size_t>(element.count);
    if (parts_.geometry) {
      read_positions(begin, element.stride, axes);
      read_colors(begin, element);
    }
    if (!parts_.labels) return;
    const auto ids = [&](std::string_view property, auto& values) {
      if (const Property* found = element.find(property))
        read_ids(begin, element.stride, *found, values);
    };
    ids("label", mesh_.labels);
    ids("NYU40", mesh_.nyu40);
    ids("objectId", mesh_.objects);
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

  void read_colors(const char* begin, const Element& element) {
    const std::array<const Property*, 3> channels = {element.find("red"), element.find("green"),
                                                     element.find("blue")};
    if (std::ranges::count(channels, nullptr) > 0) return;
    const auto level = [&](const char* record, const Property& channel) {
      const char* at = record + channel.offset;
      if (channel.type == Type::kUint8) return load<std::uint8_t>(at);
      double value = load_number(channel.type, at);
      if (channel.type == Type::kFloat || channel.type == Type::kDouble) value *= 255.0;
      if (!(value > 0.0)) return std::uint8_t{0};  // NaN as well
      return static_cast<std::uint8_t>(std::min(value, 255.0) + 0.5);
    };
    mesh_.colors.resize(vertices_);
    for (std::size_t i = 0; i < vertices_; ++i) {
      const char* record = begin + i * element.stride;
      mesh_.colors[i] = {level(record, *channels[0]), level(record, *channels[1]),
                         level(record, *channels[2])};
    }
  }

  template <class T>
  void read_ids(const char* begin, std::size_t stride, const Property& property,
                std::vector<T>& ids) const {
    ids.resize(vertices_);
    for (std::size_t i = 0; i < vertices_; ++i) {
      const char* at = begin + i * stride + property.offset;
      ids[i] = property.type == Type::kUint16
                   ? static_cast<T>(load<std::uint16_t>(at))
                   : id_of<T>(load_number(property.type, at), property, "vertex", i);
    }
  }

  template <class T>
  T id_of(double value, const Property& property, const char* what, std::uint64_t i) const {
    if (!(value >= 0 && value <= std::numeric_limits<T>::max()) || value != std::floor(value))
      fail(fmt::format("{} {} has {} {}, which is not a {}-bit id", what, i, property.name, value,
                       8 * sizeof(T)));
    return static_cast<T>(value);
  }

  void read_faces(const Element& element) {
    const Property* indices = element.find("vertex_indices");
    if (indices == nullptr) indices = element.find("vertex_index");
    if (indices == nullptr || !indices->count_type) fail("faces have no list 'vertex_indices'");
    if (indices->type == Type::kFloat || indices->type == Type::kDouble)
      fail("faces index vertices by numbers that are not integers");
    // The usual record, a 3 and three 32-bit indices, has a loop of its own.
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

  void require_bytes(std::size_t size, const Element& element, std::uint64_t record) const {
    if (body_.size() - at_ < size)
      fail(fmt::format("is truncated in record {} of {} of element '{}'", record, element.count,
                       element.name));
  }

  /// The items of a list.
  struct List {
    const char* items;
    std::size_t count;
  };
  List read_list(const Element& element, const Property& list, std::uint64_t record) {
    require_bytes(size_of(*list.count_type), element, record);
    const double count = load_number(*list.count_type, body_.data() + at_);
    at_ += size_of(*list.count_type);
    const std::size_t left = (body_.size() - at_) / size_of(list.type);
    if (count < 0 || count > static_cast<double>(left))
      fail(fmt::format("record {} of element '{}' declares a list of {} items, {} are left", record,
                       element.name, count, left));
    const List result{body_.data() + at_, static_cast<std::size_t>(count)};
    at_ += result.count * size_of(list.type);
    return result;
  }

  void read_face(const Element& element, const Property* indices, std::uint64_t face) {
    std::optional<std::uint32_t> object;
    for (const Property& property : element.properties) {
      if (!property.count_type) {
        require_bytes(size_of(property.type), element, face);
        if (parts_.labels && property.name == "object_id")
          object = object_of(load_number(property.type, body_.data() + at_), property, face);
        at_ += size_of(property.type);
        continue;
      }
      const List list = read_list(element, property, face);
      if (&property != indices) continue;
      // A face with fewer corners is invisible; and if the count is damaged, everything after it is
      // misread.
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
    if (object) mesh_.face_objects.resize(mesh_.triangles.size(), *object);
  }

  /// Negative ids mean no object.
  std::uint32_t object_of(double value, const Property& property, std::uint64_t face) const {
    return value < 0 ? kNoObject : id_of<std::uint32_t>(value, property, "face", face);
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
        require_bytes(size_of(property.type), element, record);
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

bool is_plain_ply(std::string_view bytes) {
  try {
    const std::string name;
    const Header header = ply::parse_header(bytes, name);
    for (const Element& element : header.elements) {
      if (element.name == "tristrips") return false;
      for (const char* uv : {"s", "u", "texture_u", "texcoord"})
        if (element.find(uv) != nullptr) return false;
    }
  } catch (const InputError&) {  // parse_ply reports it
  }
  return true;
}

PlyMesh parse_ply(std::string_view bytes, const std::string& name, const PlyParts& parts) {
  const Header header = ply::parse_header(bytes, name);
  const std::string_view body = bytes.substr(header.size);
  if (header.encoding == Encoding::kLittleEndian)
    return BodyParser(body, name, parts).parse(header);
  const std::string rewritten = ply::as_little_endian(body, header, name);
  return BodyParser(rewritten, name, parts).parse(header);
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
  const bool labeled = !mesh.labels.empty();
  assert(mesh.colors.size() == vertices && (!labeled || mesh.labels.size() == vertices));
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment Modelhouse\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n{}"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      vertices, labeled ? "property ushort label\n" : "", mesh.triangles.size());
  const auto append = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  bytes.reserve(bytes.size() + 18 * vertices + 13 * mesh.triangles.size());
  for (std::size_t v = 0; v < vertices; ++v) {
    for (int axis = 0; axis < 3; ++axis) append(mesh.positions_m[v][axis]);
    append(mesh.colors[v]);
    append(std::uint8_t{255});
    if (labeled) append(mesh.labels[v]);
  }
  for (const auto& triangle : mesh.triangles) {
    append(std::uint8_t{3});
    append(triangle);
  }
  return bytes;
}

}  // namespace mh