// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/vocabulary_score.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include <fmt/format.h>

#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr Stamp kMaxApart_ns = 20'000'000;  // as in TUM's associate.py
constexpr double kSecond_ns = 1e9;

const TimedPose* nearest(const Trajectory& truth, Stamp stamp_ns) {
  const auto apart = [&](const TimedPose& pose) { return std::abs(pose.stamp_ns - stamp_ns); };
  const auto best = std::ranges::min_element(truth, {}, apart);
  return best == truth.end() || apart(*best) > kMaxApart_ns ? nullptr : &*best;
}

AugmentedVector describe(const PlacedView& view, const Vocabulary& vocabulary, double gamma) {
  std::vector<Label> labels;
  std::vector<WordId> words;
  for (const Descriptor& d : view.features.descriptors)
    words.push_back(vocabulary.quantize(d).word);
  for (const Keypoint& k : view.features.keypoints) labels.push_back(k.label);
  return augmented_vector(labels, words, gamma,
                          [&](WordId word) { return static_cast<double>(vocabulary.idf(word)); });
}

/// Result of one query: whether its first candidate is true, and the quality of its ranking.
struct Ranking {
  bool first_is_true = false;
  double average_precision = 0, chance = 0;
};

/// @param is_true  for each candidate, most similar first, whether it shows the same place
/// @returns nullopt if no candidate is true.
std::optional<Ranking> judge(const std::vector<bool>& is_true) {
  Ranking ranking;
  double hits = 0;
  for (std::size_t i = 0; i < is_true.size(); ++i)
    if (is_true[i]) ranking.average_precision += ++hits / static_cast<double>(i + 1);
  if (hits == 0) return std::nullopt;
  ranking.first_is_true = is_true.front();
  ranking.average_precision /= hits;
  ranking.chance = hits / static_cast<double>(is_true.size());
  return ranking;
}

}  // namespace

double overlap(const PlacedView& a, const PlacedView& b, const Camera& camera) {
  const SE3 b_from_a = b.world_from_camera.inverse() * a.world_from_camera;
  int measured = 0, shared = 0;
  for (int y = 0; y < a.depth_m.height(); ++y)
    for (int x = 0; x < a.depth_m.width(); ++x) {
      const double depth = a.depth_m(x, y);
      if (!(depth > 0)) continue;
      ++measured;
      const Eigen::Vector3d p =
          b_from_a * camera.unproject(x * PlacedView::kStep, y * PlacedView::kStep, depth);
      if (!(p.z() > 0.1)) continue;
      const Eigen::Vector2d pixel = camera.project(p) / PlacedView::kStep;
      const auto u = static_cast<int>(std::lround(std::clamp(pixel.x(), -2.0, 1e6)));
      const auto v = static_cast<int>(std::lround(std::clamp(pixel.y(), -2.0, 1e6)));
      if (u < 0 || v < 0 || u >= b.depth_m.width() || v >= b.depth_m.height()) continue;
      const double there = b.depth_m(u, v);
      shared += there > 0 && p.z() < 1.1 * there ? 1 : 0;
    }
  return measured == 0 ? 0.0 : static_cast<double>(shared) / measured;
}

std::vector<PlacedView> load_placed_views(const std::filesystem::path& folder,
                                          const RecordedCamera& camera,
                                          const VocabularyScoreConfig& config,
                                          std::vector<std::string>& notes) {
  const Trajectory truth = read_trajectory(folder / "groundtruth.txt", &notes);
  const std::vector<RecordedFrame> recorded = load_tum_folder(folder, &notes);
  std::vector<PlacedView> views;
  for (std::size_t i = 0; i < recorded.size(); i += static_cast<std::size_t>(config.every)) {
    const TimedPose* const pose = nearest(truth, recorded[i].stamp_ns);
    if (!pose) continue;
    const RgbdFrame frame = read_frame(recorded[i], camera);
    PlacedView view{.stamp_ns = recorded[i].stamp_ns,
                    .world_from_camera = pose->world_from_camera,
                    .features = extract(frame, camera.camera, config.features),
                    .depth_m = Grid2d<float>(frame.depth_m.width() / PlacedView::kStep,
                                             frame.depth_m.height() / PlacedView::kStep)};
    for (int y = 0; y < view.depth_m.height(); ++y)
      for (int x = 0; x < view.depth_m.width(); ++x)
        view.depth_m(x, y) = frame.depth_m(x * PlacedView::kStep, y * PlacedView::kStep);
    views.push_back(std::move(view));
  }
  return views;
}

VocabularyScore score_vocabulary(const Vocabulary& vocabulary, std::span<const PlacedView> views,
                                 std::span<const PlacedView> queries, const Camera& camera,
                                 const VocabularyScoreConfig& config) {
  const bool ask_each_other = queries.empty();
  if (ask_each_other) queries = views;
  std::vector<AugmentedVector> words;
  for (const PlacedView& view : views) words.push_back(describe(view, vocabulary, 0.0));

  VocabularyScore score;
  score.views = static_cast<int>(views.size());
  double label_mass = 0;
  for (const PlacedView& query : queries) {
    const AugmentedVector asked = describe(query, vocabulary, 0.0);
    std::vector<std::pair<double, std::size_t>> ranked;  // (minus similarity, view)
    for (std::size_t i = 0; i < views.size(); ++i)
      if (!ask_each_other || std::abs(static_cast<double>(views[i].stamp_ns - query.stamp_ns)) >=
                                 config.min_gap_s * kSecond_ns)
        ranked.emplace_back(-l1_similarity(asked, words[i]), i);
    std::ranges::sort(ranked);
    std::vector<bool> is_true;
    for (const auto& [similarity, i] : ranked)
      is_true.push_back(overlap(query, views[i], camera) >= config.min_overlap);
    const std::optional<Ranking> ranking = judge(is_true);
    if (!ranking) continue;
    ++score.queries;
    score.precision += ranking->first_is_true ? 1 : 0;
    score.average_precision += ranking->average_precision;
    score.chance += ranking->chance;
    score.words_per_view += static_cast<double>(asked.words.size());
    label_mass += describe(query, vocabulary, 1.0).label_mass();
  }
  if (score.queries == 0) throw InputError("vocabulary score: no view has a true neighbor");
  for (double* sum : {&score.precision, &score.average_precision, &score.chance,
                      &score.words_per_view, &label_mass})
    *sum /= score.queries;
  if (label_mass > 0) score.label_mass = label_mass;
  return score;
}

}  // namespace mh
