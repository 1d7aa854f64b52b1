// SPDX-License-Identifier: Apache-2.0
#include "bench/report/topdown.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "bench/report/drawing/canvas.hpp"
#include "bench/report/drawing/slice.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

constexpr int kWidth = 1200;
constexpr double kMargin = 40, kHeader = 92, kFooter = 84;
constexpr double kMaxPlanHeight = 1100;

// Heights at which the plan cuts the scene: walls above tables and below the tops of doors,
// furniture through seats and beds.
constexpr double kWallCut_m = 1.2, kFurnitureCut_m = 0.4;

constexpr Rgb8 kInk{35, 38, 45}, kFaint{110, 115, 125}, kRoomName{140, 150, 165}, kWall{55, 58, 66},
    kFurniture{178, 172, 160};
constexpr Rgb8 kMapFree{236, 241, 246}, kMapOccupied{172, 190, 208};
// The true path is a broad pale band and the estimated one a thin dark line, so that both show
// where they overlap.
constexpr Rgb8 kTruth{150, 205, 165}, kEstimate{196, 84, 10};
constexpr double kTruthWidth = 5.5, kEstimateWidth = 1.3;
constexpr Rgb8 kX{20, 70, 170}, kGood{165, 45, 165}, kBad{215, 25, 25}, kMissed{140, 140, 150};

struct Bounds {
  Eigen::Vector2d low{1e30, 1e30}, high{-1e30, -1e30};
  void add(const Eigen::Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void grow(double margin_m) {
    low.array() -= margin_m;
    high.array() += margin_m;
  }
  bool contain(const Eigen::Vector2d& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
};

/// The rooms with their outer walls or, for a mesh without rooms, the surroundings of the path.
/// Everything outside (gardens, backdrops) is cut off.
Bounds area_of_interest(const World& world) {
  constexpr double kWalls_m = 0.35, kSight_m = 5.0;
  Bounds bounds;
  for (const Room& room : world.simulated->scene->rooms)
    for (const Eigen::Vector2d& corner : room.polygon_m) bounds.add(corner);
  const bool rooms = !world.simulated->scene->rooms.empty();
  for (const TimedPose& pose : world.simulated->mapping.camera)
    bounds.add(pose.world_from_camera.translation().head<2>());
  bounds.grow(rooms ? kWalls_m : kSight_m);
  return bounds;
}

/// Maps meters, seen from above (x right, y up), to pixels.
struct PlanView {
  Bounds bounds;
  double px_per_m = 1;
  double left = kMargin;
  cv::Point2d operator()(const Eigen::Vector2d& p) const {
    return {left + (p.x() - bounds.low.x()) * px_per_m,
            kHeader + (bounds.high.y() - p.y()) * px_per_m};
  }
};

PlanView fit(const Bounds& bounds) {
  const Eigen::Vector2d size = (bounds.high - bounds.low).cwiseMax(1.0);
  const double room = kWidth - 2 * kMargin;
  PlanView view{bounds, std::min(room / size.x(), kMaxPlanHeight / size.y())};
  view.left = kMargin + 0.5 * (room - size.x() * view.px_per_m);
  return view;
}

void draw_grid(Canvas& canvas, const PlanView& view, const OccupancyGrid& grid) {
  const double cell = grid.resolution_m * view.px_per_m;
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x) {
      const std::int8_t value = grid.cells(x, y);
      if (value == kUnknownCell || !view.bounds.contain(grid.center_m(x, y))) continue;
      const cv::Point2d center = view(grid.center_m(x, y));
      canvas.fill(center.x - cell / 2, center.y - cell / 2, cell, cell,
                  value == kOccupiedCell ? kMapOccupied : kMapFree);
    }
}

void draw_slice(Canvas& canvas, const PlanView& view, const std::vector<SliceSegment>& segments,
                Rgb8 color, double thickness) {
  for (const SliceSegment& s : segments)
    if (view.bounds.contain(s.from_m) && view.bounds.contain(s.to_m))
      canvas.line(view(s.from_m), view(s.to_m), color, thickness);
}

/// The places that rooms' names should not cover: path, queries and furniture.
std::vector<cv::Point2d> marks(const PlanView& view, const World& world, const RunResult& run,
                               QuerySet set, const std::vector<SliceSegment>& furniture) {
  std::vector<cv::Point2d> result;
  for (const TimedPose& pose : world.simulated->mapping.camera)
    result.push_back(view(pose.world_from_camera.translation().head<2>()));
  for (const QueryScore& q : queries(run.points.front(), set))
    if (q.true_world_from_camera)
      result.push_back(view(q.true_world_from_camera->translation().head<2>()));
  for (const SliceSegment& s : furniture) result.push_back(view(0.5 * (s.from_m + s.to_m)));
  return result;
}

/// Draws each room's name as close to the room's middle as possible without covering marks; if that
/// is impossible, the name is drawn in the middle.
void draw_room_names(Canvas& canvas, const PlanView& view, const Scene& scene,
                     const std::vector<cv::Point2d>& marks) {
  constexpr double kCapital = 14, kClear = 8, kStep = 10;
  for (const Room& room : scene.rooms) {
    Bounds box;
    for (const Eigen::Vector2d& corner : room.polygon_m) box.add(corner);
    std::string label = room.name;
    std::replace(label.begin(), label.end(), '_', ' ');
    const double half_width = 0.5 * Canvas::text_width(label, kCapital) + kClear;
    const cv::Point2d low = view({box.low.x(), box.high.y()}),
                      high = view({box.high.x(), box.low.y()}), middle = 0.5 * (low + high);
    const auto is_free = [&](const cv::Point2d& at) {
      return std::none_of(marks.begin(), marks.end(), [&](const cv::Point2d& mark) {
        return std::abs(mark.x - at.x) < half_width && mark.y < at.y + kClear &&
               mark.y > at.y - kCapital - kClear;
      });
    };
    cv::Point2d best = middle;
    double nearest = std::numeric_limits<double>::infinity();
    for (double y = low.y + 2 * kCapital; y < high.y - kCapital; y += kStep)
      for (double x = low.x + half_width; x < high.x - half_width; x += kStep) {
        const double distance = std::hypot(x - middle.x, y - middle.y);
        if (distance >= nearest || !is_free({x, y})) continue;
        nearest = distance;
        best = {x, y};
      }
    canvas.text(label, best, kCapital, kRoomName, Canvas::Align::kCenter);
  }
}

/// Draws a path seen from above; a gap in time breaks the line.
void draw_path(Canvas& canvas, const PlanView& view, const Trajectory& path, const SE3& plan_from,
               Rgb8 color, double thickness) {
  constexpr Stamp kGap_ns = 250'000'000;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (path[i].stamp_ns - path[i - 1].stamp_ns > kGap_ns) continue;
    const Eigen::Vector3d a = plan_from * path[i - 1].world_from_camera.translation();
    const Eigen::Vector3d b = plan_from * path[i].world_from_camera.translation();
    if (view.bounds.contain(a.head<2>()) && view.bounds.contain(b.head<2>()))
      canvas.line(view(a.head<2>()), view(b.head<2>()), color, thickness);
  }
}

