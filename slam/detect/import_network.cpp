// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/import_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core/utils/logger.hpp>

#include "slam/detect/darknet_config.hpp"
#include "slam/detect/onnx_graph.hpp"
#include "slam/detect/onnx_rewrite.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/printable.hpp"
#include "slam/io/settings_io.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr int kLargestInput_px = 8192;

/// OpenCV's importers log to stderr; what matters is in their exceptions.
class Quiet {
 public:
  Quiet() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~Quiet() { cv::utils::logging::setLogLevel(before_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

/// OpenCV's reason in one line.
std::string reason(const cv::Exception& error) {
  constexpr std::size_t kMost = 300;
  std::string text = error.err.empty() ? std::string(error.what()) : error.err;
  std::ranges::replace(text, '\n', ' ');
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  return text;
}

/// Thrown if OpenCV cannot import or run the network.
struct NotRun : InputError {
  using InputError::InputError;
};

/// Runs OpenCV on a file. @throws NotRun with OpenCV's reason.
template <class Work>
auto with_opencv(const fs::path& file, const char* what, const Work& work) {
  const Quiet quiet;
  try {
    return work();
  } catch (const cv::Exception& error) {
    throw NotRun(fmt::format("{}: OpenCV {} cannot {} it: {}", file.string(), CV_VERSION, what,
                             reason(error)));
  }
}

/// Checks that there are as many Darknet weights as the layers take. OpenCV does not check this and
/// would read past their end.
void check_weights(const DetectorSpec& spec, cv::dnn::Net& net, std::string_view weights) {
  std::uint64_t values = 0;
  for (const cv::String& name : net.getLayerNames()) {
    const cv::Ptr<cv::dnn::Layer> layer = net.getLayer(net.getLayerId(name));
    if (layer->type == "Region") continue;  // its blobs are anchors, from the configuration
    for (const cv::Mat& blob : layer->blobs) values += blob.total();
  }
  std::int32_t version[2] = {};
  std::memcpy(version, weights.data(), sizeof version);
  const std::uint64_t head = version[0] * 10 + version[1] >= 2 ? 20 : 16;
  const std::uint64_t expected = head + 4 * values;
  if (weights.size() == expected) {
    for (std::uint64_t i = 0; i < values; ++i) {
      float weight = 0;
      std::memcpy(&weight, weights.data() + head + 4 * i, sizeof weight);
      if (!std::isfinite(weight))
        refuse_network(spec.network,
                       fmt::format("weight {} of {} is not a finite number", i + 1, values));
    }
    return;
  }
  refuse_network(spec.network, fmt::format("holds {} bytes, but {} needs {}: {}", weights.size(),
                                           spec.config.string(), expected,
                                           weights.size() < expected
                                               ? "it is truncated, or belongs to another network"
                                               : "it belongs to another network"));
}

NetworkOutputs forward(ImportedNetwork& imported, const cv::Mat& input) {
  NetworkOutputs out;
  imported.net.setInput(input);
  imported.net.forward(out.mats, imported.outputs);
  for (cv::Mat& mat : out.mats) {
    if (mat.depth() != CV_32F) mat.convertTo(mat, CV_32F);
    if (!mat.isContinuous()) mat = mat.clone();
    out.tensors.push_back({{mat.size.p, mat.size.p + mat.dims}, {mat.ptr<float>(), mat.total()}});
  }
  return out;
}

/// @throws InputError if an output holds NaN or no finite value: the weights are damaged.
void check_numbers(const fs::path& file, const NetworkOutputs& out) {
  for (const Tensor& tensor : out.tensors) {
    const auto bad = std::ranges::find_if(tensor.values, [](float v) { return std::isnan(v); });
    if (bad != tensor.values.end())
      refuse_network(file, fmt::format("gives a value that is not a number (value {} of {})",
                                       bad - tensor.values.begin() + 1, tensor.values.size()));
    if (std::ranges::none_of(tensor.values, [](float v) { return std::isfinite(v); }))
      refuse_network(file,
                     fmt::format("gives {} values, none of which is finite", tensor.values.size()));
  }
}

void resolve_auto(DetectorSettings& s, Head head) {
  s.head = head;
  const bool yolox = head == Head::kYolox || head == Head::kYoloxDecoded,
             segments = head == Head::kSegmentation;
  if (s.letterbox == Letterbox::kAuto)
    s.letterbox = yolox ? Letterbox::kCorner : segments ? Letterbox::kStretch : Letterbox::kCenter;
  if (s.normalize == Normalize::kAuto)
    s.normalize = yolox ? Normalize::kNone : segments ? Normalize::kImagenet : Normalize::kUnit;
  if (s.channels == Channels::kAuto) s.channels = yolox ? Channels::kBgr : Channels::kRgb;
}

/// Whether a network whose output looks like `seen` may have the head that the user named.
bool may_be(Head named, Head seen, bool darknet) {
  if ((named == Head::kDarknet) != darknet) return false;
  const bool one_per_cell = seen == Head::kYolox || seen == Head::kYoloxDecoded;
  return !(named == Head::kYolov5 && one_per_cell);
}

ClassNames names_of(const DetectorSpec& spec, const NetworkFiles& files) {
  if (!spec.classes.empty()) return load_class_names(spec.classes);
  if (files.is_darknet) return coco80();
  const auto metadata = onnx_metadata(files.network);
  const auto stated = metadata.find("names");
  if (stated == metadata.end()) return coco80();
  auto names = read_class_names(stated->second);
  if (!names)
    refuse_network(
        spec.network,
        fmt::format(
            "its metadata's `names` is not a list of classes: '{}'; name them with `classes`",
            printable(stated->second)));
  return *std::move(names);
}

/// @param classes  number of classes in its output
[[noreturn]] void refuse_class_count(const DetectorSpec& spec, const NetworkFiles& files,
                                     const ImportedNetwork& imported, int classes, Head seen) {
  const std::string named = counted(imported.names.size(), "class", "classes");
  if (!spec.classes.empty())
    refuse_network(spec.classes,
                   fmt::format("names {}, and {} has {}", named, spec.network.string(), classes));
  const bool own = !files.is_darknet && onnx_metadata(files.network).contains("names");
  const Head head = imported.settings.head;
  const std::string other =
      seen == Head::kAuto || seen == head
          ? ""
          : fmt::format("; or leave out `head: {}`, since its output looks like that of '{}'",
                        SettingsWriter::word_of(head), SettingsWriter::word_of(seen));
  refuse_network(
      spec.network,
      own ? fmt::format("has {} classes, and its metadata names {}: name them with `classes`, a "
                        "file of one name per line{}",
                        classes, imported.names.size(), other)
          : fmt::format(
                "has {} classes, not COCO's 80: name them with `classes`, a file of one name "
                "per line{}",
                classes, other));
}

/// Sets the head, from the settings or from the output for a gray image, and checks the number of
/// classes.
void understand(const DetectorSpec& spec, const NetworkFiles& files, ImportedNetwork& imported) {
  const std::vector<int> shape = {1, 3, imported.input.height, imported.input.width};
  const cv::Mat gray(shape, CV_32F, cv::Scalar::all(0.5));
  const NetworkOutputs out = run_network(spec.network, imported, gray);
  std::vector<std::string> shapes;
  for (const Tensor& tensor : out.tensors) shapes.push_back(shape_text(tensor));
  const Head seen = recognize_head(out.tensors, imported.input, files.is_darknet);
  const Head head = spec.settings.head != Head::kAuto ? spec.settings.head : seen;
  if (head != Head::kAuto && !may_be(head, seen, files.is_darknet))
    refuse_network(
        spec.network,
        fmt::format(
            "its output ({}) is not that of head '{}'{}", fmt::join(shapes, ", "),
            SettingsWriter::word_of(head),
            seen == Head::kAuto ? "" : fmt::format(" but of '{}'", SettingsWriter::word_of(seen))));
  if (head == Head::kAuto && gives_boxes_and_masks(out.tensors, imported.input))
    refuse_network(spec.network, fmt::format("gives boxes and masks of objects ({}), which are not "
                                             "supported: export a network for the task detect",
                                             fmt::join(shapes, ", ")));
  if (head == Head::kAuto)
    refuse_network(
        spec.network,
        fmt::format("its output ({}) at an input of {} x {} matches no known head: name it with "
                    "`head`, or set its input with `width_px` and `height_px`",
                    fmt::join(shapes, ", "), imported.input.width, imported.input.height));
  const int classes = class_count(head, out.tensors, imported.input);
  if (classes == 0)
    refuse_network(spec.network,
                   fmt::format("its output ({}) is not that of head '{}'", fmt::join(shapes, ", "),
                               SettingsWriter::word_of(head)));
  resolve_auto(imported.settings, head);
  imported.names = names_of(spec, files);
  if (imported.names.size() != static_cast<std::size_t>(classes))
    refuse_class_count(spec, files, imported, classes, seen);
}

/// The input size given in the network's own file; 0 if it is dynamic.
InputSize stated_input(const DetectorSpec& spec, const NetworkFiles& files) {
  const fs::path& file = spec.network;
  if (files.is_darknet) return darknet_input(files.config, spec.config);
  const OnnxInput input = onnx_input(files.network).value_or(OnnxInput{});
  if (input.images > 1)
    refuse_network(
        file, fmt::format("takes {} images at once: export it with a batch of 1", input.images));
  if (std::max(input.width, input.height) > std::uint64_t{kLargestInput_px})
    refuse_network(file,
                   fmt::format("its input is fixed to {} x {}: at most {} pixels are supported",
                               input.width, input.height, kLargestInput_px));
  return {static_cast<int>(input.width), static_cast<int>(input.height)};
}

/// The image size in Ultralytics' metadata ("[height, width]"), else 640.
InputSize trained_size(const NetworkFiles& files) {
  constexpr int kUsual_px = 640;
  const auto metadata = onnx_metadata(files.network);
  const auto stated = metadata.find("imgsz");
  InputSize size;
  char end = 0;
  if (stated != metadata.end() &&
      std::sscanf(stated->second.c_str(), "[%d, %d%c", &size.height, &size.width, &end) == 3 &&
      end == ']' && std::min(size.width, size.height) > 0 &&
      std::max(size.width, size.height) <= kLargestInput_px)
    return size;
  return {kUsual_px, kUsual_px};
}

/// @throws InputError if Ultralytics' metadata names a task whose output is not boxes.
void require_detection(const DetectorSpec& spec, const NetworkFiles& files) {
  if (files.is_darknet) return;
  const auto metadata = onnx_metadata(files.network);
  const auto task = metadata.find("task");
  constexpr std::array kOthers = {"segment", "pose", "obb", "classify"};
  if (task == metadata.end() || std::ranges::find(kOthers, task->second) == kOthers.end()) return;
  refuse_network(
      spec.network,
      fmt::format(
          "is for the task '{}': only Ultralytics networks for the task detect are supported",
          task->second));
}

/// Advice for the user: what is missing, or how to export a network that runs.
std::string export_advice(const NetworkFiles& files) {
  const auto graph = read_onnx_graph(files.network);
  for (const OnnxNode& node : graph ? graph->nodes : std::vector<OnnxNode>{})
    if (node.op == "TopK" || node.op == "NonMaxSuppression" || node.op.find("NMS") != node.op.npos)
      return fmt::format(
          "; it selects its boxes itself ([{}]): export it without (nms=False end2end=False)",
          node.op);
  return "; export an Ultralytics YOLO with `yolo export format=onnx opset=12 simplify=True`";
}

/// The size of the input: from the settings or the file, otherwise the usual one.
InputSize input_size(const DetectorSpec& spec, const NetworkFiles& files) {
  const InputSize declared = stated_input(spec, files);
  const InputSize usual = files.is_darknet ? InputSize{} : trained_size(files);
  const auto side = [&](int named, int stated, int otherwise, const char* key) {
    if (named > 0 && stated > 0 && named != stated && !files.is_darknet)
      refuse_network(spec.network,
                     fmt::format("its input is fixed to {} x {}: `{}: {}` does not fit",
                                 declared.width, declared.height, key, named));
    if (files.is_darknet && named <= 0 && stated <= 0)
      refuse_network(spec.config, fmt::format("section [net] has no {}: set it with `{}`",
                                              key[0] == 'w' ? "width" : "height", key));
    return named > 0 ? named : stated > 0 ? stated : otherwise;
  };
  return {side(spec.settings.width_px, declared.width, usual.width, "width_px"),
          side(spec.settings.height_px, declared.height, usual.height, "height_px")};
}

/// @param onnx the network; not used for Darknet
ImportedNetwork import_as(const DetectorSpec& spec, const NetworkFiles& files,
                          const std::string& onnx) {
  ImportedNetwork imported{.net = {},
                           .outputs = {},
                           .input = input_size(spec, files),
                           .settings = spec.settings,
                           .names = {}};
  imported.net = with_opencv(files.is_darknet ? spec.config : spec.network, "import", [&] {
    return files.is_darknet
               ? cv::dnn::readNetFromDarknet(files.config.data(), files.config.size(),
                                             files.network.data(), files.network.size())
               : cv::dnn::readNetFromONNX(onnx.data(), onnx.size());
  });
  if (imported.net.empty()) refuse_network(spec.network, "holds no network");
  if (files.is_darknet) check_weights(spec, imported.net, files.network);
  imported.net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  imported.net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  imported.outputs = imported.net.getUnconnectedOutLayersNames();
  understand(spec, files, imported);
  return imported;
}

}  // namespace

void refuse_network(const fs::path& file, const std::string& why) {
  throw InputError(fmt::format("{}: {}", file.string(), why));
}

NetworkFiles read_network_files(const DetectorSpec& spec) {
  NetworkFiles files;
  files.is_darknet = !spec.config.empty();
  if (files.is_darknet && spec.network.extension() == ".onnx")
    refuse_network(spec.network,
                   fmt::format("is ONNX, which takes no `config` ({})", spec.config.string()));
  if (files.is_darknet) files.config = read_text(spec.config);
  files.network = read_file(spec.network);
  if (files.network.size() > std::size_t{std::numeric_limits<int>::max()})
    refuse_network(spec.network, "is larger than 2 GB");
  if (files.network.empty()) refuse_network(spec.network, "is empty");
  if (files.is_darknet && files.network.size() < 20)
    refuse_network(spec.network, "is too short for weights of Darknet");
  return files;
}

NetworkOutputs run_network(const fs::path& file, ImportedNetwork& imported, const cv::Mat& input) {
  NetworkOutputs out = with_opencv(file, "run", [&] { return forward(imported, input); });
  check_numbers(file, out);
  return out;
}

ImportedNetwork import_network(const DetectorSpec& spec, const NetworkFiles& files) {
  require_detection(spec, files);
  const InputSize input =
      input_size(spec, files);  // checked before OpenCV trusts the size that the file states
  if (files.is_darknet) return import_as(spec, files, "");
  if (const std::string fault = onnx_weights_fault(files.network); !fault.empty())
    refuse_network(spec.network, fault);
  try {
    return import_as(spec, files, files.network);
  } catch (const NotRun& as_it_is) {
    const auto rewritten = rewrite_onnx(files.network, input);
    if (!rewritten) throw;
    try {
      return import_as(spec, files, *rewritten);
    } catch (const NotRun& error) {
      throw InputError(error.what() + export_advice(files));
    }
  }
}

}  // namespace mh
