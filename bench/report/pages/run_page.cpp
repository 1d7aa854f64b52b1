// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/run_page.hpp"

#include <algorithm>
#include <cmath>

#include "bench/suite/json_fields.hpp"
#include "slam/config/slam.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kBytesOfMoment = 70;  ///< bytes of both poses, as measured

/// A path as lists of integers: milliseconds since the start, positions in mm, quaternions in
/// 1/10,000.
Json path_json(const Trajectory& path, const SE3& to, Stamp start_ns, std::size_t moments) {
  if (path.empty()) return nullptr;
  const std::size_t step = (path.size() + moments - 1) / std::max<std::size_t>(1, moments);
  Json t = Json::array(), p = Json::array(), q = Json::array();
  const auto add = [&](const TimedPose& pose) {
    t.push_back((pose.stamp_ns - start_ns) / 1'000'000);
    const SE3 placed = to * pose.world_from_camera;
    for (int i = 0; i < 3; ++i) p.push_back(std::lround(placed.translation()[i] * 1e3));
    const Eigen::Quaterniond turn = placed.quaternion();
    for (const double part : turn.coeffs()) q.push_back(std::lround(part * 1e4));
  };
  for (std::size_t i = 0; i < path.size(); i += step) add(path[i]);
  if ((path.size() - 1) % step != 0) add(path.back());
  return {{"of", path.size()}, {"ms", t}, {"mm", p}, {"turn", q}};
}

/// Cells as pairs of value and number of repeats; null if the run left no grid.
Json grid_json(const std::optional<OccupancyGrid>& left) {
  if (!left) return nullptr;
  const OccupancyGrid& grid = *left;
  Json cells = Json::array();
  int value = 0;
  std::size_t count = 0;
  const auto end = [&] {
    if (count > 0) cells.push_back(value), cells.push_back(count);
  };
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x) {
      if (grid.cells(x, y) != value) end(), value = grid.cells(x, y), count = 0;
      ++count;
    }
  end();
  return {{"width", grid.cells.width()}, {"height", grid.cells.height()},
          {"cell_m", grid.resolution_m}, {"x_m", grid.origin_m.x()},
          {"y_m", grid.origin_m.y()},    {"cells", cells}};
}

Json calls_page_json(const MappingOutcome& mapping, Stamp start_ns, std::size_t moments) {
  if (mapping.calls.empty()) return nullptr;
  const std::size_t step = (mapping.calls.size() + moments - 1) / std::max<std::size_t>(1, moments);
  Json ms = Json::array(), inliers = Json::array(), lost = Json::array(), keyframes = Json::array();
  for (std::size_t i = 0; i < mapping.calls.size(); ++i) {
    const MappedFrame& call = mapping.calls[i];
    const auto at = (call.stamp_ns - start_ns) / 1'000'000;
    if (call.status == TrackStatus::kLost) lost.push_back(at);
    if (call.keyframe_added) keyframes.push_back(at);
    if (i % step != 0) continue;
    ms.push_back(at);
    inliers.push_back(json_of(call.inliers));
  }
  return {{"of", mapping.calls.size()},
          {"ms", ms},
          {"inliers", inliers},
          {"lost_ms", lost},
          {"keyframes_ms", keyframes}};
}

}  // namespace

std::size_t moments_for(std::size_t runs, std::size_t budget) {
  const double fits = static_cast<double>(budget) / kBytesOfMoment /
                      static_cast<double>(std::max<std::size_t>(1, runs));
  return static_cast<std::size_t>(std::clamp(fits, 30.0, 3000.0));
}

Json run_page_json(const PagesSource& source, const RunResult& run, std::size_t moments) {
  Stamp start_ns = 0;
  if (!run.truth.empty())
    start_ns = run.truth.front().stamp_ns;
  else if (!run.estimate.empty())
    start_ns = run.estimate.front().stamp_ns;
  Json inputs = Json::object();
  for (const InputDigest& input : run.place.inputs) inputs[input.name] = hex(input.digest);
  const bool has_settings = run.spec.system.takes_settings();
  const auto grid = grid_of(source, run);
  return {
      {"name", run.spec.name},
      {"scene", run.place.scene},
      {"robot", run.place.robot},
      {"length_m", json_of(run.place.mapping.length_m)},
      {"frames", run.place.mapping.frames},
      {"cut", run.place.cut},
      {"truth", path_json(run.truth, SE3(), start_ns, moments)},
      {"estimate", path_json(run.estimate, run.alignment.dock_from_estimate, start_ns, moments)},
      {"calls", calls_page_json(run.mapping, start_ns, moments)},
      {"loops", run.mapping.loops.size()},
      {"skipped", json_of(run.mapping.skipped)},
      {"grid", grid_json(grid)},
      {"grid_damaged", !grid && is_file(source.folder / run.spec.name / "map.yaml")},
      {"inputs", inputs},
      {"trajectory_digest", hex(digest(run.estimate))},
      {"seed", run.spec.seed},
      {"settings", has_settings ? json_of(run.spec.slam) : Json()}};
}

}  // namespace mh
