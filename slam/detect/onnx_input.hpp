// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mh {

struct InputSize {
  int width = 0, height = 0;  ///< 0: the network leaves it open
  friend bool operator==(const InputSize&, const InputSize&) = default;
};

/// The image size that an ONNX model declares for its first input of four dimensions; nullopt if
/// the bytes are no such model. OpenCV's importer knows it and does not say it.
std::optional<InputSize> onnx_input_size(std::string_view model);

/// Says which weights of an ONNX model are not as many as their shape states, or are kept in
/// another file: OpenCV's importer would read beyond their end. "" = none, or the bytes are no such
/// model.
std::string onnx_weights_fault(std::string_view model);

}  // namespace mh
