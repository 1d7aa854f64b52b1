// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "slam/detect/onnx_input.hpp"

namespace mh {

/// The image size in section [net] of a Darknet configuration; 0 where it is missing.
/// @throws InputError naming file and line if a size or a layer's anchors are invalid: OpenCV's
/// importer would read out of bounds.
InputSize darknet_input(const std::string& config, const std::filesystem::path& file);

}  // namespace mh
