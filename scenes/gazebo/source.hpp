// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include <tinyxml2.h>

namespace mh::gazebo {

/// A file's XML and the context for reading its parts.
struct Source {
  std::filesystem::path file;
  tinyxml2::XMLDocument document;
  bool has_frames = false;         ///< false before SDF 1.7, where a pose's frame had no meaning
  std::set<std::string> referred;  ///< names used by relative_to and attached_to
};

/// The text of an element, without the whitespace around it; empty for null.
std::string text_of(const tinyxml2::XMLElement* element);

/// @throws InputError naming file and line if it is not SDF
std::unique_ptr<Source> parse_source(const std::filesystem::path& file, std::string text);

}  // namespace mh::gazebo
