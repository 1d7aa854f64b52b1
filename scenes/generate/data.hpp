// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace mh {

/// The categories, in the order of the paper's Table 1.
inline constexpr std::array<std::string_view, 12> kCategoryNames = {
    "bathroom", "bedroom", "bookstore",   "classroom", "conference_room", "copy_mail_room",
    "hallway",  "kitchen", "living_room", "lobby",     "office",          "misc"};

/// Floors of many similar rooms, in addition to the paper's categories.
inline constexpr std::array<std::string_view, 2> kFloorNames = {"hotel", "office_floor"};

/// The text of scenes/generate/categories/NAME.yaml or scenes/generate/floors/NAME.yaml, embedded
/// in the program, so that generated scenes need no files.
std::string_view generator_data(std::string_view name);

}  // namespace mh
