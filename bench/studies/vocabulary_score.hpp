// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "scenes/recorded/tum_folder.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/features.hpp"
#include "slam/semantics/augmented_vector.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// A picture of known place, for judging which others show the same.
struct PlacedView {
  Stamp stamp_ns = 0;
  SE3 world_from_camera;
  Features features;
  Grid2d<float> depth_m;  ///< every kStep-th pixel of every kStep-th row
  static constexpr int kStep = 8;
};

/// Share of the points that `a` measured which `b` measured too: in its picture, and no farther
/// from the camera than its depth there by 10 %. 0 where `a` measured nothing.
double overlap(const PlacedView& a, const PlacedView& b, const Camera& camera);

struct VocabularyScoreConfig {
  double min_overlap = 0.5;  ///< views that share so much show the same place
  double min_gap_s = 2.0;    ///< within one sequence, views nearer in time are no candidates
  int every = 1;             ///< take every n-th picture of a sequence, >= 1
  FeatureConfig features;
};

/// How well words alone find the views of a place.
struct VocabularyScore {
  int views = 0;                     ///< candidates
  int queries = 0;                   ///< that have a true neighbor among their candidates
  double words_per_view = 0;         ///< different words, of the queries
  std::optional<double> label_mass;  ///< mean share of labels at gamma = 1; none without labels
  double precision = 0;              ///< share of queries whose most alike candidate is true
  double average_precision = 0;      ///< mean over queries (area under precision and recall)
  double chance = 0;                 ///< mean share of true neighbors among candidates
};

/// Reads a folder in TUM's layout with its groundtruth.txt; pictures whose pose is not known to
/// within 0.02 s are left out. @throws InputError naming file and line.
std::vector<PlacedView> load_placed_views(const std::filesystem::path& folder,
                                          const RecordedCamera& camera,
                                          const VocabularyScoreConfig& config);

/// Ranks the views by l1_similarity() to each query, equals by their order. Without queries, each
/// view asks for the others. @throws InputError if no query has a true neighbor.
VocabularyScore score_vocabulary(const Vocabulary& vocabulary, std::span<const PlacedView> views,
                                 std::span<const PlacedView> queries, const Camera& camera,
                                 const VocabularyScoreConfig& config);

}  // namespace mh
