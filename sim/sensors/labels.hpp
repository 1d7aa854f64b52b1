// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sim/render/renderer.hpp"
#include "sim/sensors/class_sets.hpp"
#include "slam/core/random.hpp"
#include "slam/io/setting.hpp"

namespace mh {

/// The origin of a frame's labels. kExact: one-hot class per pixel, matching the color image: with
/// a rolling shutter, labels are read out row by row, too (Shutter). Each visible object is a
/// detection of its own (an entry of the palette), as in a perfect panoptic segmentation.
/// kAnnotated: the same at a single instant, the stamp, as if a labeled mesh were rendered at the
/// frame's pose (ScanNet's labels are made this way). kBoxes: the bounding box of the visible
/// pixels of each instance of a COCO class is filled with its class; everything else is background.
/// kDetector: those boxes as a network would draw them, see DetectorConfig. kNone: no labels.
/// kRecorded: the labels of a recording; no simulated frame has them.
enum class LabelMode { kNone, kExact, kAnnotated, kBoxes, kDetector, kRecorded };

/// Whether each pixel has the class of the surface seen there, not that of a box.
inline bool is_per_pixel(LabelMode mode) {
  return mode == LabelMode::kExact || mode == LabelMode::kAnnotated;
}

/// A detector finds an object only if it shows at least this many pixels.
inline constexpr int kMinBoxPixels = 100;

/// COCO's size classes (Lin et al., ECCV 2014): by visible pixels.
inline constexpr int kMediumPixels = 32 * 32, kLargePixels = 96 * 96;

/// A YOLOv3-like detector. Sources: [A] Redmon and Farhadi, "YOLOv3: an incremental improvement",
/// arXiv 1804.02767, table 3 (608 px, COCO test-dev): AP 33.0, AP50 57.9, AP75 34.4, and by size
/// 18.3, 35.4, 41.9. [B] AlexeyAB/darknet issue 6670, the original weights at confidence 0.25 on
/// COCO val2017: 9571 true and 4112 false detections of its first four classes, so a precision of
/// 0.70. [C] Redmon et al., "You only look once", CVPR 2016, figure 4: of a YOLO's false
/// detections, 55 % are badly placed, 31 % of the wrong class, 14 % on background.
struct DetectorConfig {
  // Recall at IoU 0.5 by size: [A] AP by size times AP50 / AP. AP50 approximates the recall at the
  // operating point; the recall of all guesses is higher (0.41, 0.75, 0.97 from the AR in
  // ultralytics/yolov3 issue 9).
  double recall_small = 0.321, recall_medium = 0.621, recall_large = 0.735;
  /// Share of an object's detections with the wrong class: 31 % of the 30 % that are false [B, C],
  /// relative to all detections of objects.
  double confusion = 0.097;
  /// Expected false detections where there is no object, per image: 14 % of the 30 % that are
  /// false, relative to the 4.3 correct ones per image, from 36,781 / 5,000 objects at a recall of
  /// 0.58 [A, B, C].
  double false_alarms = 0.26;
  /// Standard deviation of the error of each side of a box, as a share of the box's width or
  /// height: chosen so that 34.4 / 57.9 of the boxes with an IoU above 0.5 have an IoU above 0.75
  /// [A].
  double box_sigma = 0.087;
  friend bool operator==(const DetectorConfig&, const DetectorConfig&) = default;
};

template <MaybeConst<DetectorConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [recall_small, recall_medium, recall_large, confusion, false_alarms, box_sigma] = c;
  v("recall_small", recall_small, setting::kShare, "of objects below 32 x 32 px");
  v("recall_medium", recall_medium, setting::kShare, "of objects in between");
  v("recall_large", recall_large, setting::kShare, "of objects of 96 x 96 px or more");
  v("confusion", confusion, setting::kShare,
    "share of an object's detections with the wrong class");
  v("false_alarms", false_alarms, {0, 8}, "expected detections per image where there is no object");
  v("box_sigma", box_sigma, setting::kShare,
    "standard deviation of the error of a box's sides, as a share of its width or height");
}

