// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/detector_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mh {
namespace {

ImageBox image_box(const VisibleObject& object, std::size_t image) {
  return {image, static_cast<double>(object.left), static_cast<double>(object.top),
          static_cast<double>(object.width()), static_cast<double>(object.height())};
}

ImageBox image_box(const DetectedBox& box, std::size_t image) {
  return {image, box.left, box.top, double{box.right} - box.left, double{box.bottom} - box.top};
}

std::size_t size_class(const VisibleObject& object) {
  return object.pixels < kMediumPixels ? 0 : object.pixels < kLargePixels ? 1 : 2;
}

/// The most frequent class among the pixels of a box.
ClassId usual_class(const RenderedFrame& exact, const DetectedBox& box) {
  std::array<int, 256> count{};
  const int right = std::min(exact.classes.width(), static_cast<int>(std::ceil(box.right))),
            bottom = std::min(exact.classes.height(), static_cast<int>(std::ceil(box.bottom)));
  for (int y = static_cast<int>(box.top); y < bottom; ++y)
    for (int x = static_cast<int>(box.left); x < right; ++x) ++count[exact.classes(x, y)];
  return static_cast<ClassId>(std::ranges::max_element(count) - count.begin());
}

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double share(std::size_t part, std::size_t all) {
  return all == 0 ? kUnknown : static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

std::vector<VisibleObject> DetectorJudge::add(const RenderedFrame& exact,
                                              const std::vector<DetectedBox>& found,
                                              const Grid2d<float>& depth_m) {
  std::vector<VisibleObject> objects = visible_objects(exact);
  std::erase_if(objects, [](const VisibleObject& object) { return !is_coco(object.class_id); });
  add_precision(objects, found);
  std::vector<DetectedBox> sure;
  for (const DetectedBox& box : found)
    if (box.score >= confidence_) sure.push_back(box);
  if (!depth_m.empty()) add_labels(exact, sure, depth_m);
  std::vector<VisibleObject> missed = add_outcomes(exact, objects, sure);
  ++images_;
  return missed;
}

void DetectorJudge::add_precision(const std::vector<VisibleObject>& objects,
                                  const std::vector<DetectedBox>& found) {
  for (const VisibleObject& object : objects)
    boxes_[object.class_id].truths.push_back({.box = image_box(object, images_),
                                              .area = static_cast<double>(object.pixels),
                                              .ignore = object.pixels < kMinBoxPixels});
  for (const DetectedBox& box : found)
    if (const ClassId id = box.classes.most_probable(); id != kVoid)
      boxes_[id].found.push_back({image_box(box, images_), box.score});
}

std::vector<VisibleObject> DetectorJudge::add_outcomes(const RenderedFrame& exact,
                                                       const std::vector<VisibleObject>& objects,
                                                       const std::vector<DetectedBox>& found) {
  constexpr double kFound = 0.5, kBadlyPlaced = 0.1;
  std::vector<bool> taken(objects.size(), false);
  for (const DetectedBox& box : found) {
    const ClassId id = box.classes.most_probable();
    const ImageBox at = image_box(box, 0);
    std::size_t best = objects.size();
    double best_overlap = 0;
    bool near_own = false, near_small = false;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const double overlap = box_overlap(at, image_box(objects[i], 0));
      near_own = near_own || (overlap >= kBadlyPlaced && objects[i].class_id == id);
      near_small = near_small || (overlap >= kFound && objects[i].pixels < kMinBoxPixels);
      if (taken[i] || overlap < kFound || objects[i].pixels < kMinBoxPixels) continue;
      const bool own = objects[i].class_id == id;
      const bool best_is_own = best < objects.size() && objects[best].class_id == id;
      if (best < objects.size() && (best_is_own != own ? best_is_own : overlap <= best_overlap))
        continue;
      best = i;
      best_overlap = overlap;
    }
    if (best == objects.size()) {
      if (near_small) continue;
      if (near_own) {
        ++badly_placed_;
        continue;
      }
      ++outcomes_[{kVoid, id}];
      ++false_alarms_[{id, usual_class(exact, box)}];
      continue;
    }
    taken[best] = true;
    const VisibleObject& object = objects[best];
    // An object found with a class that we do not have is wrong: its class is counted as
    // background.
    ++outcomes_[{object.class_id, id == kVoid ? kBackground : id}];
    ++found_of_size_[size_class(object)];
    const ImageBox truth = image_box(object, 0);
    const std::array<double, 4> strays = {
        (at.left - truth.left) / truth.width, (at.top - truth.top) / truth.height,
        (at.left + at.width - truth.left - truth.width) / truth.width,
        (at.top + at.height - truth.top - truth.height) / truth.height};
    for (const double stray : strays) squared_strays_ += stray * stray;
    sides_ += strays.size();
  }
  std::vector<VisibleObject> missed;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].pixels < kMinBoxPixels) continue;
    ++of_size_[size_class(objects[i])];
    if (taken[i]) continue;
    ++outcomes_[{objects[i].class_id, kVoid}];
    missed.push_back(objects[i]);
  }
  return missed;
}

