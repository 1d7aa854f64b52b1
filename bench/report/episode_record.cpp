// SPDX-License-Identifier: Apache-2.0
#include "bench/report/episode_record.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "bench/report/drawing/canvas.hpp"
#include "scenes/recordings/images/write_image.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr int kShots = 8;
constexpr double kShotWidth = 236, kShotHeight = 177, kGap = 8, kMargin = 16, kTitle = 46;
constexpr double kMapHeight = 660, kLegendWidth = 430;
constexpr double kEvery_s = 0.5;  // interval between shots while nothing is reported
constexpr double kApart_px = 14;  // marks nearer than this would cover each other

constexpr Rgb8 kDark{35, 38, 45}, kPale{120, 126, 136}, kOccupied{86, 94, 108},
    kUnknown{214, 217, 222}, kFree{250, 250, 248}, kTrue{38, 150, 84}, kBelieved{36, 84, 196},
    kPlan{240, 150, 40}, kGoalBox{200, 40, 120}, kWrong{200, 30, 30};

double degrees(double rad) {
  return rad * 180 / std::numbers::pi;
}

/// Converts places in the robot's map to pixels of the image.
struct MapView {
  Vector2d low_m, high_m;
  double x_px, y_px, scale;
  cv::Point2d operator()(const Vector2d& place_m) const {
    return {x_px + scale * (place_m.x() - low_m.x()), y_px + scale * (high_m.y() - place_m.y())};
  }
};

/// A view that shows the known part of a grid.
MapView view_of(const OccupancyGrid& grid, double x_px, double y_px, double width, double height) {
  MapView view{Vector2d::Constant(1e9), Vector2d::Constant(-1e9), x_px, y_px, 1};
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x)
      if (grid.cells(x, y) != kUnknownCell) {
        view.low_m = view.low_m.cwiseMin(grid.center_m(x, y));
        view.high_m = view.high_m.cwiseMax(grid.center_m(x, y));
      }
  view.low_m.array() -= 0.3;
  view.high_m.array() += 0.3;
  const Vector2d size = view.high_m - view.low_m;
  view.scale = std::min(width / size.x(), height / size.y());
  return view;
}

void draw_grid(Canvas& canvas, const OccupancyGrid& grid, const MapView& view) {
  const double side = view.scale * grid.resolution_m;
  const cv::Point2d low = view(view.low_m), high = view(view.high_m);
  canvas.fill(low.x, high.y, high.x - low.x, low.y - high.y, kUnknown);
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x) {
      if (grid.cells(x, y) == kUnknownCell) continue;
      const cv::Point2d at = view(grid.center_m(x, y));
      canvas.fill(at.x - side / 2, at.y - side / 2, side, side,
                  grid.cells(x, y) == kFreeCell ? kFree : kOccupied);
    }
}

void draw_robot(Canvas& canvas, const MapView& view, const Pose2& pose, Rgb8 color) {
  const double radius = 0.26 * view.scale;
  const cv::Point2d at = view(pose.place_m);
  canvas.ring(at, radius, color, 2);
  canvas.line(at, view(pose * Vector2d(0.34, 0)), color, 2);
}

void draw_way(Canvas& canvas, const MapView& view, const std::vector<Vector2d>& way, Rgb8 color,
              double thickness) {
  for (std::size_t i = 0; i + 1 < way.size(); ++i)
    canvas.line(view(way[i]), view(way[i + 1]), color, thickness);
}

cv::Mat small_image(const RgbdFrame& frame) {
  cv::Mat small;
  cv::resize(color_image(frame.color), small,
             {2 * static_cast<int>(kShotWidth), 2 * static_cast<int>(kShotHeight)}, 0, 0,
             cv::INTER_AREA);
  return small;
}

}  // namespace

