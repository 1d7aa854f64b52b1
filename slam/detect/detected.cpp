// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/detected.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr std::uint8_t kVoidIndex = 0, kBackgroundIndex = 1;

/// The pixels of which at least half is in the box.
struct PixelBox {
  int left, top, right, bottom;  // right and bottom excluded

  PixelBox(const DetectedBox& box, int width, int height)
      : left(edge(box.left, width)),
        top(edge(box.top, height)),
        right(edge(box.right, width)),
        bottom(edge(box.bottom, height)) {}
  PixelBox middle() const {
    PixelBox half = *this;
    const int x = (right - left) / 4, y = (bottom - top) / 4;
    half.left += x, half.right -= x, half.top += y, half.bottom -= y;
    return half;
  }

 private:
  static int edge(float at, int limit) {
    return static_cast<int>(std::clamp(std::ceil(at - 0.5F), 0.0F, static_cast<float>(limit)));
  }
};

template <class Visit>
void for_each_depth(const PixelBox& box, const Grid2d<float>& depth_m, const DepthRange& range,
                    const Visit& visit) {
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x)
      if (const float z = depth_m(x, y); z > 0 && range.contains(z)) visit(z);
}

constexpr int kBins = 64;
constexpr float kApart = 1.1F;  // least ratio of the mean depths of the farther and the nearer part
constexpr int kMiddlePercent = 30;
constexpr float kJump = 1.04F;  // least ratio of the depths of two neighbors on different surfaces
constexpr int kJumpPercent = 50;

/// Whether depth jumps where the pixels nearer than `cut_m` border on farther ones. A bed or table
/// that extends into the room can be cut at any depth, but its depth does not jump there.
bool ends_at_a_step(const PixelBox& box, const Grid2d<float>& depth_m, const DepthRange& range,
                    float cut_m) {
  std::int64_t pairs = 0, jumps = 0;
  const auto visit = [&](float a, float b) {
    if (!(a > 0) || !(b > 0) || !range.contains(a) || !range.contains(b)) return;
    const auto [near, far] = std::minmax(a, b);
    if (near > cut_m || far <= cut_m) return;
    ++pairs;
    jumps += far >= near * kJump ? 1 : 0;
  };
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x) {
      if (x + 1 < box.right) visit(depth_m(x, y), depth_m(x + 1, y));
      if (y + 1 < box.bottom) visit(depth_m(x, y), depth_m(x, y + 1));
    }
  return 100 * jumps >= kJumpPercent * pairs;
}

/// Splits the depths of a box within a range; returns whether there were two surfaces.
bool split(const PixelBox& box, const Grid2d<float>& depth_m, DepthRange& range) {
  float least = 1e9F, most = 0;
  for_each_depth(box, depth_m, range, [&](float z) {
    least = std::min(least, z);
    most = std::max(most, z);
  });
  if (!(most > least * kApart)) return false;
  const float low = 1 / most, step = (1 / least - low) / kBins;
  std::array<std::int64_t, kBins> count{};
  std::array<double, kBins> sum_m{};
  for_each_depth(box, depth_m, range, [&](float z) {
    const int bin = std::min(kBins - 1, static_cast<int>((1 / z - low) / step));
    ++count[static_cast<std::size_t>(bin)];
    sum_m[static_cast<std::size_t>(bin)] += z;
  });
  double all = 0, all_bins = 0, all_m = 0;
  for (int b = 0; b < kBins; ++b) {
    const auto n = static_cast<double>(count[static_cast<std::size_t>(b)]);
    all += n, all_bins += n * b, all_m += sum_m[static_cast<std::size_t>(b)];
  }
  double n = 0, bins = 0, far_m = 0, best = 0, best_ratio = 0;
  int cut = -1;
  for (int b = 0; b + 1 < kBins; ++b) {  // the farther part: bins 0 to b
    n += static_cast<double>(count[static_cast<std::size_t>(b)]);
    bins += static_cast<double>(count[static_cast<std::size_t>(b)]) * b;
    far_m += sum_m[static_cast<std::size_t>(b)];
    if (n == 0 || n == all) continue;
    const double between = bins / n - (all_bins - bins) / (all - n);
    const double variance = n * (all - n) * between * between;
    if (variance <= best) continue;
    best = variance;
    best_ratio = (far_m / n) / ((all_m - far_m) / (all - n));
    cut = b;
  }
  if (cut < 0 || best_ratio < kApart) return false;
  const float at_m = 1 / (low + step * static_cast<float>(cut + 1));
  if (!ends_at_a_step(box, depth_m, range, at_m)) return false;
  std::int64_t near = 0, middle = 0;
  for_each_depth(box.middle(), depth_m, range, [&](float z) {
    near += z <= at_m ? 1 : 0;
    ++middle;
  });
  if (100 * near >= kMiddlePercent * middle)
    range.far_m = at_m;
  else
    range.near_m = std::nextafter(at_m, range.far_m);
  return true;
}

