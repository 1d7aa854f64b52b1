// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/label_faults.hpp"

#include <cassert>
#include <cmath>

namespace mh {
namespace {

enum FaultDraw : std::uint64_t { kConfusion = 1, kWhichClass = 2, kSwap = 3, kDropout = 4 };

void confuse(std::vector<VisibleObject>& objects, double share, const FaultDraws& draws) {
  for (VisibleObject& object : objects)
    if (draws.uniform(kConfusion, object.instance) < share)
      object.class_id =
          wrong_class(object.class_id, draws.persistent_bits(kWhichClass, object.instance));
}

std::int64_t squared_distance(const VisibleObject& a, const VisibleObject& b) {
  const std::int64_t x = (a.left + a.right) - (b.left + b.right);
  const std::int64_t y = (a.top + a.bottom) - (b.top + b.bottom);
  return x * x + y * y;
}

void swap_neighbors(std::vector<VisibleObject>& objects, double share, const FaultDraws& draws) {
  std::vector<bool> done(objects.size(), false);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (done[i] || draws.uniform(kSwap, objects[i].instance) >= share) continue;
    std::size_t nearest = i;
    for (std::size_t j = 0; j < objects.size(); ++j) {
      if (done[j] || objects[j].class_id == objects[i].class_id) continue;
      if (nearest == i ||
          squared_distance(objects[i], objects[j]) < squared_distance(objects[i], objects[nearest]))
        nearest = j;
    }
    if (nearest == i) continue;
    std::swap(objects[i].class_id, objects[nearest].class_id);
    done[i] = done[nearest] = true;
  }
}

/// Marks in `uneven` the elements whose neighbors within a radius, along one line of the grid,
/// are not all the same.
void mark_line(const std::uint8_t* value, std::uint8_t* uneven, int count, std::ptrdiff_t stride,
               int radius) {
  int last_change = -radius - 1;  // the last position that differs from its predecessor
  for (int i = 0; i < count; ++i) {
    if (i > 0 && value[i * stride] != value[(i - 1) * stride]) last_change = i;
    if (i - last_change < radius) uneven[i * stride] = 1;
  }
  int next_change = count + radius + 1;
  for (int i = count - 1; i >= 0; --i) {
    if (next_change - i <= radius) uneven[i * stride] = 1;
    if (i > 0 && value[i * stride] != value[(i - 1) * stride]) next_change = i;
  }
}

}  // namespace

FaultDraws::FaultDraws(const LabelConfig& config, const SE3& world_from_camera, RandomStream frame)
    : view_(world_from_camera),
      always_(config.seed),
      frame_(frame),
      persistent_(std::sqrt(config.persistent_share)),
      of_view_(std::sqrt(std::max(0.0, 1.0 - config.persistent_share - config.frame_share))),
      of_frame_(std::sqrt(config.frame_share)) {}

double FaultDraws::normal(std::uint64_t purpose, std::uint64_t thing) const {
  const RandomStream always = always_.fork(purpose).fork(thing);
  return persistent_ * always.normal(0) + of_view_ * view_.normal(always.fork(1)) +
         of_frame_ * frame_.fork(purpose).normal(thing);
}

double FaultDraws::uniform(std::uint64_t purpose, std::uint64_t thing) const {
  return normal_cdf(normal(purpose, thing));
}

std::uint64_t FaultDraws::persistent_bits(std::uint64_t purpose, std::uint64_t thing) const {
  return always_.fork(purpose).fork(thing).bits(2);
}

ClassId wrong_class(ClassId truth, std::uint64_t bits) {
  std::vector<ClassId> others;
  for (const ClassInfo& info : classes())
    if (info.id != truth && info.id != kVoid && info.id != kBackground &&
        is_coco(info.id) == is_coco(truth))
      others.push_back(info.id);
  return others[bits % others.size()];
}

std::vector<VisibleObject> with_faults(std::vector<VisibleObject> objects,
                                       const LabelNoiseConfig& config, const FaultDraws& draws) {
  if (config.confusion > 0.0) confuse(objects, config.confusion, draws);
  if (config.swap > 0.0) swap_neighbors(objects, config.swap, draws);
  if (config.dropout > 0.0)
    std::erase_if(objects, [&](const VisibleObject& object) {
      return draws.uniform(kDropout, object.instance) < config.dropout;
    });
  return objects;
}

void erode(Grid2d<std::uint8_t>& index, int radius_px) {
  assert(radius_px >= 0);
  if (radius_px == 0) return;
  // A square window is uniform if its rows are uniform and equal to each other.
  const int w = index.width(), h = index.height();
  Grid2d<std::uint8_t> uneven(w, h);
  for (int y = 0; y < h; ++y) mark_line(&index(0, y), &uneven(0, y), w, 1, radius_px);
  Grid2d<std::uint8_t> rows = index;
  constexpr std::uint8_t kUneven = 255;  // larger than any palette index
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (uneven.data()[i]) rows.data()[i] = kUneven;
  for (int x = 0; x < w; ++x) mark_line(&rows(x, 0), &uneven(x, 0), h, w, radius_px);
  for (std::size_t i = 0; i < index.size(); ++i)
    if (uneven.data()[i]) index.data()[i] = 0;
}

}  // namespace mh
