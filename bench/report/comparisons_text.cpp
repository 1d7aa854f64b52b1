// SPDX-License-Identifier: Apache-2.0
#include "bench/report/comparisons_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/report/text_table.hpp"
#include "slam/io/counted.hpp"

namespace mh {
namespace {

/// The two systems of a family, by name.
struct PairNames {
  const std::string &first, &second;
  PairNames(const Suite& suite, const SystemPair& pair)
      : first(suite.systems[pair.first].name), second(suite.systems[pair.second].name) {}
};

/// "0.0488" or "< 0.0001", since no p is 0.
std::string p_text(double p) {
  return p < 0.00005 ? "< 0.0001" : fmt::format("{:.4f}", p);
}

/// "semantic minus plain, level pepper: HOW, Holm over 4 comparisons of correct", with the text
/// `how` for HOW and followed by `what`.
std::string heading(const Suite& suite, const SystemPair& systems, std::size_t level,
                    std::span<const Comparison> comparisons, const char* how, const char* what) {
  const PairNames names(suite, systems);
  return fmt::format("\n{} minus {}, level {}: {}, Holm over {} of {}{}\n", names.first,
                     names.second, level_name(suite.levels[level]), how,
                     counted(family_size(comparisons), "comparison"), name(suite.measure), what);
}

/// A note on intervals that end at 0, which seem nearly significant; empty if there are none.
std::string zero_text(std::span<const Comparison> comparisons) {
  if (std::ranges::none_of(comparisons, ends_at_zero)) return "";
  return "  an interval that ends at 0: few answers differ, and some resamples have none of them\n";
}

/// "semantic is better", "undecided; detectable from 0.0300" or "not judged".
std::string verdict_text(const PairNames& names, const Comparison& c) {
  if (c.pairs == 0) return "no pairs";
  if (!c.in_family)
    return c.clusters > 0
               ? fmt::format("not judged; {} of {}", counted(c.pairs, "query", "queries"),
                             counted(c.clusters, "scene"))
               : "not judged";
  const Verdict v = verdict(c);
  return v == Verdict::kFirstBetter    ? names.first + " is better"
         : v == Verdict::kSecondBetter ? names.second + " is better"
         : std::isfinite(c.detectable)
             ? fmt::format("undecided; detectable from {:.4f}", c.detectable)
             : "undecided; too few pairs";
}

/// Whether the first system is shown not to be worse by more than the suite's margin. Empty unless
/// the comparison is by the suite's measure and the suite states a margin.
std::string margin_text(const Suite& suite, const PairNames& names, const Comparison& c) {
  if (!suite.non_inferiority_margin || c.pairs == 0 || c.what.measure != name(suite.measure))
    return "";
  const double margin = *suite.non_inferiority_margin;
  const std::string finding = fmt::format("{} is not worse", names.first);
  return fmt::format("  {} by more than the {:.3f} stated beforehand",
                     not_inferior(c, margin) ? finding
                     : enough_for(c, margin) ? "not shown that " + finding
                                             : "too few pairs to show that " + finding,
                     margin);
}

/// The rows of comparisons, each with its verdict. Where fewer than `of` scenes have a value for
/// both systems, their number precedes the verdict; `of` = 0: queries are compared, not scenes.
std::string comparison_rows(const Suite& suite, const SystemPair& systems,
                            std::span<const Comparison> comparisons, std::size_t of) {
  const PairNames names(suite, systems);
  TextTable table({"", "difference", "95 % interval", "p", "Holm"});
  for (const Comparison& c : comparisons) {
    const bool known = c.pairs > 0;
    const std::string among = known && c.clusters == 0 && c.pairs < of
                                  ? fmt::format("{} of {}: ", c.pairs, counted(of, "scene"))
                                  : "";
    table.add({c.what.text(), known ? fmt::format("{:+.4f}", c.difference) : "-",
               known ? interval(c) : "-", known ? p_text(c.p) : "-",
               known && c.in_family ? p_text(c.p_holm) : "-"},
              among + verdict_text(names, c));
    if (const std::string margin = margin_text(suite, names, c); !margin.empty())
      table.add_line(margin);
  }
  return table.text() + zero_text(comparisons);
}

}  // namespace

std::string interval(const Comparison& c) {
  return std::isfinite(c.low) && std::isfinite(c.high)
             ? fmt::format("[{:+.4f}, {:+.4f}]", c.low, c.high)
             : std::string("-");
}

std::string comparisons_text(const Suite& suite, const Family& family) {
  std::string text = heading(suite, family.systems, family.level, family.comparisons,
                             "blocks of queries resampled", " and distance");
  if (suite.trials == 1)
    text += "  one trial: this holds for these maps; other seeds draw other maps (--trials 10)\n";
  return text + comparison_rows(suite, family.systems, family.comparisons, 0);
}

std::string comparisons_text(const Suite& suite, const SceneFamily& family) {
  return heading(suite, family.systems, family.level, family.comparisons,
                 "scenes resampled, Wilcoxon", ", distance and ATE") +
         comparison_rows(suite, family.systems, family.comparisons, suite.environments.size());
}

}  // namespace mh
