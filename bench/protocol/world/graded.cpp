// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/world/graded.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "bench/protocol/world/visible_surface.hpp"
#include "scenes/floor.hpp"
#include "sim/motion/floor_grid.hpp"
#include "sim/motion/handheld_scan.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr std::uint64_t kGraded = 0x677261646564;  // own random stream for graded queries
enum StreamName : std::uint64_t { kPlaces = 1, kScans = 2, kOrder = 3 };
constexpr double kApart = 0.1;               // minimum distance between two queries, m + rad
constexpr std::size_t kDrawsPerQuery = 500;  // a cell that needs more draws is left incomplete
constexpr std::size_t kHandheldScans = 8;
constexpr double kLead_s = 2.0;     // time after which the exposure control has settled
constexpr std::size_t kBehind = 3;  // frames after the query, for its rolling shutter

constexpr Stamp kSecond_ns = 1'000'000'000;

/// A view that may become a query, and the motion around it.
struct Candidate {
  SE3 world_from_camera;
  const Trajectory* scan = nullptr;  ///< null: at rest
  std::size_t at = 0;
};

/// Draws candidates one at a time; a source may be endless.
class Source {
 public:
  virtual ~Source() = default;
  virtual std::optional<Candidate> next() = 0;
};

/// Poses of a robot at rest on the largest part of the floor that has room for it.
class OnFloor : public Source {
 public:
  OnFloor(const GradedPlace& place, RandomStream stream)
      : level_(place.queried), robot_(place.robot), stream_(stream) {
    const FloorGrid grid = make_floor_grid(*level_, {.top_m = robot_.height_m});
    const Grid2d<std::uint8_t> region = largest_region(grid, robot_.footprint_radius_m);
    cell_m_ = grid.resolution_m;
    for (int y = 0; y < region.height(); ++y)
      for (int x = 0; x < region.width(); ++x)
        if (region(x, y) != 0) cells_.push_back(grid.center_of({x, y}));
    if (cells_.empty())
      throw InputError(fmt::format("{}: has no free floor for a robot of {:.2f} m radius",
                                   place.queried.name, robot_.footprint_radius_m));
  }
  std::optional<Candidate> next() override {
    const RandomStream draw = stream_.fork(drawn_++);
    const Eigen::Vector2d at =
        cells_[draw.below(0, cells_.size())] +
        cell_m_ * Eigen::Vector2d(draw.uniform(1, -0.5, 0.5), draw.uniform(2, -0.5, 0.5));
    const double heading = draw.uniform(3, -std::numbers::pi, std::numbers::pi);
    const SE3 level_from_base(
        Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
        Eigen::Vector3d(at.x(), at.y(), 0));
    return Candidate{level_.world_from_level() * level_from_base * robot_.base_from_camera};
  }

 private:
  LevelScene level_;
  const Robot& robot_;
  RandomStream stream_;
  std::uint64_t drawn_ = 0;
  double cell_m_ = 0;
  std::vector<Eigen::Vector2d> cells_;
};

/// Views of handheld scans of the same place, in random order.
class OfScans : public Source {
 public:
  OfScans(const GradedPlace& place, RandomStream stream) {
    const LevelScene level(place.queried);
    for (std::size_t k = 0; k < kHandheldScans; ++k) {
      DrivenPath path =
          handheld_scan(*level, place.robot.camera, {.seed = stream.fork(kScans).bits(k) >> 1U});
      for (TimedPose& pose : path.camera)
        pose.world_from_camera = level.world_from_level() * pose.world_from_camera;
      scans_.push_back(std::move(path.camera));
    }
    for (std::size_t k = 0; k < scans_.size(); ++k)
      for (std::size_t i = 0; i < scans_[k].size(); ++i)
        order_.push_back({stream.fork(kOrder).fork(k).bits(i), {k, i}});
    std::ranges::sort(order_);
  }
  std::optional<Candidate> next() override {
    if (next_ == order_.size()) return std::nullopt;
    const auto [scan, at] = order_[next_++].second;
    return Candidate{scans_[scan][at].world_from_camera, &scans_[scan], at};
  }

 private:
  std::vector<Trajectory> scans_;
  std::vector<std::pair<std::uint64_t, std::pair<std::size_t, std::size_t>>> order_;
  std::size_t next_ = 0;
};

std::unique_ptr<Source> source_of(const GradedSpec& spec, const GradedPlace& place) {
  const RandomStream stream = RandomStream(spec.seed).fork(kGraded);
  if (place.handheld) return std::make_unique<OfScans>(place, stream);
  return std::make_unique<OnFloor>(place, stream.fork(kPlaces));
}

