// SPDX-License-Identifier: Apache-2.0
#include "bench/report/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "bench/drawing/canvas.hpp"
#include "slam/config/by_name.hpp"
#include "slam/config/slam.hpp"

namespace mh {
namespace {

constexpr double kPanelWidth = 400, kPanelHeight = 340, kSweepMargin = 24, kSweepHeader = 62,
                 kSweepFooter = 30;
constexpr int kColumns = 3;
constexpr Rgb8 kSweepInk = {40, 43, 50}, kGray = {110, 115, 125}, kFrame = {214, 39, 40};
constexpr Rgb8 kWhite = {255, 255, 255};

struct Shades {
  Rgb8 low, high;
  Rgb8 at(double share) const {
    const auto mix = [&](std::uint8_t a, std::uint8_t b) {
      return static_cast<std::uint8_t>(std::lround(a + share * (double(b) - double(a))));
    };
    return {mix(low.r, high.r), mix(low.g, high.g), mix(low.b, high.b)};
  }
};
constexpr Shades kMoreIsBetter = {{236, 243, 251}, {8, 69, 148}},
                 kLessIsBetter = {{253, 243, 231}, {166, 54, 3}};

/// The measure that a panel shows for each point.
struct PanelMeasure {
  std::string title;
  Shades shades;
  int digits;
  std::function<std::optional<double>(const QuerySummary&)> value;
};

std::optional<double> in_percent(const std::optional<double>& share) {
  return share ? std::optional(100 * *share) : std::nullopt;
}

std::vector<PanelMeasure> panel_measures() {
  return {
      {"correct answers, %", kMoreIsBetter, 1,
       [](const QuerySummary& s) { return in_percent(s.correct); }},
      {"false answers, %", kLessIsBetter, 1,
       [](const QuerySummary& s) { return in_percent(s.false_positive); }},
      {"mean distance, mm", kLessIsBetter, 1, [](const QuerySummary& s) -> std::optional<double> {
         if (!s.distance_mean_m) return std::nullopt;
         return 1e3 * *s.distance_mean_m;
       }}};
}

/// The values of a panel, with their minimum and maximum.
struct Values {
  std::vector<std::optional<double>> of;
  double least = 0, most = 0;

