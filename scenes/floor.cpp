// SPDX-License-Identifier: Apache-2.0
#include "scenes/floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Dense>

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kCell_m = 0.05;
constexpr double kMostCells = 1000;  // along x and along y
constexpr float kLevel = 0.7F;     // a level face's slope has at least this cosine: scans are rough
constexpr float kUpright = 0.05F;  // below this cosine, a face is vertical: no area seen from above
constexpr float kHeadroom_m = 1.0F;  // with less headroom, one cannot stand on a surface
constexpr float kLayer_m = 0.1F;     // surfaces closer than this count as one
constexpr double kBin_m = 0.05;      // bin width of the histogram of heights
constexpr double kLeast_m2 = 1.0;    // smallest area of a floor
constexpr double kLarge = 0.25;  // least area of a large surface, as a share of the largest one's
constexpr double kMostBelow = 0.25;  // greatest share of surface below a floor: excludes seats
constexpr double kSteepest_rad = 2.0 * std::numbers::pi / 180;
constexpr double kLevelFloor_rad = 0.1 * std::numbers::pi / 180;  // below it: measurement error
constexpr double kLevelFloor_m = 1e-3;

/// Where the vertical line through a cell's center crosses a surface.
struct Sample {
  std::uint32_t cell = 0;
  float z_m = 0;
  bool level = false, labeled = false;
};

Vector3f corner(const Scene& scene, std::size_t face, std::size_t k) {
  return scene.positions_m[scene.triangles[face][k]];
}

/// Twice the face's area along its normal.
Vector3f normal_of(const Scene& scene, std::size_t face) {
  const Vector3f a = corner(scene, face, 0);
  return (corner(scene, face, 1) - a).cross(corner(scene, face, 2) - a);
}

/// The scene seen from above, as columns over a grid.
class Columns {
 public:
  explicit Columns(const Scene& scene) {
    const auto [things, box] = extents(scene);
    things_ = things;
    low_ = box.min().cast<double>();
    const Vector2d size = box.sizes().cast<double>();
    cell_m_ = std::max(kCell_m, size.maxCoeff() / kMostCells);
    width_ = static_cast<int>(std::ceil(size.x() / cell_m_)) + 1;
    height_ = static_cast<int>(std::ceil(size.y() / cell_m_)) + 1;
    for (std::size_t face = 0; face < scene.triangles.size(); ++face) add(scene, face);
    std::ranges::sort(samples, [](const Sample& a, const Sample& b) {
      return std::tie(a.cell, a.z_m) < std::tie(b.cell, b.z_m);
    });
  }

  Vector3d point(const Sample& sample) const {
    const int x = static_cast<int>(sample.cell) % width_,
              y = static_cast<int>(sample.cell) / width_;
    return {low_.x() + (x + 0.5) * cell_m_, low_.y() + (y + 0.5) * cell_m_,
            static_cast<double>(sample.z_m)};
  }
  double cell_m2() const { return cell_m_ * cell_m_; }
  /// Area of the ground that these samples cover; overlaps count once.
  double area_m2(const std::vector<Sample>& some) const {
    std::size_t cells = 0;
    for (std::size_t i = 0; i < some.size(); ++i)
      cells += i == 0 || some[i].cell != some[i - 1].cell;
    return static_cast<double>(cells) * cell_m2();
  }

  Room room_around(const std::vector<Sample>& some, const std::string& name) const {
    Eigen::AlignedBox2d box;
    for (const Sample& sample : some) box.extend(point(sample).head<2>());
    if (box.isEmpty()) return {.name = name, .polygon_m = {}, .is_box = true};
    const Vector2d low = box.min().array() - 0.5 * cell_m_,
                   high = box.max().array() + 0.5 * cell_m_;
    return {.name = name,
            .polygon_m = {low, {high.x(), low.y()}, high, {low.x(), high.y()}},
            .is_box = true};
  }

  /// Samples of walkable classes. If there is not enough headroom between two of them, only the
  /// upper one is kept: for example a house's floor, not the ground below it.
  std::vector<Sample> labeled() const {
    std::vector<Sample> some;
    std::ranges::copy_if(samples, std::back_inserter(some), &Sample::labeled);
    return with_headroom(some);
  }
  /// Samples that one could stand on: with enough headroom, and within the extent of the things.
  std::vector<Sample> standable() const {
    std::vector<Sample> some = with_headroom(samples);
    std::erase_if(some, [&](const Sample& sample) { return !among_things(point(sample)); });
    return some;
  }
  /// Whether a point is within the extent of the things, which excludes most of a ground plane that
  /// extends to the horizon.
  bool among_things(const Vector3d& p) const {
    return things_.contains(p.head<2>().cast<float>().eval());
  }

