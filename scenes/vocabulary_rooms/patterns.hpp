// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scenes/scene.hpp"

namespace mh {

/// Families of textures for training visual vocabularies. None of them is a kind of material of the
/// house (material_kinds()), so that no vocabulary has seen what an evaluation shows.
std::span<const std::string_view> training_patterns();

/// One sheet of a family, 1.2 m square at 512 x 512 texels: the seed determines colors, sizes and
/// arrangement. Its name is "training/<family>". @throws InputError on an unknown family.
Material make_training_pattern(std::string_view family, std::uint64_t seed);

}  // namespace mh
