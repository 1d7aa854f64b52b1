// SPDX-License-Identifier: Apache-2.0
#include "robots/model/xacro.hpp"

#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "slam/io/error.hpp"

namespace mh {
namespace {

using XacroNames = std::vector<std::pair<std::string, std::string>>;  // the reference, its value

constexpr std::string_view kPrefix = "xacro:";

std::string replaced(std::string text, const XacroNames& names) {
  for (const auto& [name, value] : names)
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += value.size())
      text.replace(at, name.size(), value);
  return text;
}

/// The names defined at the top, each expanded with those before it.
XacroNames names_of(const tinyxml2::XMLElement& robot) {
  XacroNames names;
  for (auto* e = robot.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string_view kind = e->Name();
    const bool arg = kind == "xacro:arg";
    const char* name = e->Attribute("name");
    const char* value = e->Attribute(arg ? "default" : "value");
    if ((!arg && kind != "xacro:property") || name == nullptr || value == nullptr) continue;
    names.emplace_back(arg ? fmt::format("$(arg {})", name) : fmt::format("${{{}}}", name),
                       replaced(value, names));
  }
  return names;
}

/// @throws InputError at the first element that still needs expanding
void require_plain(const tinyxml2::XMLElement& parent, const std::filesystem::path& file) {
  for (auto* e = parent.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    std::string what;
    const std::string_view kind = e->Name();
    if (kind == "xacro:arg" || kind == "xacro:property") continue;
    if (kind.starts_with(kPrefix)) what = fmt::format("<{}>", kind);
    for (auto* a = e->FirstAttribute(); a != nullptr && what.empty(); a = a->Next())
      if (const std::string_view value = a->Value();
          value.find("${") != value.npos || value.find("$(") != value.npos)
        what = value;
    if (!what.empty())
      throw InputError(
          fmt::format("{}:{}: '{}' is xacro: expand the file first (xacro FILE > robot.urdf)",
                      file.string(), e->GetLineNum(), what));
    require_plain(*e, file);
  }
}

}  // namespace

std::string with_xacro_names(std::string urdf, const std::filesystem::path& file) {
  tinyxml2::XMLDocument document;
  const auto parse = [&]() -> const tinyxml2::XMLElement* {
    if (document.Parse(urdf.c_str(), urdf.size()) != tinyxml2::XML_SUCCESS) return nullptr;
    return document.FirstChildElement("robot");
  };
  const tinyxml2::XMLElement* robot = parse();
  if (robot == nullptr) return urdf;  // reported by load_urdf()
  if (const XacroNames names = names_of(*robot); !names.empty()) {
    urdf = replaced(std::move(urdf), names);
    robot = parse();
  }
  if (robot != nullptr) require_plain(*robot, file);
  return urdf;
}

}  // namespace mh
