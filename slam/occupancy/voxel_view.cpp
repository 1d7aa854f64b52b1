// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/voxel_view.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace mh {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr int kSide = 8;  // of a block, voxels

int floor_div(int a, int b) {
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

Vector3i voxel_of(const Vector3d& point_m, double resolution_m) {
  return (point_m / resolution_m).array().floor().cast<int>();
}

Vector3i block_of(const Vector3i& voxel) {
  return {floor_div(voxel.x(), kSide), floor_div(voxel.y(), kSide), floor_div(voxel.z(), kSide)};
}

/// Pixels of an image, both ends included.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Finds the minimum or maximum of an image in any box with a few lookups in precomputed extremes
/// of all squares whose side is a power of two (a sparse table).
template <class F>
class Extremes {
 public:
  explicit Extremes(Grid2d<float> image) {
    levels_.push_back(std::move(image));
    const int w = levels_[0].width(), h = levels_[0].height();
    constexpr int kLargest = 64;
    for (int side = 1; 2 * side <= std::min({w, h, kLargest}); side *= 2) {
      const Grid2d<float>& of = levels_.back();
      Grid2d<float> wide(of.width() - side, of.height() - side, Unfilled{});
      for (int y = 0; y < wide.height(); ++y)
        for (int x = 0; x < wide.width(); ++x)
          wide(x, y) =
              F{}(F{}(of(x, y), of(x + side, y)), F{}(of(x, y + side), of(x + side, y + side)));
      levels_.push_back(std::move(wide));
    }
  }

  /// @pre the box is within the image
  float in(const PixelBox& box) const {
    std::size_t k = 0;
    while (k + 1 < levels_.size() && (2 << k) <= std::min(box.x1 - box.x0, box.y1 - box.y0) + 1)
      ++k;
    const int side = 1 << k;
    float result = levels_[k](box.x0, box.y0);
    for (int v = box.y0;; v = std::min(v + side, box.y1 - side + 1)) {
      for (int u = box.x0;; u = std::min(u + side, box.x1 - side + 1)) {
        result = F{}(result, levels_[k](u, v));
        if (u == box.x1 - side + 1) break;
      }
      if (v == box.y1 - side + 1) break;
    }
    return result;
  }

 private:
  std::vector<Grid2d<float>> levels_;
};

struct Less {
  float operator()(float a, float b) const { return std::min(a, b); }
};
struct More {
  float operator()(float a, float b) const { return std::max(a, b); }
};

/// A depth image in which the pixels without a return are set to `none`.
Grid2d<float> with_none_as(const Grid2d<float>& depth_m, float none) {
  Grid2d<float> image = depth_m;
  for (float& z : image)
    if (!(z > 0)) z = none;
  return image;
}

/// A camera in a map: transforms points from one to the other and back.
class View {
 public:
  View(const Camera& camera, const SE3& map_from_camera)
      : camera_(camera),
        eye_(map_from_camera.translation()),
        map_from_camera_(map_from_camera),
        camera_from_map_(map_from_camera.inverse()) {}
  const Camera& camera() const { return camera_; }
  const Vector3d& eye() const { return eye_; }
  Vector3d in_map(const Vector3d& in_camera) const { return map_from_camera_ * in_camera; }
  Vector3d in_camera(const Vector3d& in_map) const { return camera_from_map_ * in_map; }
  const Eigen::Matrix3d& turn() const { return camera_from_map_.rotation(); }
  double f_px() const { return std::max(camera_.fx_px, camera_.fy_px); }

 private:
  const Camera& camera_;
  Vector3d eye_;
  SE3 map_from_camera_, camera_from_map_;
};

struct Hit {
  std::uint32_t block;  ///< its index in the box of blocks
  VoxelVote vote;
};

/// The blocks around a camera, within its range.
struct BlockBox {
  BlockBox(const Vector3d& eye, const DepthModel& model) {
    const int reach = static_cast<int>(std::ceil(model.max_range_m / model.resolution_m)) + 1;
    const Vector3i voxel = voxel_of(eye, model.resolution_m);
    low = block_of(voxel - Vector3i::Constant(reach));
    size = block_of(voxel + Vector3i::Constant(reach)) - low + Vector3i::Ones();
  }
  std::uint32_t place(const Vector3i& block) const {
    const Vector3i at = block - low;
    return static_cast<std::uint32_t>((at.z() * size.y() + at.y()) * size.x() + at.x());
  }
  Vector3i block(std::uint32_t place) const {
    const int i = static_cast<int>(place);
    return low + Vector3i(i % size.x(), i / size.x() % size.y(), i / (size.x() * size.y()));
  }
  std::size_t count() const {
    return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
           static_cast<std::size_t>(size.z());
  }
  Vector3i low, size;
};

/// The returns within range, ordered by block, then voxel, then class, then detection.
std::vector<Hit> hits_of(const Grid2d<float>& depth_m, const PixelLabels& labels, const View& view,
                         const DepthModel& model, const BlockBox& box) {
  std::vector<std::uint64_t> keys;
  const double least2 = model.min_range_m * model.min_range_m,
               most2 = model.max_range_m * model.max_range_m;
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x) {
      const double z = static_cast<double>(depth_m(x, y));
      if (!(z > 0)) continue;
      const Vector3d in_camera = view.camera().unproject(x, y, z);
      const double range2 = in_camera.squaredNorm();
      if (range2 < least2 || range2 > most2) continue;
      const Vector3i voxel = voxel_of(view.in_map(in_camera), model.resolution_m);
      const Vector3i block = block_of(voxel), at = voxel - kSide * block;
      const auto place = static_cast<std::uint64_t>(at.x() + kSide * (at.y() + kSide * at.z()));
      const ClassId label = labels.classes.empty() ? kVoid : labels.classes(x, y);
      const std::uint8_t detection = labels.detections.empty() ? 0 : labels.detections(x, y);
      keys.push_back(std::uint64_t{box.place(block)} << 32U | place << 16U |
                     std::uint64_t{label} << 8U | detection);
    }
  std::sort(keys.begin(),
            keys.end());  // sorting single numbers takes half the time of comparing three
  std::vector<Hit> hits;
  hits.reserve(keys.size());
  for (const std::uint64_t key : keys)
    hits.push_back(
        {static_cast<std::uint32_t>(key >> 32U),
         {static_cast<std::uint16_t>(key >> 16U & 0xFFFFU), static_cast<ClassId>(key >> 8U & 0xFFU),
          static_cast<std::uint8_t>(key & 0xFFU)}});
  return hits;
}