/// Configurable faults on top of any kind of labels, for dose-response studies: 0 is none.
struct LabelNoiseConfig {
  bool enabled = false;
  double confusion = 0.0;  ///< share of instances that carry a wrong class
  double swap = 0.0;       ///< share of instances that start an exchange of classes with their
                           ///< nearest neighbor in the image
  double dropout = 0.0;    ///< share of instances that carry no label (or no box)
  int erosion_px = 0;      ///< pixels within this many px of a border between labels become void
  ClassSet class_set = ClassSet::kAll;
  /// Whether labels are left unchanged.
  bool none() const {
    return !enabled || (confusion == 0 && swap == 0 && dropout == 0 && erosion_px == 0 &&
                        class_set == ClassSet::kAll);
  }
  friend bool operator==(const LabelNoiseConfig&, const LabelNoiseConfig&) = default;
};

template <MaybeConst<LabelNoiseConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [enabled, confusion, swap, dropout, erosion_px, class_set] = c;
  v("enabled", enabled, setting::kSwitch,
    "switches the five dials below; the settings after them always apply");
  v("confusion", confusion, setting::kShare, "share of instances that carry a wrong class");
  v("swap", swap, setting::kShare,
    "share of instances that exchange classes with their nearest neighbor");
  v("dropout", dropout, setting::kShare, "share of instances that carry no label");
  v("erosion_px", erosion_px, {0, 1000}, "pixels this near to a border between labels become void");
  v("class_set", class_set, {}, "classes that are told apart: all, thirteen, five or two");
}

/// Label faults depend on what is seen and from where, as a network's do: each is decided by a
/// standard normal number, the sum of three parts. One is constant for an instance, one changes
/// smoothly with the view (over about 1 m and 30 degrees; equal for equal views, whenever they
/// occur), and one is drawn again in each frame. The shares of the three parts are our choice,
/// since no published data give them.
struct LabelConfig {
  LabelNoiseConfig noise = {};
  DetectorConfig detector = {};
  double persistent_share = 0.4;  ///< share of the variance, 0 to 1
  double frame_share = 0.1;       ///< as above; sum at most 1, the rest depends on the view
  std::uint64_t seed = 0;         ///< a different seed acts as a different network
  friend bool operator==(const LabelConfig&, const LabelConfig&) = default;
};

template <MaybeConst<LabelConfig> C, class Visit>
void for_each_setting(C& config, Visit& v) {
  auto& [noise, detector, persistent_share, frame_share, seed] = config;
  v.section("label_noise");
  fields(noise, v);
  v("persistent_share", persistent_share, setting::kShare,
    "share of the faults' variance that is constant for an instance");
  v("frame_share", frame_share, setting::kShare,
    "share that is drawn again in each frame; the two sum to at most 1, the rest depends on the "
    "view");
  v("seed", seed, setting::kSeed, "a different seed acts as a different network");
  v.section("detector");
  fields(detector, v);
}

/// Labels without faults; kDetector gives those of kBoxes. kNone: an empty image. Smaller boxes
/// cover larger ones; among equally large boxes, those of higher instance ids cover the others.
SemanticImage label_image(const RenderedFrame& truth, LabelMode mode);

/// Labels with the faults of `config`.
/// @param world_from_camera  the view that faults depend on
/// @param stream             random stream of this frame, for what is drawn in each frame
SemanticImage label_image(const RenderedFrame& truth, LabelMode mode, const LabelConfig& config,
                          const SE3& world_from_camera, RandomStream stream);

/// One box of a detector; its bounds are inclusive.
struct Detection {
  int left = 0, top = 0, right = 0, bottom = 0;
  ClassDistribution classes;
  InstanceId instance = 0;  ///< what it was drawn around; never passed to SLAM
};

/// Detections of a detector with these faults, in painting order.
std::vector<Detection> detect(const RenderedFrame& truth, const LabelConfig& config,
                              const SE3& world_from_camera, RandomStream stream);

}  // namespace mh
