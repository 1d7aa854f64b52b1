// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "slam/detect/onnx_input.hpp"

namespace mh {

/// The same network for images of one size, using only the ONNX operators and forms that OpenCV 4.6
/// runs: what depends on constants and sizes alone is computed; lists of axes and sizes that newer
/// operator sets take as inputs become attributes; constants are repeated to the shape that they
/// are broadcast to; half precision becomes single. Other operations stay as they are.
/// @pre onnx_weights_fault(model) is empty
/// @returns nullopt if the bytes are not an ONNX model
std::optional<std::string> rewrite_onnx(std::string_view model, const InputSize& input);

}  // namespace mh
