// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "bench/protocol/metrics/average_precision.hpp"
#include "sim/sensors/labels.hpp"
#include "sim/sensors/visible_objects.hpp"
#include "slam/detect/detected.hpp"

namespace mh {

/// What became of an object or a detection, at the detector's own threshold. `truth` is void for a
/// false detection (no object), and `found` is void for an object that was missed. A detection
/// belongs to the unassigned object that it overlaps most, by at least 0.5; objects of the
/// detection's own class take precedence.
struct Outcome {
  ClassId truth = kVoid, found = kVoid;
  friend auto operator<=>(const Outcome&, const Outcome&) = default;
};

/// Scores of a class that is both ours and COCO's.
struct ClassScore {
  ClassId class_id = kVoid;
  AveragePrecision precision;
  std::size_t objects = 0, right = 0, wrong_class = 0;  ///< at the detector's own threshold
};

/// How well labels made from boxes agree with the exact classes of the pixels.
struct LabelScore {
  double right_share = 0;  ///< share of the labeled pixels whose label is right
  double found_share = 0;  ///< share of the pixels of COCO's objects with the right label
};

struct DetectorScore {
  std::size_t images = 0;
  std::vector<ClassScore> classes;  ///< classes that occur, by id
  /// Means over the classes that occur; the mean of a size is over the classes that occur in that
  /// size.
  AveragePrecision mean;
  std::map<Outcome, std::size_t> outcomes;
  /// Number of false alarms, by their class and by the most frequent class among the pixels of
  /// their box.
  std::map<std::pair<ClassId, ClassId>, std::size_t> false_alarms;
  /// Detections, not counted as false alarms, that overlap an object of their class by 0.1 to 0.5.
  std::size_t badly_placed = 0;
  DetectorConfig dials;        ///< settings to simulate this detector; NaN if not measured
  LabelScore box, foreground;  ///< one for each BoxFill; NaN if not measured
};

/// Returns `dials` with the settings that were measured (see DetectorScore::dials) replaced.
DetectorConfig with_measured(DetectorConfig dials, const DetectorConfig& measured);

/// Judges a detector against exact images. Objects are the visible parts of instances of COCO's
/// classes; objects with fewer than kMinBoxPixels pixels are ignored.
class DetectorJudge {
 public:
  /// @param confidence  least score for a box to count; average precision uses boxes of all scores
  explicit DetectorJudge(double confidence) : confidence_(confidence) {}

  /// @param found    boxes in pixels of the exact image, best first
  /// @param depth_m  the sensed depth, from which labels are made; may be empty
  /// @returns the objects that were missed
  std::vector<VisibleObject> add(const RenderedFrame& exact, const std::vector<DetectedBox>& found,
                                 const Grid2d<float>& depth_m = {});
  DetectorScore score() const;

 private:
  void add_precision(const std::vector<VisibleObject>& objects,
                     const std::vector<DetectedBox>& found);
  std::vector<VisibleObject> add_outcomes(const RenderedFrame& exact,
                                          const std::vector<VisibleObject>& objects,
                                          const std::vector<DetectedBox>& found);
  void add_labels(const RenderedFrame& exact, const std::vector<DetectedBox>& found,
                  const Grid2d<float>& depth_m);

  struct BoxesOfClass {
    std::vector<TruthBox> truths;
    std::vector<ScoredBox> found;
  };
  struct Pixels {
    std::size_t labeled = 0, right = 0, of_objects = 0;
  };
  double confidence_;
  std::size_t images_ = 0, badly_placed_ = 0;
  std::map<ClassId, BoxesOfClass> boxes_;
  std::map<Outcome, std::size_t> outcomes_;
  std::map<std::pair<ClassId, ClassId>, std::size_t> false_alarms_;
  std::size_t of_size_[3] = {}, found_of_size_[3] = {};
  double squared_strays_ = 0;
  std::size_t sides_ = 0;
  Pixels box_, foreground_;
};

/// The boxes of the simulated detector, in the form in which a real detector returns them.
std::vector<DetectedBox> as_detected(const std::vector<Detection>& detections);

}  // namespace mh
