// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace mh {

/// NYU40 ids 1 to 40; 0 is void (not annotated); 41 is background (a detector looked and found
/// nothing); ids above 41 are COCO classes that NYU40 lumps into "otherfurniture"/"otherprop".
using ClassId = std::uint8_t;

inline constexpr ClassId kVoid = 0;
inline constexpr ClassId kBackground = 41;

struct ClassInfo {
  ClassId id = kVoid;
  std::string_view name;             ///< lower case, as in NYU40 or COCO
  ClassId nyu40 = kVoid;             ///< the NYU40 id used for it in NYU40/ScanNet files
  int coco80 = -1;                   ///< index among the 80 COCO detection classes, -1 = none
  std::uint8_t r = 0, g = 0, b = 0;  ///< display color
};

/// Every class, ordered by id: classes()[id].id == id.
std::span<const ClassInfo> classes();

/// Returns the class with that name (or a known synonym: "tv", "refrigerator", ...); nullopt if
/// unknown.
std::optional<ClassId> class_by_name(std::string_view name);

/// Sparse distribution over classes: (class, probability) ordered by class; probabilities sum to at
/// most 1. Empty means void.
struct ClassDistribution {
  std::vector<std::pair<ClassId, float>> entries;

  static ClassDistribution one_hot(ClassId id) {
    return id == kVoid ? ClassDistribution{} : ClassDistribution{{{id, 1.0F}}};
  }
  /// The most probable class, ties to the smallest id; void if empty.
  ClassId most_probable() const;
  friend bool operator==(const ClassDistribution&, const ClassDistribution&) = default;
};

}  // namespace mh