  Values(const SweepResult& result, QuerySet set, const PanelMeasure& measure) {
    for (const CategoryRow& row : result.answers) of.push_back(measure.value(summary(row, set)));
    bool any = false;
    for (const auto& value : of)
      if (value) {
        least = any ? std::min(least, *value) : *value;
        most = any ? std::max(most, *value) : *value;
        any = true;
      }
  }
  double share(double value) const { return most > least ? (value - least) / (most - least) : 0; }
};

/// The values that a setting takes in a sweep, and how they are written.
std::map<double, std::string> distinct(const SweepResult& result, std::string_view name) {
  std::map<double, std::string> values;
  for (const SlamConfig& point : result.points)
    values.emplace(setting_value(point, name), shown_value(point, name));
  return values;
}

/// What labels weighed under each value of a setting, below it: the measured label mass, and the
/// gamma that gave it where the mass itself is varied. Empty for a setting of something else.
std::map<double, std::string> weights_of_labels(const SweepResult& result, std::string_view name) {
  if (!weighs_labels(name)) return {};
  std::map<double, std::vector<double>> masses, gammas;
  for (std::size_t i = 0; i < result.points.size(); ++i)
    for (const QuerySet set : kQuerySets) {
      const QuerySummary& s = summary(result.answers[i], set);
      const double value = setting_value(result.points[i], name);
      if (s.label_mass) masses[value].push_back(*s.label_mass);
      if (s.gamma) gammas[value].push_back(*s.gamma);
    }
  std::map<double, std::string> texts;
  for (const auto& [value, measured] : masses)
    texts[value] = name == kGamma ? fmt::format("({:.1f} %)", 100 * mean(measured))
                                  : fmt::format("(gamma {:.3g})", mean(gammas[value]));
  return texts;
}

/// The place of a panel, with space for the numbers on its axes.
struct Box {
  double left, right, top, bottom;
  explicit Box(cv::Point2d corner)
      : left(corner.x + 62),
        right(corner.x + kPanelWidth - 16),
        top(corner.y + 30),
        bottom(corner.y + kPanelHeight - 48) {}
};

void draw_names(Canvas& canvas, const Box& box, const std::string& title, std::string_view across,
                std::string_view up) {
  canvas.text(title, {box.left, box.top - 12}, 9.5, kSweepInk, Canvas::Align::kLeft, true);
  canvas.text(std::string(across), {(box.left + box.right) / 2, box.bottom + 38}, 9, kGray,
              Canvas::Align::kCenter);
  if (!up.empty())
    canvas.text(std::string(up), {box.left - 8, box.top - 12}, 9, kGray, Canvas::Align::kRight);
}

struct Panel {
  cv::Point2d corner;
  const SweepResult& result;
  std::string across, up;  ///< the settings along the axes; up is empty if only one is varied
  std::string title;
  const PanelMeasure& measure;
  const Values& values;
  std::optional<std::size_t> framed;  ///< the highlighted point
};

/// Draws a cell per point.
void draw_grid(Canvas& canvas, const Panel& panel) {
  const auto& [corner, result, across, up, title, measure, values, framed] = panel;
  const Box box(corner);
  const auto xs = distinct(result, across);
  const auto ys = up.empty() ? std::map<double, std::string>{{0, ""}} : distinct(result, up);
  const double width = (box.right - box.left) / static_cast<double>(xs.size());
  const double height = (box.bottom - box.top) / static_cast<double>(ys.size());
  const auto place = [](const std::map<double, std::string>& list, double value) {
    return static_cast<double>(std::distance(list.begin(), list.find(value)));
  };
  const auto corner_of = [&](const SlamConfig& point) {
    const double row = up.empty() ? 0 : place(ys, setting_value(point, up));
    return cv::Point2d(box.left + width * place(xs, setting_value(point, across)),
                       box.bottom - height * (row + 1));
  };
  draw_names(canvas, box, title, shown_name(across), shown_name(up));
  double column = 0, row = 0;
  const auto below_x = weights_of_labels(result, across), below_y = weights_of_labels(result, up);
  const auto number = [&](double value, const std::string& text,
                          const std::map<double, std::string>& below, cv::Point2d at,
                          Canvas::Align align) {
    canvas.text(text, at, 8, kGray, align);
    if (const auto more = below.find(value); more != below.end())
      canvas.text(more->second, at + cv::Point2d(0, 10), 6.5, kGray, align);
  };
  for (const auto& [value, text] : xs)
    number(value, text, below_x, {box.left + width * (column++ + 0.5), box.bottom + 14},
           Canvas::Align::kCenter);
  for (const auto& [value, text] : ys)
    if (!up.empty())
      number(value, text, below_y, {box.left - 8, box.bottom - height * (row++ + 0.5) + 4},
             Canvas::Align::kRight);
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    if (!values.of[i]) continue;
    const double share = values.share(*values.of[i]);
    const cv::Point2d at = corner_of(result.points[i]);
    canvas.fill(at.x, at.y, width, height, measure.shades.at(share));
    canvas.text(fmt::format("{:.{}f}", *values.of[i], measure.digits),
                {at.x + width / 2, at.y + height / 2 + 4}, 8.5, share > 0.5 ? kWhite : kSweepInk,
                Canvas::Align::kCenter);
  }
  if (!framed) return;
  const cv::Point2d a = corner_of(result.points[*framed]), b(a.x + width, a.y + height);
  for (const auto& [from, to] : {std::pair(a, cv::Point2d(b.x, a.y)),
                                 {cv::Point2d(b.x, a.y), b},
                                 {b, cv::Point2d(a.x, b.y)},
                                 {cv::Point2d(a.x, b.y), a}})
    canvas.line(from, to, kFrame, 2);
}

/// Draws a dot per point over two of its settings.
void draw_dots(Canvas& canvas, const Panel& panel) {
  const auto& [corner, result, across, up, title, measure, values, framed] = panel;
  const Box box(corner);
  const auto xs = distinct(result, across), ys = distinct(result, up);
  const auto share = [](const std::map<double, std::string>& list, double value) {
    const double low = list.begin()->first, range = list.rbegin()->first - low;
    return range > 0 ? (value - low) / range : 0.5;
  };
  constexpr double kInset = 10;  // so that the border cuts no dot
  const auto at = [&](const SlamConfig& point) {
    return cv::Point2d(
        box.left + kInset +
            share(xs, setting_value(point, across)) * (box.right - box.left - 2 * kInset),
        box.bottom - kInset -
            share(ys, setting_value(point, up)) * (box.bottom - box.top - 2 * kInset));
  };
  draw_names(canvas, box, title, shown_name(across), shown_name(up));
  canvas.fill(box.left, box.top, box.right - box.left, box.bottom - box.top, {246, 247, 249});
  const auto number = [&](const auto& entry, cv::Point2d where, Canvas::Align align) {
    canvas.text(entry.second, where, 8, kGray, align);
  };
  number(*xs.begin(), {box.left, box.bottom + 16}, Canvas::Align::kLeft);
  number(*xs.rbegin(), {box.right, box.bottom + 16}, Canvas::Align::kRight);
  number(*ys.begin(), {box.left - 8, box.bottom}, Canvas::Align::kRight);
  number(*ys.rbegin(), {box.left - 8, box.top + 10}, Canvas::Align::kRight);
  for (std::size_t i = 0; i < result.points.size(); ++i)
    if (values.of[i])
      canvas.disc(at(result.points[i]), 6, measure.shades.at(values.share(*values.of[i])));
  if (framed) canvas.ring(at(result.points[*framed]), 9, kFrame, 2);
}

bool is_grid(const SweepResult& result, const std::vector<std::string>& varied) {
  std::size_t cells = 1;
  for (const std::string& name : varied) cells *= distinct(result, name).size();
  return varied.size() <= 2 && cells == result.points.size();
}

std::string place_of(const SlamConfig& point, const std::vector<std::string>& varied) {
  std::string text;
  for (const std::string& name : varied)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", shown_name(name),
                        shown_value(point, name));
  return text;
}