void EpisodeRecord::add(const EpisodeMoment& moment) {
  world_from_map_ = moment.world_from_map;
  for (const std::string& said : moment.said)
    lines_.push_back(fmt::format("{:7.1f} s  {}", moment.time_s, said));
  if (moment.navigator == nullptr) return;
  steps_.push_back({moment.time_s, moment.world_from_base, moment.believed});
  const std::string state(name(moment.navigator->state()));
  if (moment.frame != nullptr &&
      (shots_.empty() || moment.time_s >= shots_.back().time_s + kEvery_s || !moment.said.empty()))
    shots_.push_back({moment.time_s, fmt::format("{:.1f} s  {}", moment.time_s, state),
                      small_image(*moment.frame), moment.world_from_base});
  const auto place = [](const Pose2& pose) {
    return fmt::format("[{:6.2f}, {:6.2f}] {:4.0f} deg", pose.place_m.x(), pose.place_m.y(),
                       degrees(pose.heading_rad));
  };
  if (moment.believed && moment.navigator->path().size() > 1 &&
      (moment.navigator->state() == NavigatorState::kDriving) &&
      (plans_.empty() || !moment.said.empty()))
    plans_.push_back(moment.navigator->path());
  if (moment.time_s < next_line_s_) return;
  next_line_s_ = moment.time_s + 1.0;
  std::string answer = "no frame";
  if (moment.report != nullptr) {
    const TrackStatus status = moment.report->status;
    answer = std::string(name_of(status, words(status)));
    if (moment.report->inliers) answer += fmt::format(", {} inliers", *moment.report->inliers);
    if (moment.report->candidates.final)
      answer += fmt::format(", {} candidates", *moment.report->candidates.final);
  }
  lines_.push_back(fmt::format("{:7.1f} s    {:9} at {}  believes {}  SLAM: {}", moment.time_s,
                               state, place(moment.world_from_base),
                               moment.believed ? place(*moment.believed) : "nothing", answer));
}

std::string EpisodeRecord::log_so_far() const {
  std::string text;
  for (const std::string& line : lines_) text += line + "\n";
  return text;
}

std::string EpisodeRecord::log(const EpisodeScore& score) const {
  std::string text = fmt::format(
      "start {} ({}): put at [{:.2f}, {:.2f}] m, {:.0f} deg, to find: {} ({:.1f} m away by the "
      "shortest path)\nplaces are in the world, except 'in its map': its origin is where the "
      "robot's tour began\n",
      score.start, score.variant, score.start_x_m, score.start_y_m, score.start_heading_deg,
      score.goal, score.shortest_m);
  text += log_so_far();
  text += score.success
              ? fmt::format("success: {:.1f} s, {:.1f} m, SPL {:.2f}\n", score.time_s,
                            score.length_m, score.spl)
              : fmt::format("failure: {} after {:.1f} s and {:.1f} m, {:.2f} m from it\n",
                            score.reason, score.time_s, score.length_m, score.end_distance_m);
  if (score.located_s)
    text += fmt::format("localized after {:.1f} s, {:.3f} m and {:.1f} deg off\n", *score.located_s,
                        score.located_error_m.value_or(0), score.located_error_deg.value_or(0));
  text += fmt::format("{} contacts, the fastest {:.3f} m/s; {} collisions above {} m/s\n",
                      score.contacts, score.worst_contact_m_per_s, score.collisions,
                      kCollision_m_per_s);
  return text;
}

std::vector<const EpisodeRecord::Shot*> EpisodeRecord::chosen_shots() const {
  std::vector<const Shot*> chosen;
  const std::size_t n = shots_.size(), count = std::min<std::size_t>(n, kShots);
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(&shots_[count == 1 ? 0 : i * (n - 1) / (count - 1)]);
  return chosen;
}