/// Returns where the line from one point toward another ends: at the other point, or at the edge of
/// the plan if that comes first.
Eigen::Vector2d up_to_the_edge(const Bounds& bounds, const Eigen::Vector2d& from,
                               const Eigen::Vector2d& to) {
  double share = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double way = to[axis] - from[axis];
    const double room = (way > 0 ? bounds.high : bounds.low)[axis] - from[axis];
    if (std::abs(way) > std::abs(room)) share = std::min(share, room / way);
  }
  return from + std::max(0.0, share) * (to - from);
}

constexpr double kCross = 4.5, kRing = 6.5, kHeading = 15, kStroke = 1.8;

/// Draws a stroke that starts `inner` px from a place, in the viewing direction of a camera (z
/// forward).
void draw_heading(Canvas& canvas, const cv::Point2d& at, const SE3& plan_from_camera, double inner,
                  Rgb8 color) {
  const Eigen::Vector2d forward = plan_from_camera.rotation().col(2).head<2>();
  if (forward.norm() < 0.1) return;  // it looks up or down
  const cv::Point2d way(forward.x() / forward.norm(), -forward.y() / forward.norm());
  canvas.line(at + inner * way, at + kHeading * way, color, kStroke);
}

/// Draws one query. An answer outside the plan gets no ring, only the line toward it.
void draw_query(Canvas& canvas, const PlanView& view, const QueryScore& q,
                const SE3& plan_from_estimate) {
  if (!q.true_world_from_camera) return;
  const Eigen::Vector2d at = q.true_world_from_camera->translation().head<2>();
  const cv::Point2d truth = view(at);
  if (q.success) {
    const Rgb8 color = q.false_positive ? kBad : kGood;
    const SE3 plan_from_answer = plan_from_estimate * *q.answer.world_from_camera;
    const Eigen::Vector2d p = plan_from_answer.translation().head<2>();
    if (q.false_positive) canvas.line(truth, view(up_to_the_edge(view.bounds, at, p)), kBad, 1);
    if (view.bounds.contain(p)) {
      canvas.ring(view(p), kRing, color, kStroke);
      draw_heading(canvas, view(p), plan_from_answer, kRing, color);
    }
  }
  const Rgb8 color = q.success ? kX : kMissed;
  draw_heading(canvas, truth, *q.true_world_from_camera, 0, color);
  canvas.cross(truth, kCross, color, kStroke);
}