  Eigen::AlignedBox2d things_m() const { return things_.cast<double>(); }

  std::vector<Sample> samples;  ///< sorted by cell, then by height

 private:
  static std::vector<Sample> with_headroom(const std::vector<Sample>& all) {
    std::vector<Sample> some;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (i + 1 == all.size() || all[i + 1].cell != all[i].cell ||
          all[i + 1].z_m - all[i].z_m > kHeadroom_m)
        some.push_back(all[i]);
    return some;
  }

  /// The extent of the things, which is that of all faces that are not level; and the same extent
  /// enlarged to include the faces that are labeled as floor.
  static std::pair<Eigen::AlignedBox2f, Eigen::AlignedBox2f> extents(const Scene& scene) {
    Eigen::AlignedBox2f things, labeled, all;
    for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
      const Vector3f n = normal_of(scene, face);
      const bool level = std::abs(n.z()) >= 0.98F * n.norm();
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector2f p = corner(scene, face, k).head<2>();
        all.extend(p);
        if (!level) things.extend(p);
        if (is_walked_on(scene.class_of[face])) labeled.extend(p);
      }
    }
    if (things.isEmpty() || things.sizes().minCoeff() < 0.5F) things = all;
    return {things, things.merged(labeled)};
  }

  /// Samples a face at cell centers; a center on an edge belongs to one face only.
  void add(const Scene& scene, std::size_t face) {
    const Vector3f n = normal_of(scene, face);
    const float norm = n.norm();
    if (!(std::abs(n.z()) > kUpright * norm)) return;
    std::array<Vector2d, 3> p;
    std::array<double, 3> z;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d at = corner(scene, face, k).cast<double>();
      p[k] = (at.head<2>() - low_) / cell_m_ - Vector2d(0.5, 0.5);  // in cell centers
      z[k] = at.z();
    }
    if (n.z() < 0) std::swap(p[1], p[2]), std::swap(z[1], z[2]);
    const Vector2d least = p[0].cwiseMin(p[1]).cwiseMin(p[2]),
                   most = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const auto from = [](double v) { return static_cast<int>(std::max(0.0, std::ceil(v))); };
    const auto to = [](double v, int end) {
      return static_cast<int>(std::min<double>(end - 1, std::floor(v)));
    };
    const bool labeled = is_walked_on(scene.class_of[face]);
    for (int y = from(least.y()); y <= to(most.y(), height_); ++y)
      for (int x = from(least.x()); x <= to(most.x(), width_); ++x) {
        std::array<double, 3> share{};
        bool inside = true;
        for (std::size_t k = 0; k < 3 && inside; ++k) {
          const Vector2d &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
          const Vector2d side = b - a;
          share[k] = side.x() * (y - a.y()) - side.y() * (x - a.x());
          const bool ours = side.y() < 0 || (side.y() == 0 && side.x() > 0);
          inside = share[k] > 0 || (share[k] == 0 && ours);
        }
        if (!inside) continue;
        const double sum = share[0] + share[1] + share[2];
        const double height = z[0] + (share[1] * (z[1] - z[0]) + share[2] * (z[2] - z[0])) / sum;
        samples.push_back({static_cast<std::uint32_t>(y * width_ + x), static_cast<float>(height),
                           std::abs(n.z()) >= kLevel * norm, labeled});
      }
  }

  Eigen::AlignedBox2f things_;
  Vector2d low_;
  double cell_m_ = kCell_m;
  int width_ = 0, height_ = 0;
};