void DetectorJudge::add_labels(const RenderedFrame& exact, const std::vector<DetectedBox>& found,
                               const Grid2d<float>& depth_m) {
  for (const BoxFill fill : {BoxFill::kBox, BoxFill::kForeground}) {
    Pixels& pixels = fill == BoxFill::kBox ? box_ : foreground_;
    const int width = exact.classes.width(), height = exact.classes.height();
    const SemanticImage labels =
        labels_of({.boxes = found, .pixels = {}}, depth_m, width, height, fill);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const ClassId given = labels.at(x, y).most_probable(), truth = exact.classes(x, y);
        if (given != kVoid && given != kBackground) ++pixels.labeled;
        if (!is_coco(truth)) continue;
        ++pixels.of_objects;
        if (given == truth) ++pixels.right;
      }
  }
}

DetectorScore DetectorJudge::score() const {
  DetectorScore score;
  score.images = images_;
  score.outcomes = outcomes_;
  score.false_alarms = false_alarms_;
  score.badly_placed = badly_placed_;
  for (const auto& [id, boxes] : boxes_) {
    ClassScore of{.class_id = id, .precision = average_precision(boxes.truths, boxes.found)};
    if (of.precision.truths == 0) continue;
    for (const auto& [outcome, count] : outcomes_) {
      if (outcome.truth != id) continue;
      of.objects += count;
      if (outcome.found == id)
        of.right += count;
      else if (outcome.found != kVoid)
        of.wrong_class += count;
    }
    score.classes.push_back(of);
  }
  const auto mean = [&](double AveragePrecision::*field) {
    double sum = 0;
    int count = 0;
    for (const ClassScore& of : score.classes)
      if (const double v = of.precision.*field; !std::isnan(v)) sum += v, ++count;
    return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
  };
  score.mean = {.ap = mean(&AveragePrecision::ap),
                .ap50 = mean(&AveragePrecision::ap50),
                .ap75 = mean(&AveragePrecision::ap75),
                .small = mean(&AveragePrecision::small),
                .medium = mean(&AveragePrecision::medium),
                .large = mean(&AveragePrecision::large)};
  for (const ClassScore& of : score.classes) score.mean.truths += of.precision.truths;

  std::size_t right = 0, wrong = 0, alarms = 0;
  for (const auto& [outcome, count] : outcomes_) {
    if (outcome.truth == kVoid)
      alarms += count;
    else if (outcome.found == outcome.truth)
      right += count;
    else if (outcome.found != kVoid)
      wrong += count;
  }
  score.dials = {.recall_small = share(found_of_size_[0], of_size_[0]),
                 .recall_medium = share(found_of_size_[1], of_size_[1]),
                 .recall_large = share(found_of_size_[2], of_size_[2]),
                 .confusion = share(wrong, right + wrong),
                 .false_alarms = images_ == 0 ? kUnknown : std::min(8.0, share(alarms, images_)),
                 .box_sigma = sides_ > 0 ? std::sqrt(squared_strays_ / static_cast<double>(sides_))
                                         : kUnknown};
  score.box = {share(box_.right, box_.labeled), share(box_.right, box_.of_objects)};
  score.foreground = {share(foreground_.right, foreground_.labeled),
                      share(foreground_.right, foreground_.of_objects)};
  return score;
}

DetectorConfig with_measured(DetectorConfig dials, const DetectorConfig& measured) {
  for (const auto dial : {&DetectorConfig::recall_small, &DetectorConfig::recall_medium,
                          &DetectorConfig::recall_large, &DetectorConfig::confusion,
                          &DetectorConfig::false_alarms, &DetectorConfig::box_sigma})
    if (!std::isnan(measured.*dial)) dials.*dial = measured.*dial;
  return dials;
}

std::vector<DetectedBox> as_detected(const std::vector<Detection>& detections) {
  std::vector<DetectedBox> boxes;
  for (const Detection& d : detections) {
    DetectedBox box{.left = static_cast<float>(d.left),
                    .top = static_cast<float>(d.top),
                    .right = static_cast<float>(d.right + 1),
                    .bottom = static_cast<float>(d.bottom + 1),
                    .classes = d.classes};
    for (const auto& [id, probability] : d.classes.entries)
      box.score = std::max(box.score, probability);
    boxes.push_back(std::move(box));
  }
  std::ranges::stable_sort(boxes, std::greater<>(), &DetectedBox::score);
  return boxes;
}

}  // namespace mh