/// Draws good answers first and failures on top: where many queries are in one place, the failures
/// matter most.
void draw_queries(Canvas& canvas, const PlanView& view, const std::vector<QueryScore>& queries,
                  const SE3& plan_from_estimate) {
  const auto rank = [](const QueryScore& q) { return !q.success ? 1 : q.false_positive ? 2 : 0; };
  for (int of = 0; of <= 2; ++of)
    for (const QueryScore& q : queries)
      if (rank(q) == of) draw_query(canvas, view, q, plan_from_estimate);
}

/// Largest distance between the estimated and the true path, m; nullopt if they share no timestamp.
std::optional<double> farthest_apart_m(const Trajectory& truth, const Trajectory& estimate,
                                       const SE3& plan_from_estimate) {
  std::map<Stamp, Eigen::Vector3d> true_place;
  for (const TimedPose& pose : truth)
    true_place[pose.stamp_ns] = pose.world_from_camera.translation();
  std::optional<double> farthest;
  for (const TimedPose& pose : estimate)
    if (const auto found = true_place.find(pose.stamp_ns); found != true_place.end()) {
      const Eigen::Vector3d p = plan_from_estimate * pose.world_from_camera.translation();
      farthest = std::max(farthest.value_or(0), (p - found->second).head<2>().norm());
    }
  return farthest;
}

void draw_scale_bar(Canvas& canvas, const PlanView& view, double y) {
  const double right = kWidth - kMargin, left = right - view.px_per_m;
  canvas.line({left, y}, {right, y}, kInk, 2);
  for (const double x : {left, right}) canvas.line({x, y - 5}, {x, y + 5}, kInk, 2);
  canvas.text("1 m", {0.5 * (left + right), y - 9}, 10, kInk, Canvas::Align::kCenter);
}

/// Draws the legend's entries from left to right, each a symbol and a word.
class Legend {
 public:
  Legend(Canvas& canvas, double y) : canvas_(canvas), y_(y) {}
  template <class Draw>
  void entry(const std::string& word, Draw symbol) {
    symbol(cv::Point2d(x_ + 12, y_));
    canvas_.text(word, {x_ + 30, y_ + 5}, 10, kInk);
    x_ += 30 + Canvas::text_width(word, 10) + 24;
  }

 private:
  Canvas& canvas_;
  double x_ = kMargin, y_;
};

/// @param apart  text after the estimated path: its distance from the true one
/// @param asked, mapped  whether there are queries and map cells to list
void draw_legend(Canvas& canvas, double y, const std::string& apart, bool asked, bool mapped) {
  const auto stroke = [&](Rgb8 color, double thickness) {
    return [&canvas, color, thickness](cv::Point2d at) {
      canvas.line({at.x - 11, at.y}, {at.x + 11, at.y}, color, thickness);
    };
  };
  const auto patch = [&](Rgb8 color) {
    return [&canvas, color](cv::Point2d at) { canvas.fill(at.x - 9, at.y - 7, 18, 14, color); };
  };
  Legend first(canvas, y);
  const auto query = [&](Rgb8 color) {
    return [&canvas, color](cv::Point2d at) {
      canvas.cross(at, kCross, color, kStroke);
      canvas.line(at, at + cv::Point2d(kHeading, 0), color, kStroke);
    };
  };
  const auto answer = [&](Rgb8 color) {
    return [&canvas, color](cv::Point2d at) {
      canvas.ring(at, kRing, color, kStroke);
      canvas.line(at + cv::Point2d(kRing, 0), at + cv::Point2d(kHeading, 0), color, kStroke);
    };
  };
  if (asked) {
    first.entry("query: true place, heading", query(kX));
    first.entry("not answered", query(kMissed));
    first.entry("answer", answer(kGood));
    first.entry("false answer", answer(kBad));
  }
  first.entry("mapping path, true", stroke(kTruth, kTruthWidth));
  first.entry("estimated" + apart, stroke(kEstimate, kEstimateWidth));
  Legend second(canvas, y + 28);
  second.entry(fmt::format("house cut at {} m", kWallCut_m), stroke(kWall, 2.5));
  second.entry(fmt::format("furniture at {} m", kFurnitureCut_m), stroke(kFurniture, 1.5));
  if (!mapped) return;
  second.entry("map: free", patch(kMapFree));
  second.entry("map: occupied", patch(kMapOccupied));
}

