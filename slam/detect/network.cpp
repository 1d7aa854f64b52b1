// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>

#include "slam/core/counted.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/guarded_child.hpp"
#include "slam/core/settings_io.hpp"
#include "slam/core/text_file.hpp"
#include "slam/detect/darknet_config.hpp"
#include "slam/detect/detector.hpp"
#include "slam/detect/fit_image.hpp"
#include "slam/detect/heads.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr int kUsualInput_px = 640;
constexpr int kLargestInput_px = 8192;

/// OpenCV's importers write what they think to stderr; what matters is in their exceptions.
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

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw InputError(fmt::format("{}: {}", file.string(), why));
}

/// Runs OpenCV on a file. @throws InputError with its reason.
template <class Work>
auto with_opencv(const fs::path& file, const char* what, const Work& work) {
  const Quiet quiet;
  try {
    return work();
  } catch (const cv::Exception& error) {
    refuse(file, fmt::format("OpenCV {} cannot {} it: {}", CV_VERSION, what, reason(error)));
  }
}

/// Checks that Darknet's weights are as many as the layers take, which OpenCV does not: it would
/// read beyond their end.
void check_weights(const DetectorSpec& spec, cv::dnn::Net& net, std::string_view weights) {
  std::uint64_t values = 0;
  for (const cv::String& name : net.getLayerNames()) {
    const cv::Ptr<cv::dnn::Layer> layer = net.getLayer(net.getLayerId(name));
    if (layer->type == "Region") continue;  // anchors, of the configuration
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
        refuse(spec.network, fmt::format("weight {} of {} is not a finite number", i + 1, values));
    }
    return;
  }
  refuse(spec.network, fmt::format("holds {} bytes where {} asks for {}: {}", weights.size(),
                                   spec.config.string(), expected,
                                   weights.size() < expected ? "it is truncated, or of another one"
                                                             : "it is of another one"));
}

/// A network's files, read once.
struct NetworkFiles {
  std::string network, config;
  bool is_darknet = false;
};

NetworkFiles read_files(const DetectorSpec& spec) {
  NetworkFiles files;
  files.is_darknet = !spec.config.empty();
  if (files.is_darknet && spec.network.extension() == ".onnx")
    refuse(spec.network,
           fmt::format("is ONNX, which takes no `config` ({})", spec.config.string()));
  if (files.is_darknet) files.config = read_text(spec.config);
  files.network = read_file(spec.network);
  if (files.network.size() > std::size_t{std::numeric_limits<int>::max()})
    refuse(spec.network, "is larger than 2 GB");
  if (files.network.empty()) refuse(spec.network, "is empty");
  if (files.is_darknet && files.network.size() < 20)
    refuse(spec.network, "is too short for weights of Darknet");
  return files;
}

/// An imported network, and how its input and output are to be understood.
struct Imported {
  cv::dnn::Net net;
  std::vector<cv::String> outputs;
  InputSize input;
  DetectorSettings settings;  ///< without any kAuto
  ClassNames names;
};

/// Outputs of one run; the tensors view the matrices.
struct Outputs {
  std::vector<cv::Mat> mats;
  std::vector<Tensor> tensors;
};

Outputs forward(Imported& imported, const cv::Mat& input) {
  Outputs out;
  imported.net.setInput(input);
  imported.net.forward(out.mats, imported.outputs);
  for (cv::Mat& mat : out.mats) {
    if (mat.depth() != CV_32F) mat.convertTo(mat, CV_32F);
    if (!mat.isContinuous()) mat = mat.clone();
    out.tensors.push_back({{mat.size.p, mat.size.p + mat.dims}, {mat.ptr<float>(), mat.total()}});
  }
  return out;
}

/// @throws InputError if an output holds NaN or nothing finite: the weights are damaged.
void check_numbers(const fs::path& file, const Outputs& out) {
  for (const Tensor& tensor : out.tensors) {
    const auto bad = std::ranges::find_if(tensor.values, [](float v) { return std::isnan(v); });
    if (bad != tensor.values.end())
      refuse(file, fmt::format("gives a value that is not a number (value {} of {})",
                               bad - tensor.values.begin() + 1, tensor.values.size()));
    if (std::ranges::none_of(tensor.values, [](float v) { return std::isfinite(v); }))
      refuse(file, fmt::format("gives {} values, none of which is finite", tensor.values.size()));
  }
}

