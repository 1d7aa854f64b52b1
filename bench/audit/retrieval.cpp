// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/retrieval.hpp"

#include <algorithm>

namespace mh {
namespace {

std::size_t relevant_among_first(std::size_t k, const Relevance& ranked) {
  const auto end = ranked.begin() + static_cast<std::ptrdiff_t>(std::min(k, ranked.size()));
  return static_cast<std::size_t>(
      std::count_if(ranked.begin(), end, [](unsigned char r) { return r != 0; }));
}

}  // namespace

std::optional<double> average_precision(const Relevance& ranked, std::size_t relevant) {
  if (relevant == 0) return std::nullopt;
  double sum = 0;
  std::size_t found = 0;
  for (std::size_t i = 0; i < ranked.size(); ++i)
    if (ranked[i] != 0) sum += static_cast<double>(++found) / static_cast<double>(i + 1);
  return sum / static_cast<double>(relevant);
}

double precision_at(std::size_t k, const Relevance& ranked) {
  return static_cast<double>(relevant_among_first(k, ranked)) / static_cast<double>(k);
}

std::optional<double> recall_at(std::size_t k, const Relevance& ranked, std::size_t relevant) {
  if (relevant == 0) return std::nullopt;
  return static_cast<double>(relevant_among_first(k, ranked)) / static_cast<double>(relevant);
}

}  // namespace mh