/// Height of the lowest large surface; nullopt if there is none.
std::optional<double> lowest_large(const std::vector<Sample>& some, double cell_m2) {
  if (some.empty()) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(some, {}, &Sample::z_m);
  const double base = std::floor(static_cast<double>(low.z_m) / kBin_m) - 1;
  const auto bin = [&](float z) {
    return static_cast<std::size_t>(std::floor(static_cast<double>(z) / kBin_m) - base);
  };
  std::vector<std::size_t> count(bin(high.z_m) + 2, 0);
  for (const Sample& sample : some) ++count[bin(sample.z_m)];
  // Sums of three adjacent bins, since a floor is not at exactly one height.
  std::vector<std::size_t> window(count.size(), 0);
  for (std::size_t i = 1; i + 1 < count.size(); ++i)
    window[i] = count[i - 1] + count[i] + count[i + 1];
  const auto most = static_cast<double>(std::ranges::max(window));
  const double enough = std::max(kLeast_m2 / cell_m2, kLarge * most);
  for (std::size_t i = 0; i < window.size(); ++i) {
    if (static_cast<double>(window[i]) < enough) continue;
    while (i + 1 < window.size() && window[i + 1] > window[i]) ++i;  // to the peak
    std::vector<float> heights;
    for (const Sample& sample : some)
      if (bin(sample.z_m) + 1 >= i && bin(sample.z_m) <= i + 1) heights.push_back(sample.z_m);
    std::ranges::nth_element(heights,
                             heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2));
    return static_cast<double>(heights[heights.size() / 2]);
  }
  return std::nullopt;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// z = middle.z + slope . ((x, y) - middle).
struct FloorPlane {
  Vector3d middle_m = Vector3d::Zero();
  Vector2d slope = Vector2d::Zero();
  double above(const Vector3d& p) const {
    return p.z() - middle_m.z() - slope.dot((p - middle_m).head<2>());
  }
};

/// A least-squares fit to the points near `plane`; its height is the median of the points'.
FloorPlane refitted(const std::vector<Vector3d>& points, const FloorPlane& plane, double reach_m,
                    bool may_slope) {
  std::vector<Vector3d> near;
  for (const Vector3d& p : points)
    if (std::abs(plane.above(p)) <= reach_m) near.push_back(p);
  if (near.empty()) return plane;
  FloorPlane result;
  for (const Vector3d& p : near) result.middle_m += p / static_cast<double>(near.size());
  result.middle_m.z() = plane.middle_m.z();
  if (may_slope) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const Vector3d& p : near) {
      const Vector3d row((p - result.middle_m).x(), (p - result.middle_m).y(), 1.0);
      normal += row * row.transpose();
      right += row * (p.z() - result.middle_m.z());
    }
    const Vector3d solution = normal.ldlt().solve(right);
    if (solution.allFinite()) result.slope = solution.head<2>();
  }
  std::vector<double> heights;
  for (const Vector3d& p : near) heights.push_back(result.above(p));
  result.middle_m.z() += median(std::move(heights));
  return result;
}

/// Whether too much of the scene is below the plane for it to be a floor: this excludes tabletops
/// and seats.
bool too_much_below(const Scene& scene, const FloorPlane& plane, const Columns& columns) {
  double below = 0, above = 0, all = 0;
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    const auto area = static_cast<double>(normal_of(scene, face).norm());
    std::array<double, 3> away;
    for (std::size_t k = 0; k < 3; ++k)
      away[k] = plane.above(corner(scene, face, k).cast<double>());
    bool among_things = true;
    for (std::size_t k = 0; k < 3; ++k)
      among_things &= columns.among_things(corner(scene, face, k).cast<double>());
    if (!among_things) continue;
    all += area;
    if (std::ranges::min(away) < -kLayer_m && std::ranges::max(away) < kLayer_m) below += area;
    if (std::ranges::max(away) > kLayer_m) above += area;
  }
  return below > kMostBelow * all || below > above;
}

/// Five standard deviations of the floor vertices' heights above the plane: even among a scan's
/// many thousands of floor vertices, noise moves none that far.
double roughness_m(const Scene& scene, const FloorPlane& plane) {
  std::vector<double> away;
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    const Vector3f n = normal_of(scene, face);
    std::array<double, 3> of;
    for (std::size_t k = 0; k < 3; ++k)
      of[k] = std::abs(plane.above(corner(scene, face, k).cast<double>()));
    if (std::abs(n.z()) >= kLevel * n.norm() && std::ranges::max(of) < kHighestFloor_m)
      away.insert(away.end(), of.begin(), of.end());
  }
  return away.empty() ? 0.03 : std::clamp(5 * 1.4826 * median(std::move(away)), 0.03, 0.12);
}