/// The candidate's view with the part of its scan before and after it, played at a multiple of the
/// scan's speed.
GradedQuery clip_of(const Candidate& candidate, const QueryGrade& grade, double speed) {
  GradedQuery query{.clip = {}, .at = 0, .grade = grade};
  if (candidate.scan == nullptr) {
    query.clip.push_back({0, candidate.world_from_camera});
    return query;
  }
  query.grade.speed = speed;
  const Trajectory& scan = *candidate.scan;
  const Stamp moment_ns = scan[candidate.at].stamp_ns;
  for (std::size_t i = 0; i < std::min(scan.size(), candidate.at + kBehind + 1); ++i) {
    const double after_s = static_cast<double>(scan[i].stamp_ns - moment_ns) * 1e-9 / speed;
    if (after_s < -kLead_s) continue;
    if (i == candidate.at) query.at = query.clip.size();
    query.clip.push_back({std::llround(after_s * 1e9), scan[i].world_from_camera});
  }
  return query;
}

/// A cell while it is being filled with drawn queries.
struct Cell {
  GradedCell counts;
  std::vector<std::pair<Candidate, QueryGrade>> queries;
};

}  // namespace

QueryGrade grade_of(const Trajectory& mapped, const SE3& world_from_camera) {
  QueryGrade grade;
  double least = std::numeric_limits<double>::infinity();
  for (const TimedPose& pose : mapped) {
    const double distance_m =
        (pose.world_from_camera.translation() - world_from_camera.translation()).norm();
    if (distance_m >= least) continue;
    const double angle_rad = angle_between_rad(pose.world_from_camera, world_from_camera);
    if (distance_m + angle_rad >= least) continue;
    least = distance_m + angle_rad;
    grade.mapped_m = distance_m;
    grade.mapped_deg = angle_rad * 180.0 / std::numbers::pi;
  }
  return grade;
}

GradedQueries draw_graded(const GradedSpec& spec, const GradedPlace& place) {
  const std::size_t angles = bins(spec.angle_deg);
  std::vector<Cell> cells(bins(spec.distance_m) * angles);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    cells[c].counts.distance = c / angles;
    cells[c].counts.angle = c % angles;
  }
  const VisibleSurface shown(place.mapped_renderer, place.robot.camera, place.offered);
  const std::unique_ptr<Source> source = source_of(spec, place);
  std::vector<SE3> taken;
  std::size_t open = cells.size();
  for (std::size_t draw = 0; open > 0 && draw < kDrawsPerQuery * spec.per_bin * cells.size();
       ++draw) {
    const std::optional<Candidate> candidate = source->next();
    if (!candidate) break;
    const SE3& pose = candidate->world_from_camera;
    QueryGrade grade = grade_of(place.offered, pose);
    if (!grade.mapped_m) break;
    const std::size_t distance = bin_of(spec.distance_m, *grade.mapped_m);
    const std::size_t angle = bin_of(spec.angle_deg, *grade.mapped_deg);
    if (distance == bins(spec.distance_m) || angle == angles) continue;
    Cell& cell = cells[distance * angles + angle];
    if (cell.queries.size() == spec.per_bin) continue;
    if (std::ranges::any_of(taken,
                            [&](const SE3& other) { return pose_distance(other, pose) < kApart; }))
      continue;
    grade.shown = shown.share(*place.queried_renderer, pose);
    if (*grade.shown < spec.least_shown) {
      ++cell.counts.hidden;
      continue;
    }
    taken.push_back(pose);
    cell.queries.emplace_back(*candidate, grade);
    if (cell.queries.size() == spec.per_bin) --open;
  }
  GradedQueries drawn;
  for (Cell& cell : cells) {
    cell.counts.asked = cell.queries.size();
    drawn.cells.push_back(cell.counts);
    for (const auto& [candidate, grade] : cell.queries) {
      const bool moves = candidate.scan != nullptr;
      for (const double speed : moves ? spec.speed : std::vector<double>{1.0})
        drawn.list.push_back(clip_of(candidate, grade, speed));
    }
  }
  return drawn;
}

GradedSequence::GradedSequence(std::shared_ptr<const Renderer> renderer, const Camera& camera,
                               std::vector<GradedQuery> queries, const SensorConfig& sensors,
                               LabelMode labels)
    : renderer_(std::move(renderer)),
      camera_(camera),
      queries_(std::move(queries)),
      sensors_(sensors),
      labels_(labels) {
  for (std::size_t i = 0; i < queries_.size(); ++i) {
    Trajectory& clip = queries_[i].clip;
    const Stamp stamp_ns = kSecond_ns * static_cast<Stamp>(10 * i + 10);
    for (TimedPose& pose : clip) pose.stamp_ns += stamp_ns;
    truth_.push_back(clip[queries_[i].at]);
  }
}

RgbdFrame GradedSequence::frame(std::size_t i, RandomStream noise) const {
  const GradedQuery& query = queries_[i];
  return SimulatedSequence(renderer_, camera_, query.clip, sensors_, labels_)
      .frame(query.at, noise);
}

}  // namespace mh
