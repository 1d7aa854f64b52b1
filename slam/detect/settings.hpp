// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "slam/io/setting.hpp"
#include "slam/io/words.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// What a network's output means.
enum class Head { kAuto, kYolox, kYoloxDecoded, kYolov5, kYolov8, kDarknet, kSegmentation };
constexpr Names<Head, 7> words(Head) {
  return {{{"auto", Head::kAuto},
           {"yolox", Head::kYolox},
           {"yolox_decoded", Head::kYoloxDecoded},
           {"yolov5", Head::kYolov5},
           {"yolov8", Head::kYolov8},
           {"darknet", Head::kDarknet},
           {"segmentation", Head::kSegmentation}}};
}

/// How an image is fitted to the network's input size.
enum class Letterbox { kAuto, kCorner, kCenter, kStretch };
constexpr Names<Letterbox, 4> words(Letterbox) {
  return {{{"auto", Letterbox::kAuto},
           {"corner", Letterbox::kCorner},
           {"center", Letterbox::kCenter},
           {"stretch", Letterbox::kStretch}}};
}

/// How a channel of 0 to 255 is normalized.
enum class Normalize { kAuto, kNone, kUnit, kImagenet };
constexpr Names<Normalize, 4> words(Normalize) {
  return {{{"auto", Normalize::kAuto},
           {"none", Normalize::kNone},
           {"unit", Normalize::kUnit},
           {"imagenet", Normalize::kImagenet}}};
}

enum class Channels { kAuto, kBgr, kRgb };
constexpr Names<Channels, 3> words(Channels) {
  return {{{"auto", Channels::kAuto}, {"bgr", Channels::kBgr}, {"rgb", Channels::kRgb}}};
}

/// Which pixels of a box get its label: all of them, or those of its foreground surface.
enum class BoxFill { kBox, kForeground };
constexpr Names<BoxFill, 2> words(BoxFill) {
  return {{{"box", BoxFill::kBox}, {"foreground", BoxFill::kForeground}}};
}

struct DetectorSettings {
  Head head = Head::kAuto;
  Letterbox letterbox = Letterbox::kAuto;
  int padding = 114;
  Normalize normalize = Normalize::kAuto;
  Channels channels = Channels::kAuto;
  int width_px = 0, height_px = 0;
  double confidence = 0.25;
  double nms = 0.45;
  int max_detections = 100;
  BoxFill fill = BoxFill::kBox;
  friend bool operator==(const DetectorSettings&, const DetectorSettings&) = default;
};

template <MaybeConst<DetectorSettings> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [head, letterbox, padding, normalize, channels, width_px, height_px, confidence, nms,
         max_detections, fill] = c;
  v("head", head, {}, "format of the output; auto: from its shape");
  v("letterbox", letterbox, {},
    "where the scaled image is placed in the input, or stretch to fill it; auto: corner for yolox, "
    "stretch for segmentation, otherwise center");
  v("padding", padding, {0, 255}, "gray level around the image");
  v("normalize", normalize, {},
    "of values 0 to 255: none, unit (to 0 to 1), imagenet (by its mean and standard deviation); "
    "auto: none for yolox, imagenet for segmentation, otherwise unit");
  v("channels", channels, {}, "auto: bgr for yolox, otherwise rgb");
  v("width_px", width_px, {0, 8192}, "of the input; 0: as the network declares, otherwise 640");
  v("height_px", height_px, {0, 8192}, "of the input; 0: as the network declares, otherwise 640");
  v("confidence", confidence, setting::kShare,
    "minimum score of a box, or of a pixel's class if the network segments");
  v("nms", nms, setting::kShare,
    "a box is dropped if it overlaps a better one of its class by more than this (intersection "
    "over union)");
  v("max_detections", max_detections, {1, 250}, "per image; the best are kept");
  v("fill", fill, {},
    "pixels that get a box's label: box (all), foreground (those of its surface, by depth)");
}

/// A real detector, as suites and the command line specify it: a network with its settings, or
/// boxes that another program found.
struct DetectorSpec {
  std::filesystem::path network;  ///< ONNX, or Darknet's weights; empty: boxes
  std::filesystem::path config;   ///< Darknet's .cfg
  std::filesystem::path classes;  ///< names, one per line; empty: the network's, or COCO's 80
  std::filesystem::path boxes;    ///< COCO JSON, MOT CSV, folder of YOLO text; empty: a network
  DetectorSettings settings;
  friend bool operator==(const DetectorSpec&, const DetectorSpec&) = default;
};

template <MaybeConst<DetectorSpec> D, class Visit>
void fields(D& spec, Visit& v) {
  auto& [network, config, classes, boxes, settings] = spec;
  v("network", network);
  v("config", config);
  v("classes", classes);
  v("boxes", boxes);
  v("settings", settings);
}

/// Specifies a network or boxes, depending on a file's extension. Darknet's weights must have their
/// .cfg next to them. @throws InputError if the extension is unknown.
DetectorSpec detector_from_file(const std::filesystem::path& file);

/// Reads the settings in a mapping into a spec, and its paths `network`, `config`, `classes` and
/// `boxes`, relative to `folder`. Does not finish() the mapping.
void read_detector(YamlReader& mapping, const std::filesystem::path& folder, DetectorSpec& spec);

/// Reads a file with the same keys as the mapping of read_detector(). @throws InputError naming
/// file, line and value.
void load_detector_settings(const std::filesystem::path& file, DetectorSpec& spec);

/// The text of a settings file with every setting; with notes, each with its meaning.
std::string format_detector_settings(const DetectorSettings& settings, bool notes);

}  // namespace mh