/// Sets the hit voxels of a block, each with the most frequent class among its returns and the most
/// frequent detection within that class (ties to the smallest id). @returns the first hit of
/// another block
std::vector<Hit>::const_iterator take_hits(std::vector<Hit>::const_iterator hit,
                                           std::vector<Hit>::const_iterator end,
                                           std::uint32_t place, VoxelBlock& block) {
  while (hit != end && hit->block == place) {
    const std::uint16_t voxel = hit->vote.place;
    block.hit[voxel / 64] |= std::uint64_t{1} << voxel % 64U;
    const auto is_here = [&] {
      return hit != end && hit->block == place && hit->vote.place == voxel;
    };
    VoxelVote best{.place = voxel};
    std::ptrdiff_t most = 0;
    while (is_here()) {
      const auto of_class = hit;
      VoxelVote largest = hit->vote;
      std::ptrdiff_t most_of_detection = 0;
      while (is_here() && hit->vote.class_id == of_class->vote.class_id) {
        const auto first = hit;
        while (is_here() && hit->vote == first->vote) ++hit;
        if (hit - first > most_of_detection) {
          most_of_detection = hit - first;
          largest = first->vote;
        }
      }
      if (largest.class_id != kVoid && hit - of_class > most) {
        most = hit - of_class;
        best = largest;
      }
    }
    if (best.class_id != kVoid) block.votes.push_back(best);
  }
  return hit;
}