std::string caption(const SweepResult& result, QuerySet set, const std::vector<std::string>& varied,
                    const BestPoint& best) {
  const Comparison& c = best.to_reference;
  if (best.equals == result.points.size())
    return fmt::format("{}: {:.1f} % correct at each of {} points", name(set),
                       100 * *summary(result.answers[best.point], set).correct, best.equals);
  return fmt::format(
      "{}: most correct answers at {}{}: {:.1f} %, {:+.1f} [{:+.1f}, {:+.1f}] points against {}",
      name(set), place_of(result.points[best.point], varied),
      best.equals > 1 ? fmt::format(" (one of {} equals)", best.equals) : "",
      100 * *summary(result.answers[best.point], set).correct, 100 * c.difference, 100 * c.low,
      100 * c.high, place_of(result.points[best.reference], varied));
}

}  // namespace

std::string sweep_image_name(const Suite& suite, const SweepResult& result) {
  return fmt::format("sweep-{}-{}-{}.png", suite.systems[result.system].name, name(result.labels),
                     level_name(suite.levels[result.level]));
}

cv::Mat draw_sweep(const Suite& suite, std::span<const Row> rows, const SweepResult& result) {
  const std::vector<std::string>& varied = suite.sweep.varied;
  const bool grid = is_grid(result, varied);
  struct Block {
    QuerySet set;
    BestPoint best;
  };
  std::vector<Block> blocks;
  for (const QuerySet set : kQuerySets)
    if (const auto best = best_point(suite, rows, result, set)) blocks.push_back({set, *best});

  std::vector<std::pair<std::string, std::string>> pairs;  // across, up
  for (std::size_t i = 0; i < varied.size(); ++i)
    for (std::size_t j = i + 1; j < varied.size(); ++j) pairs.emplace_back(varied[j], varied[i]);
  const std::vector<PanelMeasure> all = panel_measures();
  const std::size_t panels = grid ? all.size() : pairs.size();
  const auto lines = static_cast<int>((panels + kColumns - 1) / kColumns);
  const double block_height = lines * kPanelHeight + kSweepFooter;

  Canvas canvas(
      static_cast<int>(2 * kSweepMargin + kColumns * kPanelWidth),
      static_cast<int>(kSweepHeader + static_cast<double>(blocks.size()) * block_height + 16));
  canvas.text(fmt::format("{}: {}, {}, level {}, map: {}", suite.name,
                          suite.systems[result.system].name, with_labels(result.labels),
                          level_name(suite.levels[result.level]), name(suite.sweep.map)),
              {kSweepMargin, 34}, 14, kSweepInk, Canvas::Align::kLeft, true);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto& [set, best] = blocks[b];
    const double top = kSweepHeader + static_cast<double>(b) * block_height;
    for (std::size_t i = 0; i < panels; ++i) {
      const cv::Point2d corner(kSweepMargin + static_cast<double>(i % kColumns) * kPanelWidth,
                               top + static_cast<double>(i / kColumns) * kPanelHeight);
      const PanelMeasure& measure = grid ? all[i] : all.front();
      const Values values(result, set, measure);
      const std::string title = grid ? fmt::format("{}: {}", name(set), measure.title)
                                     : fmt::format("{}: {:.1f} to {:.1f} % correct", name(set),
                                                   values.least, values.most);
      std::optional<std::size_t> framed;
      if ((!grid || i == 0) && best.equals < result.points.size()) framed = best.point;
      if (grid)
        draw_grid(canvas, {corner, result, varied.back(), varied.size() > 1 ? varied.front() : "",
                           title, measure, values, framed});
      else
        draw_dots(canvas, {corner, result, pairs[i].first, pairs[i].second, title, measure, values,
                           framed});
    }
    canvas.text(caption(result, set, varied, best),
                {kSweepMargin + 8, top + lines * kPanelHeight + 12}, 9, kSweepInk);
  }
  canvas.text("framed: most correct answers, chosen by these same queries: confirm it on others",
              {kSweepMargin + 8, static_cast<double>(canvas.height()) - 10}, 8, kGray);
  return canvas.finish();
}

}  // namespace mh