/// Appends values to bytes.
class Writer {
 public:
  template <class T>
  void value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void classes(const ClassDistribution& classes) {
    value(static_cast<std::uint32_t>(classes.entries.size()));
    for (const auto& [id, probability] : classes.entries) value(id), value(probability);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Takes values from bytes.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}
  template <class T>
  T value() {
    T taken;
    if (rest_.size() < sizeof taken) throw InputError("kept detections: are truncated");
    std::memcpy(&taken, rest_.data(), sizeof taken);
    rest_.remove_prefix(sizeof taken);
    return taken;
  }
  std::uint32_t count(std::size_t bytes_each) {
    const auto n = value<std::uint32_t>();
    if (n > rest_.size() / bytes_each) throw InputError("kept detections: are truncated");
    return n;
  }
  ClassDistribution classes() {
    ClassDistribution classes;
    classes.entries.resize(count(sizeof(ClassId) + sizeof(float)));
    for (auto& [id, probability] : classes.entries) {
      id = value<ClassId>();
      probability = value<float>();
    }
    return classes;
  }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

}  // namespace

DepthRange foreground_depth(const DetectedBox& box, const Grid2d<float>& depth_m) {
  const PixelBox pixels(box, depth_m.width(), depth_m.height());
  DepthRange range;
  for (int i = 0; i < 3 && split(pixels, depth_m, range); ++i) {
  }
  return range;
}

SemanticImage labels_of(const Detected& detected, const Grid2d<float>& depth_m, int width,
                        int height, BoxFill fill) {
  if (!detected.pixels.index.empty()) return detected.pixels;
  SemanticImage image{{width, height, kBackgroundIndex},
                      {ClassDistribution{}, ClassDistribution::one_hot(kBackground)}};
  constexpr std::size_t kMost = 254;  // entries of a palette in addition to these two
  const std::size_t count = std::min(kMost, detected.boxes.size());
  for (std::size_t i = count; i-- > 0;) {
    const DetectedBox& box = detected.boxes[i];
    std::uint8_t index = kVoidIndex;
    if (!box.classes.entries.empty()) {
      index = static_cast<std::uint8_t>(image.palette.size());
      image.palette.push_back(box.classes);
    }
    const bool all = fill == BoxFill::kBox || depth_m.empty();
    const DepthRange range = all ? DepthRange{} : foreground_depth(box, depth_m);
    const PixelBox pixels(box, width, height);
    for (int y = pixels.top; y < pixels.bottom; ++y)
      for (int x = pixels.left; x < pixels.right; ++x)
        if (all || depth_m(x, y) == 0 || range.contains(depth_m(x, y))) image.index(x, y) = index;
  }
  return image;
}

std::string encode(const Detected& detected) {
  Writer out;
  out.value(static_cast<std::int32_t>(detected.clipped));
  out.value(static_cast<std::uint32_t>(detected.boxes.size()));
  for (const DetectedBox& box : detected.boxes) {
    for (const float v : {box.left, box.top, box.right, box.bottom, box.score}) out.value(v);
    out.value(static_cast<std::int32_t>(box.network_class));
    out.classes(box.classes);
  }
  const SemanticImage& pixels = detected.pixels;
  out.value(static_cast<std::uint32_t>(pixels.palette.size()));
  for (const ClassDistribution& classes : pixels.palette) out.classes(classes);
  out.value(static_cast<std::int32_t>(pixels.index.width()));
  out.value(static_cast<std::int32_t>(pixels.index.height()));
  return out.take().append(reinterpret_cast<const char*>(pixels.index.data()), pixels.index.size());
}

Detected decode_detected(std::string_view bytes) {
  Reader in(bytes);
  Detected detected;
  detected.clipped = in.value<std::int32_t>();
  detected.boxes.resize(in.count(5 * sizeof(float)));
  for (DetectedBox& box : detected.boxes) {
    for (float* v : {&box.left, &box.top, &box.right, &box.bottom, &box.score})
      *v = in.value<float>();
    box.network_class = in.value<std::int32_t>();
    box.classes = in.classes();
  }
  detected.pixels.palette.resize(in.count(sizeof(std::uint32_t)));
  for (ClassDistribution& classes : detected.pixels.palette) classes = in.classes();
  const auto width = in.value<std::int32_t>(), height = in.value<std::int32_t>();
  const std::size_t size = in.rest().size();
  if (width < 0 || height < 0 || std::uint64_t(width) * std::uint64_t(height) != size)
    throw InputError("kept detections: are truncated");
  detected.pixels.index = Grid2d<std::uint8_t>(width, height);
  std::memcpy(detected.pixels.index.data(), in.rest().data(), size);
  return detected;
}

}  // namespace mh
