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
  std::uint64_t images = 0;             ///< per run; 0: the network leaves it open
  std::uint64_t width = 0, height = 0;  ///< of each image; 0: left open
  friend bool operator==(const OnnxInput&, const OnnxInput&) = default;
};

/// nullopt if the bytes are not a model with such an input. (OpenCV's importer knows this input but
/// does not expose it.)
std::optional<OnnxInput> onnx_input(std::string_view model);

/// Names weights of an ONNX model that do not fill the shape that they state, or that are stored in
/// another file: OpenCV's importer would read past their end. Empty if there are none, or if the
/// bytes are not an ONNX model.
std::string onnx_weights_fault(std::string_view model);

/// Metadata that exporters write into ONNX models: Ultralytics states `names`, `task`, `imgsz`.
std::map<std::string, std::string> onnx_metadata(std::string_view model);

}  // namespace mh