/// Finds the free voxels of blocks.
class Clearing {
 public:
  Clearing(const Grid2d<float>& depth_m, const View& view, const DepthModel& model)
      : depth_m_(depth_m),
        view_(view),
        model_(model),
        least_(with_none_as(depth_m, std::numeric_limits<float>::infinity())),
        surely_least_(with_none_as(depth_m, 0)),
        greatest_(with_none_as(depth_m, 0)) {
    step_ = view.turn().col(0) * model.resolution_m;
    half_px_m_ = view.f_px() * model.around_voxels * model.resolution_m;
    before_m_ = model.before_voxels * model.resolution_m;
  }

  void clear(VoxelBlock& block) const {
    const double r = model_.resolution_m;
    const Vector3d corner = r * (kSide * block.index).cast<double>();
    switch (at_once(corner)) {
      case AtOnce::kNothing:
        return;
      case AtOnce::kEverything:
        block.free.fill(~std::uint64_t{0});
        return;
      case AtOnce::kUnclear:
        break;
    }
    for (int z = 0; z < kSide; ++z)
      for (int y = 0; y < kSide; ++y) {
        Vector3d p = view_.in_camera(corner + r * Vector3d(0.5, y + 0.5, z + 0.5));
        std::uint64_t row = 0;
        for (int x = 0; x < kSide; ++x, p += step_)
          if (is_free(p)) row |= std::uint64_t{1} << static_cast<unsigned>(x);
        block.free[static_cast<std::size_t>(z)] |= row << static_cast<unsigned>(kSide * y);
      }
  }

 private:
  /// Nearer than this to the camera's plane, nothing is decided: projections there are unbounded.
  static constexpr double kNearest_m = 0.1;

  enum class AtOnce { kNothing, kEverything, kUnclear };

  /// What can be decided for a whole block from its corners, without testing its voxels.
  AtOnce at_once(const Vector3d& corner) const {
    const double side_m = kSide * model_.resolution_m, most_m = model_.max_range_m;
    constexpr double kFar = std::numeric_limits<double>::infinity();
    double nearest = kFar, farthest = -kFar, most_range2 = 0;
    Eigen::Vector2d low(kFar, kFar), high(-kFar, -kFar);
    const Vector3d middle = view_.in_camera(corner + Vector3d::Constant(0.5 * side_m));
    if (middle.norm() - 0.5 * std::sqrt(3.0) * side_m > most_m) return AtOnce::kNothing;
    for (int i = 0; i < 8; ++i) {
      const Vector3d p = view_.in_camera(corner + side_m * Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1));
      nearest = std::min(nearest, p.z());
      farthest = std::max(farthest, p.z());
      most_range2 = std::max(most_range2, p.squaredNorm());
      if (p.z() < kNearest_m) continue;
      low = low.cwiseMin(view_.camera().project(p));
      high = high.cwiseMax(view_.camera().project(p));
    }
    if (farthest < kNearest_m) return AtOnce::kNothing;
    if (nearest < kNearest_m) return AtOnce::kUnclear;  // the image of the block is unbounded
    const int w = depth_m_.width(), h = depth_m_.height();
    if (high.x() < -1 || high.y() < -1 || low.x() > w || low.y() > h) return AtOnce::kNothing;
    const PixelBox box{.x0 = std::max(0, static_cast<int>(std::floor(low.x()))),
                       .y0 = std::max(0, static_cast<int>(std::floor(low.y()))),
                       .x1 = std::min(w - 1, static_cast<int>(std::ceil(high.x()))),
                       .y1 = std::min(h - 1, static_cast<int>(std::ceil(high.y())))};
    if (box.x0 > box.x1 || box.y0 > box.y1) return AtOnce::kNothing;
    if (!(static_cast<double>(greatest_.in(box)) > nearest)) return AtOnce::kNothing;
    const int around = static_cast<int>(half_px_m_ / nearest + 0.5) + 1;
    const PixelBox wide{
        .x0 = box.x0 - around, .y0 = box.y0 - around, .x1 = box.x1 + around, .y1 = box.y1 + around};
    const bool inside = low.x() > 0 && low.y() > 0 && wide.x0 >= 0 && wide.y0 >= 0 && wide.x1 < w &&
                        wide.y1 < h && most_range2 <= most_m * most_m;
    return inside && static_cast<double>(surely_least_.in(wide)) > farthest + before_m_
               ? AtOnce::kEverything
               : AtOnce::kUnclear;
  }

  bool is_free(const Vector3d& p) const {
    if (p.z() < kNearest_m || p.squaredNorm() > model_.max_range_m * model_.max_range_m)
      return false;
    const Camera& camera = view_.camera();
    const double inverse_z = 1 / p.z();
    const double u = camera.fx_px * p.x() * inverse_z + camera.cx_px + 0.5,
                 v = camera.fy_px * p.y() * inverse_z + camera.cy_px + 0.5;
    if (!(u >= 0 && v >= 0 && u < depth_m_.width() && v < depth_m_.height())) return false;
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const double behind = p.z() + before_m_;
    if (!(static_cast<double>(depth_m_(x, y)) > behind)) return false;  // too near, or no return
    const int around = static_cast<int>(half_px_m_ * inverse_z + 0.5);
    if (around == 0) return true;
    const PixelBox box{.x0 = std::max(0, x - around),
                       .y0 = std::max(0, y - around),
                       .x1 = std::min(depth_m_.width() - 1, x + around),
                       .y1 = std::min(depth_m_.height() - 1, y + around)};
    return static_cast<double>(least_.in(box)) > behind;
  }

  const Grid2d<float>& depth_m_;
  const View& view_;
  const DepthModel& model_;
  Extremes<Less> least_;         ///< of the returns
  Extremes<Less> surely_least_;  ///< 0 where a pixel has no return
  Extremes<More> greatest_;
  Vector3d step_;
  double half_px_m_ = 0, before_m_ = 0;
};

}  // namespace

