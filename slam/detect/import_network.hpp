// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/dnn.hpp>

#include "slam/detect/class_names.hpp"
#include "slam/detect/heads.hpp"
#include "slam/detect/onnx_input.hpp"
#include "slam/detect/settings.hpp"

namespace mh {

/// A network's files, read once.
struct NetworkFiles {
  std::string network, config;
  bool is_darknet = false;
};

NetworkFiles read_network_files(const DetectorSpec& spec);

/// An imported network, and how its input and output are to be understood.
struct ImportedNetwork {
  cv::dnn::Net net;
  std::vector<cv::String> outputs;
  InputSize input;
  DetectorSettings settings;  ///< contains no kAuto
  ClassNames names;
};

/// Imports a network and runs it once. An ONNX network that OpenCV cannot run unchanged is
/// rewritten for its input's size. @throws InputError
ImportedNetwork import_network(const DetectorSpec& spec, const NetworkFiles& files);

/// Outputs of one run; the tensors point into the matrices.
struct NetworkOutputs {
  std::vector<cv::Mat> mats;
  std::vector<Tensor> tensors;
};

/// Runs the network on an input and checks its output. @throws InputError
NetworkOutputs run_network(const std::filesystem::path& file, ImportedNetwork& imported,
                           const cv::Mat& input);

[[noreturn]] void refuse_network(const std::filesystem::path& file, const std::string& why);

}  // namespace mh
