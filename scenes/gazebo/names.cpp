// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo/names.hpp"

#include <fmt/format.h>

namespace mh::gazebo {
namespace {

/// A name that libsdformat accepts.
std::string sound_name(const char* given) {
  std::string name = given == nullptr ? "" : given;
  for (std::size_t at; (at = name.find("::")) != name.npos; name[at] = '_') name.erase(at, 1);
  while (name.starts_with("__") && name.ends_with("__")) name.erase(0, 2);
  if (name.empty()) return "unnamed";
  return name == "world" ? "world_" : name;
}

}  // namespace

std::string Names::take(const char* given) {
  const std::string name = sound_name(given);
  const auto [given_before, is_new] = taken_.try_emplace(name, 2);
  if (is_new) return name;
  std::string free;
  do free = fmt::format("{}_{}", name, given_before->second++);
  while (!taken_.try_emplace(free, 2).second);
  return free;
}

}  // namespace mh::gazebo
