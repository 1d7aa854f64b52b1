// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/protocol/metrics/trajectory_score.hpp"
#include "bench/report/packed.hpp"
#include "bench/report/pages/source.hpp"
#include "scenes/image_file.hpp"
#include "tests/bench/results/made_up_results.hpp"

namespace mh {

/// World from the origin of a made-up system's map.
inline SE3 made_up_origin() {
  return {Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {1.0, -2.0, 0.1}};
}

/// A circular tour with steps of 1/30 s, and an estimate that is off by `drift_m` at its end.
inline void put_paths(RunResult& run, std::size_t frames, double drift_m) {
  for (std::size_t i = 0; i < frames; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(frames);
    const double angle = 6.28 * share;
    const Eigen::Vector3d at(2 * std::cos(angle), 1.5 * std::sin(angle), 1.1);
    const auto stamp = static_cast<Stamp>(i) * 33'333'333;
    run.truth.push_back({stamp, SE3(Eigen::Matrix3d::Identity(), at)});
    const Eigen::Vector3d drifted = at + Eigen::Vector3d(drift_m * share, 0.3 * drift_m, 0);
    run.estimate.push_back(
        {stamp, made_up_origin().inverse() * SE3(Eigen::Matrix3d::Identity(), drifted)});
    MappedFrame call;
    call.index = i;
    call.stamp_ns = stamp;
    call.status = i == frames / 2 ? TrackStatus::kLost : TrackStatus::kTracked;
    call.inliers = 80 + static_cast<int>(i % 40);
    call.keyframe_added = i % 25 == 0;
    run.mapping.calls.push_back(call);
  }
  run.alignment = align_estimate(run.estimate, run.truth);
  run.place.mapping.frames = frames;
  run.place.mapping.length_m = 11.05;
}

/// Answers to some queries; the larger `skill` (0 to 1) is, the more answers are right.
inline MadeUpAnswers answers_of(double skill, std::size_t queries, std::size_t variant) {
  MadeUpAnswers answers;
  answers.keyframes = 40;
  answers.c1 = 38;
  answers.c2 = 9;
  answers.c3 = 4;
  answers.label_mass = 0.2;
  answers.gamma = 1;
  answers.unanswered = variant % 2 == 0 ? RelocalizationStage::kPnp : RelocalizationStage::kInliers;
  const auto right = static_cast<std::size_t>(skill * static_cast<double>(queries));
  answers.correct = static_cast<int>(right);
  for (std::size_t i = 0; i < queries; ++i) {
    answers.attempts.push_back(i < right ? 1 : 5);
    answers.final.push_back(1 + static_cast<int>((i + variant) % 3));
    if (i < right)
      answers.distances_m.push_back(0.004 + 0.001 * static_cast<double>((i + variant) % 7));
    else if (i == right)
      answers.distances_m.push_back(1.7);  // one false answer
  }
  return answers;
}

/// Every run of a suite, each slightly different.
inline std::vector<RunResult> made_up_runs(const Suite& suite, std::size_t frames,
                                           std::size_t queries) {
  std::vector<RunResult> runs;
  for (const RunSpec& spec : expand(suite)) {
    const std::size_t variant = runs.size();
    const double skill = (spec.system.sees_labels() ? 0.8 : 0.7) - 0.02 * (variant % 5);
    MadeUpFigures figures;
    figures.completeness = 0.97;
    figures.ate_m = 0.02 + 0.003 * static_cast<double>(variant % 11);
    figures.ate_deg = 0.4;
    figures.first_pose_m = 0.03;
    figures.rpe_frame_m = 0.002;
    figures.rpe_second_m = 0.004;
    figures.held_out = answers_of(skill, queries, variant);
    figures.track_ms = {10, 12, 31};
    figures.relocalize_ms = {20, 25, 60};
    RunResult run = made_up_run(spec, figures);
    const PointResult answered = run.points.front();
    run.points.assign(spec.points.size(), answered);
    for (std::size_t p = 0; p < run.points.size(); ++p) {
      run.points[p].second_tour.clear();
      for (std::size_t i = 0; i < run.points[p].held_out.size(); ++i) {
        QueryScore& q = run.points[p].held_out[i];
        const double angle = 0.9 * static_cast<double>(i);
        q.true_world_from_camera =
            SE3(Eigen::Matrix3d::Identity(), {2 * std::cos(angle), 1.5 * std::sin(angle), 1.1});
        if (q.answer.world_from_camera)
          q.answer.world_from_camera =
              made_up_origin().inverse() *
              SE3(Eigen::Matrix3d::Identity(),
                  q.true_world_from_camera->translation() + Eigen::Vector3d(*q.distance_m, 0, 0));
        if (i < p % 3) q.success = q.correct = false;  // points differ from each other
      }
    }
    if (frames > 0) put_paths(run, frames, 0.02 + 0.01 * static_cast<double>(variant % 4));
    runs.push_back(std::move(run));
  }
  return runs;
}

/// A replay of the first run: two keyframes, with images of them and of the run's queries.
inline void put_replay(PagesSource& source) {
  using Json = nlohmann::ordered_json;
  const RunResult& run = source.results.runs.front();
  const std::string jpeg = base64(encode_jpeg(Grid2d<Rgb8>(64, 48, Rgb8{90, 120, 150}), 80));
  const auto packed = [](std::initializer_list<std::pair<std::uint32_t, int>> numbers) {
    std::vector<std::uint8_t> bytes;
    for (const auto& [value, size] : numbers) put(bytes, value, size);
    return base64(bytes);
  };
  const std::string keypoints =
      packed({{100, 2}, {80, 2}, {5, 1}, {1, 1}, {300, 2}, {200, 2}, {7, 1}, {0, 1}});
  const std::string pairs = packed({{100, 2},
                                    {80, 2},
                                    {150, 2},
                                    {90, 2},
                                    {1, 1},
                                    {300, 2},
                                    {200, 2},
                                    {200, 2},
                                    {210, 2},
                                    {2 | 4, 1}});
  Json keyframes = Json::array(), views = Json::array(), queries = Json::array();
  for (const std::size_t i : {0U, 40U}) {
    const Eigen::Vector3d at = run.truth[i].world_from_camera.translation() * 1e3;
    keyframes.push_back(
        {std::lround(at.x()), std::lround(at.y()), std::lround(at.z()), 0, 0, 0, 10000});
    views.push_back({{"frame", i},
                     {"ms", run.truth[i].stamp_ns / 1'000'000},
                     {"jpeg", jpeg},
                     {"keypoints", keypoints}});
  }
  for (const QueryScore& q : run.points.front().held_out)
    queries.push_back(
        {{"set", "held_out"},
         {"frame", q.answer.index},
         {"stage", "pnp"},
         {"jpeg", jpeg},
         {"keypoints", keypoints},
         {"candidates", {{{"keyframe", 1}, {"pairs", pairs}}, {{"keyframe", 0}, {"pairs", ""}}}}});
  source.replay_of[run.spec.name] = {
      {"run", run.spec.name},
      {"same", true},
      {"mesh", nullptr},
      {"landmarks",
       {{"mm", {500, 500, 900}},
        {"class", {5}},
        {"classes", {{"5", {{"name", "chair"}, {"color", "#bcbd22"}}}}}}},
      {"keyframes", std::move(keyframes)}};
  source.views_of[run.spec.name] = {{"width_px", 64},
                                    {"height_px", 48},
                                    {"keyframes", std::move(views)},
                                    {"queries", std::move(queries)}};
}

/// Sets what each run of a source cost.
inline void put_costs(PagesSource& source) {
  for (const RunResult& run : source.results.runs) {
    const double more = static_cast<double>(source.cost_of.size() % 7);
    source.cost_of[run.spec.name] = {.wall_s = 90 + more,
                                     .cpu_s = 80 + more,
                                     .slam_s = 40,
                                     .frames_s = 30,
                                     .products_s = 5,
                                     .max_rss_mb = 400 + more};
    source.host_of[run.spec.name] = "bench";
  }
}

}  // namespace mh
