// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "bench/results/rows.hpp"

namespace mh {

/// The paper's Figure 4: for each system, level and kind of labels, the mean position error (m,
/// after SE(3) alignment) in each window of kWindow frames, over the environments whose tours reach
/// that far and are tracked there, and the number of these; for a sweep, at its first point. Each
/// environment counts with its mean over trials; the 95 % interval is that of a mean of independent
/// environments. Null without ground truth.
inline constexpr std::size_t kWindow = 30;
nlohmann::ordered_json error_by_frame_json(const Suite& suite, std::span<const Row> rows);

/// The paper's Figure 3: a row per environment and system with the objects per 10 m² of its floor.
/// Only a generated environment states how many objects it holds; null if the suite has none.
nlohmann::ordered_json density_json(const Suite& suite, std::span<const Row> rows);

/// Answers at the points of a sweep, with Wilson's intervals, and the point with the most correct
/// ones; null without a sweep.
nlohmann::ordered_json sweep_pages_json(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
