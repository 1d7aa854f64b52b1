// SPDX-License-Identifier: Apache-2.0
#pragma once

// How figures are listed. Beside each struct of scores stands the list of its fields:
// `fields(score, visit)` calls visit(Metric, value) for each, a double or, where it may be unknown,
// an optional one. Its brackets name every field of the struct, so that a field without a line does
// not compile. Files, tables, exports and the gate are made from the lists: a new figure is a
// field, its line, and what computes it.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "slam/core/fields.hpp"

namespace mh {

enum class Better { kNeither, kLess, kMore };

/// What is known of a figure, wherever it is stored, printed or judged.
struct Metric {
  std::string name;                  ///< its key in JSON, CSV, SQL and the gate
  std::string_view heading{};        ///< of its column in the tables; empty: it has none
  std::string_view unit{};           ///< "m"; "%": a share, stored as 0 to 1 and printed times 100
  int decimals = 0;                  ///< in tables
  Better better = Better::kNeither;  ///< where it is kNeither the gate does not judge it
  std::string count{};               ///< of a share: the figure that holds its denominator
  bool in_overview = false;          ///< stands in tables of many places or settings as well
};

struct Figure {
  Metric metric;
  std::optional<double> value;
};

/// "0.0123", "87.50%"; "-" of what is unknown.
std::string shown(const Figure& figure);

/// The figures of a score, in the order of its list.
template <class Score>
std::vector<Figure> figures_of(const Score& score) {
  std::vector<Figure> figures;
  const auto add = [&](const Metric& metric, const std::optional<double>& value) {
    figures.push_back({metric, value});
  };
  fields(score, add);
  return figures;
}

/// One value of many, known or unknown; unknown where nothing can be said.
using Reduction = std::function<std::optional<double>(std::span<const std::optional<double>>)>;

/// Field by field, one score of many.
template <class Score>
Score reduce(std::span<const Score> scores, const Reduction& reduction) {
  std::vector<std::vector<std::optional<double>>> values;
  for (const Score& score : scores) {
    std::size_t field = 0;
    const auto note = [&](const Metric&, const std::optional<double>& value) {
      if (field == values.size()) values.emplace_back();
      values[field++].push_back(value);
    };
    fields(score, note);
  }
  Score result;
  std::size_t field = 0;
  const auto set = [&](const Metric&, auto& value) {
    const auto reduced = field < values.size() ? reduction(values[field]) : std::nullopt;
    ++field;
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      value = reduced.value_or(0);
    else
      value = reduced;
  };
  fields(result, set);
  return result;
}

}  // namespace mh
