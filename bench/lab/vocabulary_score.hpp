// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "scenes/recordings/tum_folder.hpp"
#include "slam/core/se3.hpp"
#include "slam/features/features.hpp"
#include "slam/semantics/augmented_vector.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// An image with a known pose, by which we judge which images show the same place.
struct PlacedView {
  Stamp stamp_ns = 0;
  SE3 world_from_camera;
  Features features;
  Grid2d<float> depth_m;  ///< every kStep-th pixel of every kStep-th row
  static constexpr int kStep = 8;
};

/// Share of the points measured by `a` that `b` sees, too: these are in the image of `b` and at
/// most 10 % farther from its camera than what `b` measured there. 0 if `a` measured nothing.
double overlap(const PlacedView& a, const PlacedView& b, const Camera& camera);

struct VocabularyScoreConfig {
  double min_overlap = 0.5;  ///< views with at least this overlap show the same place
  double min_gap_s = 2.0;    ///< within one sequence, least time between query and candidate
  int every = 1;             ///< take every n-th image of a sequence, >= 1
  FeatureConfig features;
};

/// How well words alone retrieve the views of a place.
struct VocabularyScore {
  int views = 0;              ///< number of candidates
  int queries = 0;            ///< number of queries with a true neighbor among their candidates
  double words_per_view = 0;  ///< mean number of distinct words in a query
  std::optional<double> label_mass;  ///< mean share of labels at gamma = 1; absent without labels
  double precision = 0;              ///< share of queries whose most similar candidate is true
  double average_precision = 0;      ///< mean over queries (area under the precision-recall curve)
  double chance = 0;                 ///< mean share of true neighbors among candidates
};

/// Reads a folder in TUM's layout with its groundtruth.txt. Images without a pose within 0.02 s are
/// left out.
/// @param notes  receives what else was left out
/// @throws InputError naming file and line.
std::vector<PlacedView> load_placed_views(const std::filesystem::path& folder,
                                          const RecordedCamera& camera,
                                          const VocabularyScoreConfig& config,
                                          std::vector<std::string>& notes);

/// Ranks the views by l1_similarity() to each query; ties are in the order of the views. If there
/// are no queries, each view is a query for the others. @throws InputError if no query has a true
/// neighbor.
VocabularyScore score_vocabulary(const Vocabulary& vocabulary, std::span<const PlacedView> views,
                                 std::span<const PlacedView> queries, const Camera& camera,
                                 const VocabularyScoreConfig& config);

}  // namespace mh
