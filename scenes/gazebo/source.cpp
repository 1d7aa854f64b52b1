// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo/source.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh::gazebo {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;

namespace {

void gather_references(const XMLElement* element, std::set<std::string>& names) {
  for (; element != nullptr; element = element->NextSiblingElement()) {
    for (const char* attribute : {"relative_to", "attached_to"})
      if (const char* name = element->Attribute(attribute)) names.insert(name);
    gather_references(element->FirstChildElement(), names);
  }
}

/// If an XML declaration follows a comment, overwrites it with spaces: some released models have
/// this harmless error.
void drop_late_declaration(std::string& text) {
  const std::size_t at = text.find("<?xml");
  if (at == 0 || at == text.npos || at > text.find("<sdf")) return;
  const std::size_t end = std::min(text.find("?>", at), text.size() - 2) + 2;
  std::ranges::replace_if(
      text.begin() + static_cast<std::ptrdiff_t>(at),
      text.begin() + static_cast<std::ptrdiff_t>(end), [](char c) { return c != '\n'; }, ' ');
}

}  // namespace

std::string text_of(const tinyxml2::XMLElement* element) {
  const char* text = element == nullptr ? nullptr : element->GetText();
  if (text == nullptr) return {};
  std::string_view trimmed = text;
  const auto first = trimmed.find_first_not_of(" \t\r\n");
  if (first == trimmed.npos) return {};
  return std::string(trimmed.substr(first, trimmed.find_last_not_of(" \t\r\n") - first + 1));
}

std::unique_ptr<Source> parse_source(const fs::path& file, std::string text) {
  drop_late_declaration(text);
  auto made = std::make_unique<Source>();
  Source& source = *made;
  source.file = file;
  if (source.document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw InputError(fmt::format("{}:{}: is not SDF that can be read: {}", file.string(),
                                 std::max(source.document.ErrorLineNum(), 1),
                                 source.document.ErrorName()));
  const XMLElement* root = source.document.RootElement();
  if (root == nullptr ||
      (std::strcmp(root->Name(), "sdf") != 0 && std::strcmp(root->Name(), "gazebo") != 0))
    throw InputError(fmt::format("{}: is not SDF: its root is not <sdf>", file.string()));
  const char* version = root->Attribute("version");
  int major = 1, minor = 0;
  std::sscanf(version == nullptr ? "1.9" : version, "%d.%d", &major, &minor);
  constexpr int kFramesSince = 7;
  source.has_frames = major > 1 || minor >= kFramesSince;
  gather_references(root, source.referred);
  return made;
}

}  // namespace mh::gazebo
