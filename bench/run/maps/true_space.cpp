// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/true_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace mh {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Whether a triangle touches the unit cube around the origin, by separating axes (Akenine-Moller,
/// "Fast 3D triangle-box overlap testing", 2001).
bool touches_cube(const std::array<Vector3d, 3>& corners) {
  const auto apart = [&](const Vector3d& axis) {
    const double reach = 0.5 * axis.cwiseAbs().sum();
    const double a = axis.dot(corners[0]), b = axis.dot(corners[1]), c = axis.dot(corners[2]);
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  for (int i = 0; i < 3; ++i)
    if (apart(Vector3d::Unit(i))) return false;
  const std::array<Vector3d, 3> edges{corners[1] - corners[0], corners[2] - corners[1],
                                      corners[0] - corners[2]};
  if (apart(edges[0].cross(edges[1]))) return false;
  for (const Vector3d& edge : edges)
    for (int i = 0; i < 3; ++i)
      if (apart(edge.cross(Vector3d::Unit(i)))) return false;
  return true;
}

constexpr std::array<std::array<int, 3>, 6> kFaceSteps{
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

}  // namespace

TrueSpace::TrueSpace(const Scene& scene, double resolution_m, std::span<const Vector3d> seeds)
    : resolution_m_(resolution_m) {
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  for (const Eigen::Vector3f& p : scene.positions_m) {
    low = low.cwiseMin(p.cast<double>());
    high = high.cwiseMax(p.cast<double>());
  }
  low_ = (low / resolution_m).array().floor().cast<int>() - 1;
  size_ = (high / resolution_m).array().floor().cast<int>().matrix() + Vector3i::Constant(2) - low_;
  cells_.assign(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                    static_cast<std::size_t>(size_.z()),
                State::kClosed);
  plan_low_ = low_.head<2>();
  plan_high_ = plan_low_ + size_.head<2>();
  if (!scene.rooms.empty()) {
    Eigen::AlignedBox2d rooms;
    for (const Room& room : scene.rooms)
      for (const Eigen::Vector2d& corner : room.polygon_m) rooms.extend(corner);
    plan_low_ =
        plan_low_.cwiseMax((rooms.min() / resolution_m).array().floor().cast<int>().matrix() -
                           Eigen::Vector2i::Ones());
    plan_high_ = plan_high_.cwiseMin(
        (rooms.max() / resolution_m).array().ceil().cast<int>().matrix() + Eigen::Vector2i::Ones());
  }
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    if (scene.materials[scene.material_of[face]].is_pane()) continue;
    std::array<Vector3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i)
      corners[i] = scene.positions_m[scene.triangles[face][i]].cast<double>() / resolution_m;
    mark(corners);
  }
  for (const Vector3d& seed : seeds)
    open_from((seed / resolution_m).array().floor().cast<int>().matrix());
}

TrueSpace::State* TrueSpace::cell(const Vector3i& voxel) {
  const Vector3i at = voxel - low_;
  if ((at.array() < 0).any() || (at.array() >= size_.array()).any()) return nullptr;
  return &cells_[static_cast<std::size_t>(at.x()) +
                 static_cast<std::size_t>(size_.x()) *
                     (static_cast<std::size_t>(at.y()) +
                      static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(at.z()))];
}

TrueSpace::State TrueSpace::at(const Vector3i& voxel) const {
  const State* state = const_cast<TrueSpace*>(this)->cell(voxel);
  return state == nullptr ? State::kClosed : *state;
}

bool TrueSpace::is_near(const Vector3i& voxel, State state) const {
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (at(voxel + Vector3i(x, y, z)) == state) return true;
  return false;
}

void TrueSpace::mark(const std::array<Vector3d, 3>& corners) {
  const Vector3i low =
      corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).array().floor().cast<int>();
  const Vector3i high =
      corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).array().floor().cast<int>();
  Vector3i v;
  for (v.z() = low.z(); v.z() <= high.z(); ++v.z())
    for (v.y() = low.y(); v.y() <= high.y(); ++v.y())
      for (v.x() = low.x(); v.x() <= high.x(); ++v.x()) {
        State* state = cell(v);
        if (state == nullptr || *state == State::kSurface) continue;
        const Vector3d center = v.cast<double>().array() + 0.5;
        if (touches_cube({corners[0] - center, corners[1] - center, corners[2] - center}))
          *state = State::kSurface;
      }
}

void TrueSpace::open_from(const Vector3i& seed) {
  std::vector<Vector3i> stack{seed};
  while (!stack.empty()) {
    const Vector3i voxel = stack.back();
    stack.pop_back();
    State* state = cell(voxel);
    if (state == nullptr || *state != State::kClosed) continue;
    *state = State::kOpen;
    for (const auto& [x, y, z] : kFaceSteps) stack.push_back(voxel + Vector3i(x, y, z));
  }
}

OccupancyGrid TrueSpace::floor_plan(double low_m, double high_m,
                                    std::span<const Vector3d> seeds) const {
  const Eigen::Vector2i cells = plan_high_ - plan_low_;
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(cells.x(), cells.y(), kUnknownCell),
                     .resolution_m = resolution_m_,
                     .origin_m = resolution_m_ * plan_low_.cast<double>()};
  for (int y = 0; y < cells.y(); ++y)
    for (int x = 0; x < cells.x(); ++x)
      for (int z = 0; z < size_.z(); ++z) {
        const double center_m = resolution_m_ * (low_.z() + z + 0.5);
        if (center_m >= low_m && center_m <= high_m &&
            at({plan_low_.x() + x, plan_low_.y() + y, low_.z() + z}) == State::kSurface)
          grid.cells(x, y) = kOccupiedCell;
      }
  std::vector<Eigen::Vector2i> stack;
  for (const Vector3d& seed : seeds)
    if (const auto cell = grid.cell_of(seed.head<2>())) stack.push_back(*cell);
  while (!stack.empty()) {
    const Eigen::Vector2i c = stack.back();
    stack.pop_back();
    if (!grid.cells.contains(c.x(), c.y()) || grid.cells(c.x(), c.y()) != kUnknownCell) continue;
    grid.cells(c.x(), c.y()) = kFreeCell;
    for (const auto& [x, y, z] : kFaceSteps)
      if (z == 0) stack.push_back(c + Eigen::Vector2i(x, y));
  }
  return grid;
}

}  // namespace mh