/// Runs the network on an input and checks what it gives. @throws InputError
Outputs run(const fs::path& file, Imported& imported, const cv::Mat& input) {
  Outputs out = with_opencv(file, "run", [&] { return forward(imported, input); });
  check_numbers(file, out);
  return out;
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

/// Whether a head that the user names can be that of a network that looks like `seen`.
bool may_be(Head named, Head seen, bool darknet) {
  if ((named == Head::kDarknet) != darknet) return false;
  const bool one_per_cell = seen == Head::kYolox || seen == Head::kYoloxDecoded;
  return !(named == Head::kYolov5 && one_per_cell);
}

/// The head by name or by what a gray image gives, and the classes that it must have.
void understand(const DetectorSpec& spec, const NetworkFiles& files, Imported& imported) {
  const std::vector<int> shape = {1, 3, imported.input.height, imported.input.width};
  const cv::Mat gray(shape, CV_32F, cv::Scalar::all(0.5));
  const Outputs out = run(spec.network, imported, gray);
  std::vector<std::string> shapes;
  for (const Tensor& tensor : out.tensors) shapes.push_back(shape_text(tensor));
  const Head seen = recognize_head(out.tensors, imported.input, files.is_darknet);
  const Head head = spec.settings.head != Head::kAuto ? spec.settings.head : seen;
  if (head != Head::kAuto && !may_be(head, seen, files.is_darknet))
    refuse(
        spec.network,
        fmt::format(
            "its output ({}) is not that of head '{}'{}", fmt::join(shapes, ", "),
            SettingsWriter::word_of(head),
            seen == Head::kAuto ? "" : fmt::format(" but of '{}'", SettingsWriter::word_of(seen))));
  if (head == Head::kAuto)
    refuse(
        spec.network,
        fmt::format("its output ({}) at an input of {} x {} is that of no known head: name it by "
                    "`head`, or its input by `width_px` and `height_px`",
                    fmt::join(shapes, ", "), imported.input.width, imported.input.height));
  const int classes = class_count(head, out.tensors, imported.input);
  if (classes == 0)
    refuse(spec.network, fmt::format("its output ({}) is not that of head '{}'",
                                     fmt::join(shapes, ", "), SettingsWriter::word_of(head)));
  resolve_auto(imported.settings, head);
  imported.names = spec.classes.empty() ? coco80() : load_class_names(spec.classes);
  if (imported.names.size() == static_cast<std::size_t>(classes)) return;
  if (spec.classes.empty())
    refuse(spec.network,
           fmt::format(
               "has {} classes, not COCO's 80: name them by `classes`, a file of one name "
               "per line{}",
               classes,
               seen == Head::kAuto || seen == head
                   ? ""
                   : fmt::format("; or leave out `head: {}`, since its output looks like "
                                 "that of '{}'",
                                 SettingsWriter::word_of(head), SettingsWriter::word_of(seen))));
  refuse(spec.classes,
         fmt::format("names {}, and {} has {}", counted(imported.names.size(), "class", "classes"),
                     spec.network.string(), classes));
}

/// The size of the images that the network's own file states; 0 where it leaves it open.
InputSize stated_input(const DetectorSpec& spec, const NetworkFiles& files) {
  const fs::path& file = spec.network;
  if (files.is_darknet) return darknet_input(files.config, spec.config);
  const OnnxInput input = onnx_input(files.network).value_or(OnnxInput{});
  if (input.images > 1)
    refuse(file, fmt::format("takes {} images at once: export it with a batch of 1", input.images));
  if (std::max(input.width, input.height) > std::uint64_t{kLargestInput_px})
    refuse(file, fmt::format("its input is fixed to {} x {}: at most {} pixels are taken",
                             input.width, input.height, kLargestInput_px));
  return {static_cast<int>(input.width), static_cast<int>(input.height)};
}

Imported import(const DetectorSpec& spec, const NetworkFiles& files) {
  Imported imported{.net = {}, .outputs = {}, .input = {}, .settings = spec.settings, .names = {}};
  const InputSize declared = stated_input(spec, files);  // before OpenCV trusts what it states
  imported.net = with_opencv(files.is_darknet ? spec.config : spec.network, "import", [&] {
    return files.is_darknet
               ? cv::dnn::readNetFromDarknet(files.config.data(), files.config.size(),
                                             files.network.data(), files.network.size())
               : cv::dnn::readNetFromONNX(files.network.data(), files.network.size());
  });
  if (imported.net.empty()) refuse(spec.network, "holds no network");
  if (!files.is_darknet)
    if (const std::string fault = onnx_weights_fault(files.network); !fault.empty())
      refuse(spec.network, fault);
  if (files.is_darknet) check_weights(spec, imported.net, files.network);
  imported.net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  imported.net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  imported.outputs = imported.net.getUnconnectedOutLayersNames();
  const auto side = [&](int named, int stated, const char* key) {
    if (named > 0 && stated > 0 && named != stated && !files.is_darknet)
      refuse(spec.network, fmt::format("its input is fixed to {} x {}: `{}: {}` cannot be",
                                       declared.width, declared.height, key, named));
    if (files.is_darknet && named <= 0 && stated <= 0)
      refuse(spec.config, fmt::format("section [net] states no {}: name it by `{}`",
                                      key[0] == 'w' ? "width" : "height", key));
    return named > 0 ? named : stated > 0 ? stated : kUsualInput_px;
  };
  imported.input = {side(spec.settings.width_px, declared.width, "width_px"),
                    side(spec.settings.height_px, declared.height, "height_px")};
  understand(spec, files, imported);
  return imported;
}

/// Imports and runs the network once where a crash does no harm.
void try_in_child(const DetectorSpec& spec, const NetworkFiles& files) {
  if (reads_here()) return;
  constexpr std::uint64_t kMemoryPerByte = 20;
  const GuardLimits limits{
      .processor_s = 30 + static_cast<int>(files.network.size() >> 22),
      .memory_bytes = (std::uint64_t{4} << 30) + kMemoryPerByte * files.network.size()};
  in_child(
      files.is_darknet ? spec.config : spec.network, limits,
      [&]() -> std::function<void(PipeWriter&)> {
        import(spec, files);
        return [](PipeWriter&) {};
      },
      [](PipeReader&) {});
}

class Network : public Detector {
 public:
  explicit Network(const DetectorSpec& spec) {
    const NetworkFiles files = read_files(spec);
    cv::setNumThreads(1);
    try_in_child(spec, files);
    imported_ = import(spec, files);
    file_ = spec.network;
    digest_ = XXH3_64bits(files.network.data(), files.network.size());
    digest_ = XXH3_64bits_withSeed(files.config.data(), files.config.size(), digest_);
    std::string decides = fmt::format("{}", fmt::join(imported_.names.names, "\n"));
    DetectorSettings seen = imported_.settings;
    seen.fill = {};  // of the labels, which are made of the boxes anew
    decides += format_detector_settings(seen, false) +
               fmt::format("OpenCV {} input {} x {}", CV_VERSION, imported_.input.width,
                           imported_.input.height);
    digest_ = XXH3_64bits_withSeed(decides.data(), decides.size(), digest_);
  }

  std::string check_frames(std::span<const Stamp>) const override {
    return imported_.names.unknown_note(file_);
  }

  Detected detect(const Grid2d<Rgb8>& color, std::size_t, Stamp) const override {
    const DetectorSettings& settings = imported_.settings;
    const Placement at =
        place_image(color.width(), color.height(), imported_.input, settings.letterbox);
    const cv::Mat input = network_input(color, imported_.input, at, settings);
    const std::scoped_lock lock(mutex_);
    const Outputs out = run(file_, imported_, input);
    Detected found;
    if (settings.head == Head::kSegmentation) {
      for (const Tensor& tensor : out.tensors)
        if (tensor.shape.size() == 4)
          found.pixels = segmented(tensor, at, imported_.input, {color.width(), color.height()},
                                   imported_.names, settings.confidence);
    } else {
      found.boxes = select_boxes(candidates(out), at, color.width(), color.height(),
                                 imported_.names, settings);
    }
    return found;
  }
  const ClassNames& names() const override { return imported_.names; }
  std::string description() const override {
    return fmt::format("{}, {} classes, input {} x {}",
                       SettingsWriter::word_of(imported_.settings.head), imported_.names.size(),
                       imported_.input.width, imported_.input.height);
  }
  std::uint64_t digest() const override { return digest_; }

 private:
  std::vector<Candidate> candidates(const Outputs& out) const {
    const DetectorSettings& settings = imported_.settings;
    try {
      return decode(settings.head, out.tensors, imported_.input, settings.confidence);
    } catch (const InputError& error) {
      refuse(file_, error.what());
    }
  }

  mutable std::mutex mutex_;
  mutable Imported imported_;  // running a network changes its memory
  fs::path file_;
  std::uint64_t digest_ = 0;
};

}  // namespace

std::unique_ptr<Detector> open_network(const DetectorSpec& spec) {
  return std::make_unique<Network>(spec);
}

std::unique_ptr<Detector> open_detector(const DetectorSpec& spec) {
  return spec.network.empty() ? open_boxes(spec) : open_network(spec);
}

}  // namespace mh