FloorPlane fitted(const std::vector<Vector3d>& points, double z_m,
                  std::vector<std::string>* warnings, const std::string& name) {
  FloorPlane plane;
  plane.middle_m.z() = z_m;
  for (const double reach_m : {0.15, 0.1, 0.1, 0.08, 0.08, 0.08})
    plane = refitted(points, plane, reach_m, true);
  const double slope_rad = std::atan(plane.slope.norm());
  if (slope_rad >= kLevelFloor_rad && slope_rad <= kSteepest_rad) return plane;
  if (slope_rad > kSteepest_rad && warnings != nullptr)
    warnings->push_back(
        fmt::format("{}: its floor slopes by {:.1f} degrees: treated as level (slopes of up to 2 "
                    "degrees are followed)",
                    name, slope_rad * 180 / std::numbers::pi));
  plane = {};
  plane.middle_m.z() = z_m;
  for (int i = 0; i < 3; ++i) plane = refitted(points, plane, 0.1, false);
  if (std::abs(plane.middle_m.z()) < kLevelFloor_m) plane.middle_m.z() = 0;
  return plane;
}

double level_area(const Scene& scene, int axis) {
  double sum = 0;
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    const Vector3f n = normal_of(scene, face);
    if (std::abs(n[axis]) >= 0.98F * n.norm()) sum += static_cast<double>(n.norm());
  }
  return sum;
}

}  // namespace

bool is_walked_on(ClassId class_id) {
  static const std::array walked_on = {class_by_name("floor"), class_by_name("floor mat")};
  return std::ranges::find(walked_on, std::optional(class_id)) != walked_on.end();
}

std::optional<FoundFloor> find_floor(const Scene& scene, std::optional<double> floor_z_m,
                                     std::vector<std::string>* warnings) {
  const Columns columns(scene);
  std::vector<Sample> some = columns.labeled();
  const bool labeled = columns.area_m2(some) >= kLeast_m2;
  if (!labeled) some = columns.standable();
  std::vector<Sample> inner;
  std::ranges::copy_if(some, std::back_inserter(inner), [&](const Sample& sample) {
    return (labeled || sample.level) && columns.among_things(columns.point(sample));
  });
  if (columns.area_m2(inner) < kLeast_m2) inner = some;  // the objects are beside the floor
  const std::optional<double> z_m = floor_z_m ? floor_z_m : lowest_large(inner, columns.cell_m2());
  if (!z_m) return std::nullopt;

  std::vector<Vector3d> points;
  for (const Sample& sample : inner) points.push_back(columns.point(sample));
  FloorPlane plane;
  plane.middle_m.z() = *z_m;
  if (!floor_z_m) plane = fitted(points, *z_m, warnings, scene.name);
  if (!floor_z_m && !labeled && too_much_below(scene, plane, columns)) return std::nullopt;

  Floor floor;
  floor.middle_m = plane.middle_m;
  floor.up = Vector3d(-plane.slope.x(), -plane.slope.y(), 1.0).normalized();
  floor.rough_m = roughness_m(scene, plane);
  std::erase_if(some, [&](const Sample& sample) {
    const double above = plane.above(columns.point(sample));
    return above > (labeled ? kHighestFloor_m : floor.rough_m) || above < -kDeepestFloor_m;
  });
  floor.area_m2 = columns.area_m2(some);
  return FoundFloor{floor, columns.room_around(some, scene.name), columns.things_m()};
}

bool looks_y_up(const Scene& scene) {
  double floor_up = 0, floor_aside = 0;
  Eigen::AlignedBox3f box;
  for (const Vector3f& p : scene.positions_m) box.extend(p);
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    if (!is_walked_on(scene.class_of[face])) continue;
    const Vector3f n = normal_of(scene, face).cwiseAbs();
    floor_up += static_cast<double>(n.z());
    floor_aside += static_cast<double>(n.y());
  }
  if (0.5 * std::max(floor_up, floor_aside) >= kLeast_m2) return floor_aside > 2 * floor_up;
  // A room is lower than it is wide, and more of its surface faces up or down (floor, ceiling,
  // tables) than along a horizontal axis.
  const Vector3f size = box.isEmpty() ? Vector3f::Zero().eval() : Vector3f(box.sizes());
  return size.z() > 3.2F && size.y() > 1.8F && size.y() < 0.9F * std::min(size.x(), size.z()) &&
         level_area(scene, 1) > level_area(scene, 2);
}

}  // namespace mh