/// Draws a line of text between the margins, shrunk to fit.
void draw_line_of_text(Canvas& canvas, const std::string& text, double y, double size, Rgb8 color,
                       bool bold) {
  const double room = (kWidth - 2 * kMargin) / Canvas::text_width(text, size, bold);
  canvas.text(text, {kMargin, y}, size * std::min(1.0, room), color, Canvas::Align::kLeft, bold);
}

void draw_header(Canvas& canvas, const World& world, const RunResult& run, QuerySet set) {
  draw_line_of_text(
      canvas,
      fmt::format(
          "{}: {} system{}{}", run.spec.environment.name, run.spec.system.name,
          !run.spec.system.sees_labels() ? "" : ", " + with_labels(run.spec.labels),
          world.cut ? fmt::format(", first {}", counted(*run.spec.max_frames, "frame")) : ""),
      38, 17, kInk, true);
  const QuerySummary s = summarize(queries(run.points.front(), set));
  const char* which = set == QuerySet::kHeldOut ? "held-out" : "second tour";
  const std::string answers =
      s.queries == 0 ? fmt::format("{}: nothing was asked", which)
                     : fmt::format("{} ({}): {:.1f} % answered, {:.1f} % correct",
                                   counted(static_cast<int>(s.queries), "query", "queries"), which,
                                   100 * s.success, 100 * s.correct.value_or(0));
  const std::optional<double>& ate = run.trajectory.ate_rmse_m;
  draw_line_of_text(
      canvas,
      fmt::format("level {}, trial {}; {} {:.1f} m driven; {}; ATE {}, completeness {:.1f} %",
                  level_name(run.spec.level), run.spec.trial, world.simulated->robot.name,
                  world.simulated->mapping.length_m, answers,
                  ate ? fmt::format("{:.3f} m", *ate) : "-", 100 * run.trajectory.completeness),
      66, 10.5, kFaint, false);
}

}  // namespace

cv::Mat draw_topdown(const World& world, const RunResult& run, QuerySet set) {
  const Bounds bounds = area_of_interest(world);
  const double floor_z_m = world.simulated->scene->floor.middle_m.z();
  const std::vector<SliceSegment> walls = slice(*world.simulated->scene, floor_z_m + kWallCut_m);
  const std::vector<SliceSegment> furniture =
      slice(*world.simulated->scene, floor_z_m + kFurnitureCut_m);
  const PlanView view = fit(bounds);
  const double plan_height = (bounds.high.y() - bounds.low.y()) * view.px_per_m;
  Canvas canvas(kWidth, static_cast<int>(kHeader + plan_height + kFooter + 20));
  draw_grid(canvas, view, run.grid);
  draw_slice(canvas, view, furniture, kFurniture, 1.2);
  draw_slice(canvas, view, walls, kWall, 2.2);
  draw_room_names(canvas, view, *world.simulated->scene, marks(view, world, run, set, furniture));
  draw_path(canvas, view, world.simulated->mapping.camera, SE3(), kTruth, kTruthWidth);
  draw_path(canvas, view, run.estimate, run.alignment.dock_from_estimate, kEstimate,
            kEstimateWidth);
  draw_queries(canvas, view, queries(run.points.front(), set), run.alignment.dock_from_estimate);
  draw_header(canvas, world, run, set);
  const double legend_y = kHeader + plan_height + 36;
  const auto apart_m = farthest_apart_m(world.simulated->mapping.camera, run.estimate,
                                        run.alignment.dock_from_estimate);
  draw_legend(canvas, legend_y,
              apart_m ? fmt::format(", at most {:.3f} m off", *apart_m) : std::string(),
              !queries(run.points.front(), set).empty(), !run.grid.cells.empty());
  draw_scale_bar(canvas, view, legend_y + 28);
  return canvas.finish();
}

}  // namespace mh
