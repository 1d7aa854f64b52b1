// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenes/scene.hpp"

namespace mh {

/// What the name of a mesh node tells about its faces.
struct NodeLabel {
  std::string name;
  ClassId class_id = kVoid;
  std::optional<InstanceId> instance;  ///< only where the name says so
};

/// "kitchen/chair_2#class=chair#instance=17".
std::string node_name(std::string_view name, ClassId class_id, InstanceId instance);

/// Reads a name made by node_name, and guesses the class of any other from the first and longest
/// run of words in its last part: "kitchen/night_stand_2" is a night stand, "wooden_table_02" a
/// table; void if none fits.
NodeLabel parse_node_name(std::string_view node);

/// The class guessed from a plain name; void if none fits.
ClassId guess_class(std::string_view name);

}  // namespace mh
