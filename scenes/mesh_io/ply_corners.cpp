// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/ply_corners.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "scenes/mesh_io/ply_header.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using ply::Element;
using ply::Property;

/// Whether a property is a texture coordinate of vertices, which the corners' coordinates replace.
bool is_uv(const Property& property) {
  constexpr std::array<std::string_view, 8> kNames = {"s",  "t",  "u",         "v",
                                                      "tx", "ty", "texture_u", "texture_v"};
  return std::ranges::find(kNames, property.name) != kNames.end();
}

const Property* list_in(const Element& element, std::string_view name) {
  const Property* found = element.find(name);
  return found != nullptr && found->count_type ? found : nullptr;
}

const Property* indices_in(const Element& faces) {
  const Property* found = list_in(faces, "vertex_indices");
  return found != nullptr ? found : list_in(faces, "vertex_index");
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Reads a little-endian body, and writes new vertices and faces.
class Splitter {
 public:
  Splitter(std::string_view body, const std::string& name) : body_(body), name_(name) {}

  void read(const Element& element) {
    const bool is_faces = element.name == "face";
    if (element.name == "vertex") {
      vertices_ = &element;
      records_ = body_.substr(at_);
    }
    const Property* indices = is_faces ? indices_in(element) : nullptr;
    const Property* uvs = is_faces ? list_in(element, "texcoord") : nullptr;
    for (std::uint64_t record = 0; record < element.count; ++record) {
      std::vector<double> corners, places;
      for (const Property& property : element.properties)
        read_property(property, record,
                      &property == indices ? &corners
                      : &property == uvs   ? &places
                                           : nullptr);
      if (indices != nullptr) add_face(corners, places, record);
    }
  }

  std::string file(std::string_view comments) const {
    std::string text = fmt::format("ply\nformat binary_little_endian 1.0\n{}element vertex {}\n",
                                   comments, corner_count_);
    for (const Property& property : vertices_->properties)
      if (!is_uv(property))
        text += fmt::format("property {} {}\n", ply::name_of(property.type), property.name);
    text += fmt::format(
        "property float s\nproperty float t\nelement face {}\nproperty list uint uint "
        "vertex_indices\nend_header\n",
        face_count_);
    return text + corners_ + faces_;
  }

 private:
  [[noreturn]] void fail(std::uint64_t record, const std::string& what) const {
    throw InputError(fmt::format("{}: face {} {}", name_, record, what));
  }

  double take(ply::Type type, std::uint64_t record) {
    if (body_.size() - at_ < ply::size_of(type))
      throw InputError(fmt::format("{}: is truncated in record {}", name_, record));
    const double value = ply::load_number(type, body_.data() + at_);
    at_ += ply::size_of(type);
    return value;
  }

  /// @param values  receives a list's items; null to skip them
  void read_property(const Property& property, std::uint64_t record, std::vector<double>* values) {
    if (!property.count_type) {
      take(property.type, record);
      return;
    }
    const double count = take(*property.count_type, record);
    for (double k = 0; k < count; ++k) {
      const double value = take(property.type, record);
      if (values != nullptr) values->push_back(value);
    }
  }

  void add_face(const std::vector<double>& corners, const std::vector<double>& places,
                std::uint64_t face) {
    if (vertices_ == nullptr) fail(face, "comes before the vertices");
    append(faces_, static_cast<std::uint32_t>(corners.size()));
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (!(corners[k] >= 0 && corners[k] < static_cast<double>(vertices_->count)))
        fail(face, fmt::format("names vertex {} of {}", corners[k], vertices_->count));
      const char* record =
          records_.data() + static_cast<std::size_t>(corners[k]) * vertices_->stride;
      for (const Property& property : vertices_->properties)
        if (!is_uv(property))
          corners_.append(record + property.offset, ply::size_of(property.type));
      for (const std::size_t axis : {0U, 1U})
        append(corners_,
               2 * k + axis < places.size() ? static_cast<float>(places[2 * k + axis]) : 0.0F);
      append(faces_, corner_count_++);
    }
    ++face_count_;
  }

  std::string_view body_, records_;
  const std::string& name_;
  std::size_t at_ = 0;
  const Element* vertices_ = nullptr;
  std::string corners_, faces_;
  std::uint32_t corner_count_ = 0;
  std::uint64_t face_count_ = 0;
};

/// The header's lines that name textures.
std::string textures_in(std::string_view header) {
  std::string lines;
  for (std::size_t at = 0; at < header.size();) {
    const std::size_t end = std::min(header.find('\n', at), header.size());
    std::string_view line = header.substr(at, end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.starts_with("comment TextureFile")) lines += std::string(line) + '\n';
    at = end + 1;
  }
  return lines;
}

}  // namespace

std::optional<std::string> ply_with_corners(std::string_view bytes, const std::string& name) {
  const ply::Header header = ply::parse_header(bytes, name);
  const auto faces = std::ranges::find(header.elements, "face", &Element::name);
  const auto vertices = std::ranges::find(header.elements, "vertex", &Element::name);
  if (faces == header.elements.end() || list_in(*faces, "texcoord") == nullptr ||
      indices_in(*faces) == nullptr || vertices == header.elements.end() || vertices->has_list)
    return std::nullopt;
  std::string rewritten;
  std::string_view body = bytes.substr(header.size);
  if (header.encoding != ply::Encoding::kLittleEndian) {
    rewritten = ply::as_little_endian(body, header, name);
    body = rewritten;
  }
  Splitter splitter(body, name);
  for (const Element& element : header.elements) splitter.read(element);
  return splitter.file(textures_in(bytes.substr(0, header.size)));
}

}  // namespace mh
