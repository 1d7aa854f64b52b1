// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/protocol/metrics/metric.hpp"

namespace mh {

/// Summary of many episodes.
struct EpisodeSummary {
  double count = 0;
  double success = 0;              ///< share
  double located = 0;              ///< share in which the robot ever believed itself located
  double spl = 0;                  ///< mean
  std::optional<double> median_s;  ///< of the times of the successful episodes
  double collided = 0, wrong_arrivals = 0;  ///< shares
  double worst_contact_m_per_s = 0;
};

template <MaybeConst<EpisodeSummary> S, class Visit>
void fields(S& summary, Visit& v) {
  using enum Better;
  auto& [count, success, located, spl, median_s, collided, wrong_arrivals, worst_contact_m_per_s] =
      summary;
  v(Metric{"count", "episodes"}, count);
  v(Metric{"success", "success", "%", 2, kMore, "count"}, success);
  v(Metric{"located", "located", "%", 2, kMore, "count"}, located);
  v(Metric{"spl", "SPL", "", 2, kMore}, spl);
  v(Metric{"median_s", "median time", "s", 1, kLess}, median_s);
  v(Metric{"collided", "collided", "%", 2, kLess, "count"}, collided);
  v(Metric{"wrong_arrivals", "wrong arrivals", "%", 2, kLess, "count"}, wrong_arrivals);
  v(Metric{"worst_contact_m_per_s", "worst contact", "m/s", 2, kLess}, worst_contact_m_per_s);
}

}  // namespace mh
