// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenes/instance_id.hpp"
#include "slam/core/labels.hpp"

namespace mh {

/// Labels encoded in the name of a mesh node.
struct NodeLabel {
  std::string name;
  ClassId class_id = kVoid;
  bool is_explicit = false;            ///< the class was given by name or number, not guessed
  std::optional<InstanceId> instance;  ///< only if the name states one
};

/// "kitchen/chair_2#class=chair#instance=17".
std::string node_name(std::string_view name, ClassId class_id, InstanceId instance);

/// Parses a name made by node_name; for any other, guesses the class (guess_class).
NodeLabel parse_node_name(std::string_view node);

/// Guesses the class from a name's last part ("kitchen/night_stand_2"); void if there is no match.
/// Words are separated by non-letters and by CamelCase; they are known from NYU40, COCO or a list
/// of synonyms (class_words.hpp), in the singular and the plural. If there are several nouns, the
/// last one before a "with", "of" or the like wins: "floor_01_walls" is a wall, "TableLamp" a lamp,
/// "box_of_books" a box.
ClassId guess_class(std::string_view name);

/// The class of a name that ends in its noun, as annotators write: "coffee cup" is a cup, "oven
/// mitt" has no class.
std::optional<ClassId> class_of_noun(std::string_view name);

/// Whether a class is one of those that NYU40 merges into `lump`: otherstructure, otherfurniture or
/// otherprop.
bool is_finer(ClassId class_id, ClassId lump);

}  // namespace mh