cv::Mat EpisodeRecord::strip(const std::string& title, const EpisodeScore& score) const {
  const double width = 2 * kMargin + kShots * kShotWidth + (kShots - 1) * kGap;
  const double map_top = kTitle + kShotHeight + 40;
  Canvas canvas(static_cast<int>(width), static_cast<int>(map_top + kMapHeight + kMargin));
  canvas.text(fmt::format("{}: to the {}, {}", title, score.goal,
                          score.success ? fmt::format("arrived after {:.0f} s", score.time_s)
                                        : "failed: " + score.reason),
              {kMargin, 30}, 13, kDark, Canvas::Align::kLeft, true);
  const std::vector<const Shot*> shots = chosen_shots();
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const double x = kMargin + static_cast<double>(i) * (kShotWidth + kGap);
    canvas.image(shots[i]->small, x, kTitle, kShotWidth, kShotHeight);
    canvas.text(fmt::format("{}  {}", i + 1, shots[i]->caption), {x, kTitle + kShotHeight + 18}, 9,
                kDark);
  }
  if (map_.empty()) {
    canvas.text("it has no map: no frame was tracked, or no free floor was seen",
                {kMargin, map_top + 14}, 10, kWrong);
    return canvas.finish();
  }
  const MapView view =
      view_of(map_.grid, kMargin, map_top, width - 3 * kMargin - kLegendWidth, kMapHeight);
  draw_grid(canvas, map_.grid, view);
  for (std::size_t i = 0; i < map_.objects.size(); ++i)
    if (class_by_name(score.goal) == map_.objects[i].class_id)
      for (const Vector2d& place : map_.footprints_m[i]) {
        const double side = view.scale * map_.grid.resolution_m;
        const cv::Point2d at = view(place);
        canvas.fill(at.x - side / 2, at.y - side / 2, side, side, kGoalBox);
      }
  const Pose2 map_from_world = world_from_map_.inverse();
  for (const auto& plan : plans_) draw_way(canvas, view, plan, kPlan, 5);
  for (std::size_t i = 0; i + 1 < steps_.size(); ++i) {
    const Step &a = steps_[i], &b = steps_[i + 1];
    canvas.line(view(map_from_world * a.world_from_base.place_m),
                view(map_from_world * b.world_from_base.place_m), kTrue, 2.5);
    if (a.believed && b.believed)
      canvas.line(view(map_from_world * a.believed->place_m),
                  view(map_from_world * b.believed->place_m), kBelieved, 1.2);
  }
  draw_robot(canvas, view,
             map_from_world * Pose2{{score.start_x_m, score.start_y_m},
                                    score.start_heading_deg * std::numbers::pi / 180},
             kPale);
  if (!steps_.empty())
    draw_robot(canvas, view, map_from_world * steps_.back().world_from_base, kTrue);
  for (std::size_t i = 0; i < shots.size();) {  // images from one place share a mark: "1-4"
    const auto at = [&](std::size_t k) {
      return view(map_from_world * shots[k]->world_from_base.place_m);
    };
    std::size_t end = i + 1;
    while (end < shots.size() && cv::norm(at(end) - at(i)) < kApart_px) ++end;
    canvas.disc(at(i), 3, kDark);
    canvas.text(end == i + 1 ? std::to_string(end) : fmt::format("{}-{}", i + 1, end),
                {at(i).x + 6, at(i).y - 6}, 9, kDark, Canvas::Align::kLeft, true);
    i = end;
  }
  const double x = view({view.high_m.x(), view.low_m.y()}).x + 2 * kMargin;
  double y = map_top + 14;
  const auto legend = [&](Rgb8 color, const std::string& text) {
    canvas.line({x, y - 4}, {x + 26, y - 4}, color, 4);
    canvas.text(text, {x + 36, y}, 10, kDark);
    y += 24;
  };
  legend(kPale, "where it was put");
  legend(kTrue, "where it drove (truth)");
  legend(kBelieved, "where it believed it was");
  legend(kPlan, "paths that it planned");
  legend(kGoalBox, fmt::format("'{}' in its own map", score.goal));
  legend(kOccupied, "occupied in its map");
  legend(kUnknown, "unknown");
  y += 10;
  const auto line = [&](const std::string& text, Rgb8 color = kDark) {
    canvas.text(text, {x, y}, 10, color);
    y += 21;
  };
  line(score.located_s ? fmt::format("localized after {:.1f} s, {:.2f} m off", *score.located_s,
                                     score.located_error_m.value_or(0))
                       : "never localized",
       score.located_s ? kDark : kWrong);
  line(fmt::format("drove {:.1f} m, shortest path {:.1f} m", score.length_m, score.shortest_m));
  line(fmt::format("SPL {:.2f}; {:.2f} m from it in the end", score.spl, score.end_distance_m));
  line(fmt::format("{} contacts, the fastest {:.2f} m/s", score.contacts,
                   score.worst_contact_m_per_s),
       score.collisions > 0 ? kWrong : kDark);
  y += 10;
  for (const std::string& said : lines_) {
    if (said.size() > 11 && said.compare(9, 4, "    ") == 0) continue;  // a once-per-second line
    if (y > map_top + kMapHeight - 10) break;
    line(said.size() > 100 ? said.substr(0, 99) + "..." : said, kPale);
  }
  return canvas.finish();
}

}  // namespace mh
