// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "bench/results/rows.hpp"

namespace mh {

/// The paper's Figure 4: for each system, level and kind of labels, the mean position error (m,
/// after SE(3) alignment) in each window of kWindow frames. The mean is over the environments whose
/// tours reach that far and are tracked there; their number is given, too. For a sweep, the figure
/// shows its first point. Each environment counts with its mean over trials; the 95 % interval is
/// that of a mean over independent environments. Null without ground truth.
inline constexpr std::size_t kWindow = 30;
nlohmann::ordered_json error_by_frame_json(const Suite& suite, std::span<const Row> rows);

/// The paper's Figure 3: a row per environment and system with the number of objects per 10 m² of
/// floor. Only generated environments state how many objects they hold; null if the suite has none.
nlohmann::ordered_json density_json(const Suite& suite, std::span<const Row> rows);

/// Answers at the points of a sweep, with Wilson's intervals, and the point with the most correct
/// answers; null without a sweep.
nlohmann::ordered_json sweep_pages_json(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
