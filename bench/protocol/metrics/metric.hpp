// SPDX-License-Identifier: Apache-2.0
#pragma once

// How figures are listed. Next to each struct of scores is the list of its fields: `fields(score,
// visit)` calls visit(Metric, value) for each; the value is a double or, if it may be unknown, an
// optional one. Its structured binding names every field of the struct, so that it does not compile
// if a field is missing there. Files, tables, exports and the gate are generated from these lists:
// a new figure needs a field, its line in the list, and the code that computes it.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "slam/io/fields.hpp"

namespace mh {

enum class Better { kNeither, kLess, kMore };

/// Describes a figure wherever it is stored, printed or judged.
struct Metric {
  std::string name;                  ///< its key in JSON, CSV, SQL and the gate
  std::string_view heading{};        ///< of its column in the tables; empty: no column
  std::string_view unit{};           ///< "m"; "%": a share, stored as 0 to 1 and printed times 100
  int decimals = 0;                  ///< in tables
  Better better = Better::kNeither;  ///< kNeither: the gate does not judge it
  std::string count{};       ///< for a share: the name of the figure that is its denominator
  bool in_overview = false;  ///< also shown in tables of many places or settings
};

struct Figure {
  Metric metric;
  std::optional<double> value;
};

/// The value as printed: "0.0123", "87.50%"; "-" if unknown.
std::string shown(const Figure& figure);

/// Returns a score's figures in the order of its fields().
template <class Score>
std::vector<Figure> figures_of(const Score& score) {
  std::vector<Figure> figures;
  const auto add = [&](const Metric& metric, const std::optional<double>& value) {
    figures.push_back({metric, value});
  };
  fields(score, add);
  return figures;
}

/// Reduces many values, known or unknown, to one; the result is unknown if it cannot be determined.
using Reduction = std::function<std::optional<double>(std::span<const std::optional<double>>)>;

/// Reduces many scores to one, field by field.
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
