// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/nearest_stamp.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

namespace mh {
namespace {

using Entry = std::pair<Stamp, std::size_t>;

}  // namespace

double rate_of_hz(const std::vector<Stamp>& stamps_ns) {
  std::vector<Stamp> gaps_ns;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i)
    if (stamps_ns[i] > stamps_ns[i - 1]) gaps_ns.push_back(stamps_ns[i] - stamps_ns[i - 1]);
  if (gaps_ns.empty()) return 30;
  const auto middle = gaps_ns.begin() + static_cast<std::ptrdiff_t>(gaps_ns.size() / 2);
  std::ranges::nth_element(gaps_ns, middle);
  return std::max(0.01, std::round(1e11 / static_cast<double>(*middle)) / 100);
}

StampIndex::StampIndex(const std::vector<Stamp>& stamps_ns) {
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) sorted_.emplace_back(stamps_ns[i], i);
  std::ranges::sort(sorted_);
}

std::optional<std::size_t> StampIndex::nearest(Stamp stamp_ns) const {
  std::optional<std::size_t> best;
  Stamp best_ns = kMaxApart_ns + 1;
  const auto offer = [&](auto place) {  // the first with this stamp
    place = std::ranges::lower_bound(sorted_, place->first, {}, &Entry::first);
    const Stamp apart_ns = std::abs(place->first - stamp_ns);
    if (apart_ns > kMaxApart_ns) return;
    if (apart_ns < best_ns || (apart_ns == best_ns && place->second < *best)) {
      best = place->second;
      best_ns = apart_ns;
    }
  };
  const auto after = std::ranges::lower_bound(sorted_, stamp_ns, {}, &Entry::first);
  if (after != sorted_.begin()) offer(std::prev(after));
  if (after != sorted_.end()) offer(after);
  return best;
}

}  // namespace mh
