// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/average_precision.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

namespace mh {
namespace {

constexpr std::size_t kMostPerImage = 100;
constexpr int kRecalls = 101, kOverlaps = 10;
constexpr double kSmallest = 32.0 * 32.0, kLargest = 96.0 * 96.0;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// The k-th of `count` evenly spaced values, rounded as pycocotools' numpy.linspace rounds them:
/// whether a recall of 29 in 100, for example, reaches the value 0.29 depends on the last bits.
double spaced(double first, double last, int count, int k) {
  return k == count - 1 ? last : first + k * ((last - first) / (count - 1));
}

bool is_of(double area, ObjectSize size) {
  switch (size) {
    case ObjectSize::kSmall:
      return area <= kSmallest;
    case ObjectSize::kMedium:
      return area >= kSmallest && area <= kLargest;
    case ObjectSize::kLarge:
      return area >= kLargest;
    case ObjectSize::kAll:
      break;
  }
  return true;
}

enum class Fate { kRight, kWrong, kIgnored };

struct Judged {
  double score;
  Fate fate;
};

/// The truths and detections of one image.
struct Image {
  std::vector<const TruthBox*> truths;
  std::vector<const ScoredBox*> found;
};

/// Assigns an image's detections, best first.
void judge(Image image, double overlap, ObjectSize size, std::vector<Judged>& judged) {
  const auto ignored = [&](const TruthBox& t) { return t.ignore || !is_of(t.area, size); };
  // Truths that count come first.
  std::ranges::stable_partition(image.truths, [&](const TruthBox* t) { return !ignored(*t); });
  std::ranges::stable_sort(image.found, std::greater<>(), &ScoredBox::score);
  image.found.resize(std::min(image.found.size(), kMostPerImage));
  std::vector<bool> taken(image.truths.size(), false);
  for (const ScoredBox* found : image.found) {
    double best = std::min(overlap, 1 - 1e-10);
    std::size_t match = image.truths.size();
    for (std::size_t t = 0; t < image.truths.size(); ++t) {
      if (taken[t]) continue;
      if (match < image.truths.size() && ignored(*image.truths[t]) &&
          !ignored(*image.truths[match]))
        break;  // a truth that counts is taken before any that does not
      const double o = box_overlap(found->box, image.truths[t]->box);
      if (o < best) continue;
      best = o;
      match = t;
    }
    Fate fate = is_of(found->box.width * found->box.height, size) ? Fate::kWrong : Fate::kIgnored;
    if (match < image.truths.size()) {
      taken[match] = true;
      fate = ignored(*image.truths[match]) ? Fate::kIgnored : Fate::kRight;
    }
    judged.push_back({found->score, fate});
  }
}

}  // namespace

double box_overlap(const ImageBox& a, const ImageBox& b) {
  if (a.image != b.image) return 0;
  const double w = std::min(a.left + a.width, b.left + b.width) - std::max(a.left, b.left);
  const double h = std::min(a.top + a.height, b.top + b.height) - std::max(a.top, b.top);
  if (w <= 0 || h <= 0) return 0;
  return w * h / (a.width * a.height + b.width * b.height - w * h);
}

double average_precision(std::span<const TruthBox> truths, std::span<const ScoredBox> found,
                         double overlap, ObjectSize size) {
  std::map<std::size_t, Image> images;
  std::size_t wanted = 0;
  for (const TruthBox& truth : truths) {
    images[truth.box.image].truths.push_back(&truth);
    wanted += !truth.ignore && is_of(truth.area, size) ? 1 : 0;
  }
  if (wanted == 0) return kUnknown;
  for (const ScoredBox& box : found) images[box.box.image].found.push_back(&box);
  std::vector<Judged> judged;
  for (auto& [index, image] : images) judge(std::move(image), overlap, size, judged);
  std::erase_if(judged, [](const Judged& j) { return j.fate == Fate::kIgnored; });
  std::ranges::stable_sort(judged, std::greater<>(), &Judged::score);

  std::vector<double> recall, precision;
  double right = 0;
  for (const Judged& j : judged) {
    right += j.fate == Fate::kRight ? 1 : 0;
    recall.push_back(right / static_cast<double>(wanted));
    precision.push_back(right / static_cast<double>(recall.size()));
  }
  for (std::size_t i = precision.size(); i-- > 1;)
    precision[i - 1] = std::max(precision[i - 1], precision[i]);
  double sum = 0;
  for (int k = 0; k < kRecalls; ++k) {
    const auto at = std::ranges::lower_bound(recall, spaced(0, 1, kRecalls, k));
    if (at != recall.end()) sum += precision[static_cast<std::size_t>(at - recall.begin())];
  }
  return sum / kRecalls;
}

AveragePrecision average_precision(std::span<const TruthBox> truths,
                                   std::span<const ScoredBox> found) {
  const auto mean = [&](ObjectSize size) {
    double sum = 0;
    for (int k = 0; k < kOverlaps; ++k)
      sum += average_precision(truths, found, spaced(0.5, 0.95, kOverlaps, k), size);
    return sum / kOverlaps;
  };
  return {.ap = mean(ObjectSize::kAll),
          .ap50 = average_precision(truths, found, 0.5, ObjectSize::kAll),
          .ap75 = average_precision(truths, found, 0.75, ObjectSize::kAll),
          .small = mean(ObjectSize::kSmall),
          .medium = mean(ObjectSize::kMedium),
          .large = mean(ObjectSize::kLarge),
          .truths = static_cast<std::size_t>(
              std::ranges::count_if(truths, [](const TruthBox& t) { return !t.ignore; }))};
}

}  // namespace mh
