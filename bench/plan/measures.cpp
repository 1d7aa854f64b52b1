// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/measures.hpp"

#include <algorithm>
#include <array>

namespace mh {
namespace {

using enum Better;

constexpr std::array kMeasures = {
    Measure{"completeness", kMore, "", "offered"},
    Measure{"ate_rmse_m", kLess, "m", ""},
    Measure{"rpe_frame_rmse_m", kLess, "m", ""},
    Measure{"restarts", kLess, "", ""},
    Measure{"penalized", kLess, "", ""},
    Measure{"dropped", kLess, "", ""},
    Measure{"held_out.success", kMore, "", "held_out.queries"},
    Measure{"held_out.correct", kMore, "", "held_out.queries"},
    Measure{"held_out.false", kLess, "", "held_out.queries"},
    Measure{"held_out.distance_median_m", kLess, "m", ""},
    Measure{"second_tour.success", kMore, "", "second_tour.queries"},
    Measure{"second_tour.correct", kMore, "", "second_tour.queries"},
    Measure{"second_tour.false", kLess, "", "second_tour.queries"},
    Measure{"second_tour.distance_median_m", kLess, "m", ""},
};

}  // namespace

std::span<const Measure> measures() {
  return kMeasures;
}

const Measure* find_measure(std::string_view name) {
  const auto found = std::ranges::find(kMeasures, name, &Measure::name);
  return found == kMeasures.end() ? nullptr : &*found;
}

}  // namespace mh
