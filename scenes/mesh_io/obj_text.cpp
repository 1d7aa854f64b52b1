// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/obj_text.hpp"

#include <algorithm>
#include <array>

namespace mh {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// Puts a zero before each number that starts with the decimal point.
void append_coordinates(std::string_view line, std::string& to) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_signed = i >= 2 && (line[i - 1] == '-' || line[i - 1] == '+');
    if (line[i] == '.' && i > 0 && is_blank(line[i - (is_signed ? 2 : 1)])) to += '0';
    to += line[i];
  }
}

bool is_line_of(std::string_view line, std::string_view key) {
  return line.starts_with(key) && line.size() > key.size() && is_blank(line[key.size()]);
}

/// The position of the first face if the file has materials but chooses none before this face; else
/// npos.
std::size_t face_without_material(std::string_view text) {
  bool has_materials = false;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    const std::string_view line = text.substr(at, 16);
    has_materials = has_materials || is_line_of(line, "mtllib");
    if (is_line_of(line, "usemtl")) return text.npos;
    if (is_line_of(line, "f")) return has_materials ? at : text.npos;
    if (text.find('\n', at) == text.npos) break;
  }
  return text.npos;
}

}  // namespace

std::optional<std::string> repaired_obj(std::string_view text) {
  constexpr std::array<std::string_view, 5> kSigns = {" .", "\t.", "-.", "+.", "aniso"};
  const std::size_t face = face_without_material(text);
  if (face == text.npos &&
      std::ranges::none_of(kSigns, [&](auto sign) { return text.find(sign) != text.npos; }))
    return std::nullopt;
  std::string repaired;
  if (face != text.npos) {
    repaired = repaired_obj(text.substr(0, face)).value_or(std::string(text.substr(0, face)));
    repaired += "usemtl DefaultMaterial\n";  // load_mesh() recognizes it by this name
    text.remove_prefix(face);
  }
  repaired.reserve(repaired.size() + text.size() + text.size() / 8);
  while (!text.empty()) {
    const std::size_t size = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, size);
    text.remove_prefix(size);
    const std::string_view inner =
        line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
    if (inner.starts_with("aniso"))
      repaired += '\n';
    else if (inner.starts_with('v'))
      append_coordinates(line, repaired);
    else
      repaired += line;
  }
  return repaired;
}

}  // namespace mh
