// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace mh {

/// Whether each item of a ranked list is relevant, best first.
using Relevance = std::vector<unsigned char>;

/// Mean, over all relevant items, of the precision at their ranks; a relevant item that is not in
/// the list counts as 0. Absent if nothing is relevant.
/// @param relevant  number of relevant items, in the list or not
std::optional<double> average_precision(const Relevance& ranked, std::size_t relevant);

/// Share of the first k items that are relevant; positions beyond the end of the list count as not
/// relevant.
/// @pre k > 0
double precision_at(std::size_t k, const Relevance& ranked);

/// Share of the relevant items that are among the first k; absent if nothing is relevant.
std::optional<double> recall_at(std::size_t k, const Relevance& ranked, std::size_t relevant);

}  // namespace mh
