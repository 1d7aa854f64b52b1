// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace mh {

struct InputSize {
  int width = 0, height = 0;  ///< 0: the network leaves it open
  friend bool operator==(const InputSize&, const InputSize&) = default;
};

/// The first input of four dimensions that an ONNX model declares.
struct OnnxInput {
  std::uint64_t images = 0;             ///< at once; 0: the network leaves it open
  std::uint64_t width = 0, height = 0;  ///< of each; 0: likewise
  friend bool operator==(const OnnxInput&, const OnnxInput&) = default;
};

/// nullopt if the bytes are no model with such an input. OpenCV's importer knows it and does not
/// say it.
std::optional<OnnxInput> onnx_input(std::string_view model);

/// Says which weights of an ONNX model are not as many as their shape states, or are kept in
/// another file: OpenCV's importer would read beyond their end. "" = none, or the bytes are no such
/// model.
std::string onnx_weights_fault(std::string_view model);

/// What programs that write ONNX models say of them: Ultralytics states `names`, `task`, `imgsz`.
std::map<std::string, std::string> onnx_metadata(std::string_view model);

}  // namespace mh
