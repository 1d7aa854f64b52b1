// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/sensors/label_faults.hpp"
#include "sim/sensors/labels.hpp"

namespace mh {
namespace {

enum DetectorDraw : std::uint64_t {
  kFound = 11,
  kConfused = 12,
  kTakenFor = 13,
  kLeft = 14,
  kTop = 15,
  kRight = 16,
  kBottom = 17,
  kFalseAlarm = 18,
  kFalseClass = 19,
  kFalsePlace = 20
};

// False alarms come from this many independent sources, each at most once per image.
constexpr std::uint64_t kAlarms = 8;
// A class with boxes, from which wrong_class() draws a different one; person is the most frequent
// class in COCO.
constexpr ClassId kPerson = 31;
// A palette has room for 255 entries; two are taken.
constexpr std::size_t kMostDetections = 253;

double recall(const VisibleObject& object, const DetectorConfig& config) {
  if (object.pixels < kMediumPixels) return config.recall_small;
  return object.pixels < kLargePixels ? config.recall_medium : config.recall_large;
}

/// A box with displaced sides, within the image and at least one pixel large.
Detection place(const VisibleObject& object, const DetectorConfig& config, const FaultDraws& draws,
                const RenderedFrame& truth) {
  const auto side = [&](DetectorDraw purpose, int at, int size, int limit) {
    const double stray = config.box_sigma * size * draws.normal(purpose, object.instance);
    return std::clamp(at + static_cast<int>(std::lround(stray)), 0, limit - 1);
  };
  const int w = truth.classes.width(), h = truth.classes.height();
  Detection box;
  box.left = side(kLeft, object.left, object.width(), w);
  box.right = std::max(box.left, side(kRight, object.right, object.width(), w));
  box.top = side(kTop, object.top, object.height(), h);
  box.bottom = std::max(box.top, side(kBottom, object.bottom, object.height(), h));
  box.instance = object.instance;
  return box;
}

/// The class assigned to a box with a probability of at least one half, and the runner-up.
ClassDistribution two_classes(ClassId first, ClassId second, double sure) {
  const auto p = static_cast<float>(0.5 + 0.5 * sure);
  ClassDistribution classes{{{first, p}, {second, 1.0F - p}}};
  std::sort(classes.entries.begin(), classes.entries.end());
  return classes;
}

/// A box around something of a class that the detector does not have, like most false alarms on
/// background: the instance in view that ranks first for this source.
const VisibleObject* false_place(const std::vector<VisibleObject>& objects, std::uint64_t source,
                                 const FaultDraws& draws) {
  const VisibleObject* best = nullptr;
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (const VisibleObject& object : objects) {
    const std::uint64_t rank =
        draws.persistent_bits(kFalsePlace, kAlarms * object.instance + source);
    if (is_coco(object.class_id) || rank > least) continue;
    best = &object;
    least = rank;
  }
  return best;
}

}  // namespace

std::vector<Detection> detect(const RenderedFrame& truth, const LabelConfig& config,
                              const SE3& world_from_camera, RandomStream stream) {
  const DetectorConfig& detector = config.detector;
  const FaultDraws draws(config, world_from_camera, stream);
  std::vector<VisibleObject> objects = with_faults(visible_objects(truth), config.noise, draws);
  std::erase_if(objects, [](const VisibleObject& object) { return object.pixels < kMinBoxPixels; });
  sort_for_painting(objects);

  std::vector<Detection> found;
  for (std::uint64_t source = 0; source < kAlarms; ++source) {
    const double chance = std::min(1.0, detector.false_alarms / static_cast<double>(kAlarms));
    const double u = draws.uniform(kFalseAlarm, source);
    const VisibleObject* at = u < chance ? false_place(objects, source, draws) : nullptr;
    if (at == nullptr) continue;
    Detection box = place(*at, detector, draws, truth);
    const ClassId first = wrong_class(kPerson, draws.persistent_bits(kFalseClass, 2 * source));
    const ClassId second = wrong_class(first, draws.persistent_bits(kFalseClass, 2 * source + 1));
    box.classes = two_classes(first, second, 1.0 - u / chance);
    found.push_back(std::move(box));
  }
  for (const VisibleObject& object : objects) {
    if (!is_coco(object.class_id)) continue;
    const double limit = recall(object, detector), u = draws.uniform(kFound, object.instance);
    if (u >= limit) continue;
    const bool confused = draws.uniform(kConfused, object.instance) < detector.confusion;
    const ClassId other =
        wrong_class(object.class_id, draws.persistent_bits(kTakenFor, object.instance));
    Detection box = place(object, detector, draws, truth);
    box.classes = two_classes(confused ? other : object.class_id,
                              confused ? object.class_id : other, 1.0 - u / limit);
    found.push_back(std::move(box));
  }
  if (found.size() > kMostDetections) found.resize(kMostDetections);
  return found;
}

}  // namespace mh
