// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/errors.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "slam/core/path_length.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

/// Progress of each pose from the first one, in the delta's unit (meters or seconds).
std::vector<double> progress(const Trajectory& trajectory, DeltaUnit unit) {
  std::vector<double> along(trajectory.size(), 0.0);
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    along[i] = unit == DeltaUnit::kMeters
                   ? along[i - 1] + step_length_m(trajectory, i)
                   : static_cast<double>(trajectory[i].stamp_ns - trajectory[0].stamp_ns) * 1e-9;
  return along;
}

ErrorStatistics ape(const Trajectory& truth, const Trajectory& estimate, Alignment alignment,
                    std::vector<double> (*errors)(const MatchedTrajectories&)) {
  MatchedTrajectories matched = match_by_stamp(truth, estimate);
  const auto truth_from_estimate = align(matched, alignment);
  if (!truth_from_estimate) return {};
  matched.estimate = transformed(*truth_from_estimate, matched.estimate);
  return error_statistics(errors(matched));
}

}  // namespace

ErrorStatistics error_statistics(std::span<const double> errors) {
  ErrorStatistics s;
  if (errors.empty()) return s;
  const auto n = static_cast<double>(errors.size());
  s.count = errors.size();
  double sum = 0;
  for (const double e : errors) {
    sum += e;
    s.sse += e * e;
  }
  s.mean = sum / n;
  s.rmse = std::sqrt(s.sse / n);
  double squares = 0;
  for (const double e : errors) squares += (e - s.mean) * (e - s.mean);
  s.std = std::sqrt(squares / n);
  std::vector<double> sorted(errors.begin(), errors.end());
  std::sort(sorted.begin(), sorted.end());
  s.min = sorted.front();
  s.max = sorted.back();
  s.median = 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
  return s;
}

std::vector<double> ape_translation_m(const MatchedTrajectories& aligned) {
  std::vector<double> errors;
  errors.reserve(aligned.size());
  for (std::size_t i = 0; i < aligned.size(); ++i)
    errors.push_back((aligned.estimate[i].world_from_camera.translation() -
                      aligned.truth[i].world_from_camera.translation())
                         .norm());
  return errors;
}

std::vector<double> ape_rotation_deg(const MatchedTrajectories& aligned) {
  std::vector<double> errors;
  errors.reserve(aligned.size());
  for (std::size_t i = 0; i < aligned.size(); ++i)
    errors.push_back(kDegPerRad * angle_between_rad(aligned.estimate[i].world_from_camera,
                                                    aligned.truth[i].world_from_camera));
  return errors;
}

ErrorStatistics ape_translation(const Trajectory& truth, const Trajectory& estimate,
                                Alignment alignment) {
  return ape(truth, estimate, alignment, ape_translation_m);
}

ErrorStatistics ape_rotation(const Trajectory& truth, const Trajectory& estimate,
                             Alignment alignment) {
  return ape(truth, estimate, alignment, ape_rotation_deg);
}

std::vector<std::pair<std::size_t, std::size_t>> delta_pairs(const Trajectory& estimate,
                                                             const RpeDelta& delta) {
  if (!(delta.value > 0) || !std::isfinite(delta.value))
    throw InputError(fmt::format("RPE: delta: {:g} is not positive", delta.value));
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const std::size_t count = estimate.size();
  if (delta.unit == DeltaUnit::kFrames) {
    if (delta.value != std::floor(delta.value))
      throw InputError(fmt::format("RPE: delta: {:g} frames is not an integer", delta.value));
    if (delta.value >= static_cast<double>(count)) return pairs;
    const auto step = static_cast<std::size_t>(delta.value);
    for (std::size_t i = 0; i + step < count; i += delta.all_pairs ? 1 : step)
      pairs.emplace_back(i, i + step);
    return pairs;
  }
  const std::vector<double> along = progress(estimate, delta.unit);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const auto miss = [&](std::size_t j) { return std::abs(along[j] - along[i] - delta.value); };
    // Progress never decreases, so the nearest pose is either the first one at or beyond the delta
    // or the one before it.
    std::size_t end = i + 1;
    while (end + 1 < count && along[end] - along[i] < delta.value) ++end;
    while (end > i + 1 && miss(end - 1) <= miss(end)) --end;
    if (miss(end) <= delta.tolerance * delta.value) pairs.emplace_back(i, end);
  }
  return pairs;
}

RelativeErrors rpe(const MatchedTrajectories& matched, const RpeDelta& delta) {
  assert(matched.truth.size() == matched.estimate.size());
  RelativeErrors errors;
  for (const auto& [i, j] : delta_pairs(matched.estimate, delta)) {
    const SE3 truth_step =
        matched.truth[i].world_from_camera.inverse() * matched.truth[j].world_from_camera;
    const SE3 estimate_step =
        matched.estimate[i].world_from_camera.inverse() * matched.estimate[j].world_from_camera;
    errors.translation_m.push_back((truth_step.inverse() * estimate_step).translation().norm());
    errors.rotation_deg.push_back(kDegPerRad * angle_between_rad(truth_step, estimate_step));
  }
  return errors;
}

}  // namespace mh