Grid2d<float> smoothed_depth(const Grid2d<float>& depth_m, double noise_per_m) {
  // On a slanted surface, the depths of neighbors differ by more than the noise. Up to kMostSlant
  // times the limit for noise is accepted, which at 2 m is a surface seen at 20 degrees.
  constexpr double kLeast_m = 0.01, kMostSlant = 2.0;
  Grid2d<float> smooth(depth_m.width(), depth_m.height());
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x) {
      const auto z = static_cast<double>(depth_m(x, y));
      if (!(z > 0)) continue;
      const double most = std::max(kLeast_m, 3 * noise_per_m * z * z);
      double sum = z, count_of = 1;
      int neighbors = 0;
      // Opposite neighbors are averaged only as a pair, so that the mean on a slanted plane is on
      // that plane.
      for (const auto& [u, v] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}}) {
        double pair = 0;
        int on = 0;
        for (const int side : {1, -1}) {
          const int px = x + side * u, py = y + side * v;
          if (!depth_m.contains(px, py)) continue;
          const auto other = static_cast<double>(depth_m(px, py));
          // Along a slant, the two differ from the middle in opposite directions.
          if (!(other > 0) || std::abs(other - z) > kMostSlant * most) continue;
          pair += other;
          ++on;
        }
        neighbors += on;
        if (on == 2 && std::abs(0.5 * pair - z) <= most) {
          sum += pair;
          count_of += 2;
        }
      }
      if (neighbors >= 2) smooth(x, y) = static_cast<float>(sum / count_of);
    }
  return smooth;
}

VoxelView look(const Grid2d<float>& depth_m, const PixelLabels& labels, const Camera& camera,
               const SE3& map_from_camera, const DepthModel& model) {
  assert(labels.classes.empty() || labels.classes.size() == depth_m.size());
  assert(labels.detections.empty() || labels.detections.size() == depth_m.size());
  const View view(camera, map_from_camera);
  const BlockBox box(view.eye(), model);
  const std::vector<Hit> hits = hits_of(depth_m, labels, view, model, box);
  const Clearing clearing(depth_m, view, model);
  VoxelView told;
  auto hit = hits.begin();
  for (std::uint32_t place = 0; place < box.count(); ++place) {
    VoxelBlock block;
    block.index = box.block(place);
    clearing.clear(block);
    hit = take_hits(hit, hits.end(), place, block);
    std::uint64_t any = 0;
    for (std::size_t z = 0; z < block.free.size(); ++z) {
      block.free[z] &= ~block.hit[z];
      any |= block.free[z] | block.hit[z];
    }
    if (any != 0) told.push_back(std::move(block));
  }
  return told;
}

}  // namespace mh
