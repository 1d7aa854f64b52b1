// SPDX-License-Identifier: Apache-2.0
#include "bench/report/comparisons_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

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

std::string comparison_line(const PairNames& names, const Comparison& c) {
  if (c.pairs == 0) return fmt::format("  {:<61} -  (no pairs)\n", c.what.text());
  const Verdict v = verdict(c);
  const std::string word =
      v == Verdict::kFirstBetter    ? names.first + " is better"
      : v == Verdict::kSecondBetter ? names.second + " is better"
      : std::isfinite(c.detectable)
          ? fmt::format("undecided; smallest detectable difference {:.4f}", c.detectable)
          : std::string("undecided; too few pairs");
  const std::string corrected =
      c.in_family ? fmt::format("(Holm {})  {}", p_text(c.p_holm), word)
      : c.clusters > 0
          ? fmt::format("(outside the family; {} of {} as clusters)",
                        counted(c.pairs, "query", "queries"), counted(c.clusters, "scene"))
          : "(outside the family)";
  const std::string p = p_text(c.p);
  return fmt::format("  {:<61} {:+.4f} {}  p {}{} {}\n", c.what.text(), c.difference, interval(c),
                     p.starts_with('<') ? "" : "= ", p, corrected);
}

/// The line to print below a comparison by the suite's measure: whether the first system is shown
/// not to be worse by more than the suite's margin. Empty for other comparisons, or if the suite
/// states no margin.
std::string margin_line(const Suite& suite, const PairNames& names, const Comparison& c) {
  if (!suite.non_inferiority_margin || c.pairs == 0 || c.what.measure != name(suite.measure))
    return "";
  const double margin = *suite.non_inferiority_margin;
  const std::string finding = fmt::format("{} is not worse", names.first);
  return fmt::format("  {:<61} {} by more than the {:.3f} stated beforehand\n", "",
                     not_inferior(c, margin) ? finding
                     : enough_for(c, margin) ? "not shown that " + finding
                                             : "too few pairs to show that " + finding,
                     margin);
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
  return "  an interval ends at 0 where few differ: resamples without these show no difference; p "
         "comes from the signs of these few\n";
}

}  // namespace

std::string interval(const Comparison& c) {
  return std::isfinite(c.low) && std::isfinite(c.high)
             ? fmt::format("[{:+.4f}, {:+.4f}]", c.low, c.high)
             : std::string("-");
}

std::string comparisons_text(const Suite& suite, const Family& family) {
  std::string text = heading(suite, family.systems, family.level, family.comparisons,
                             "blocks of queries resampled, 95 % intervals", " and distance");
  if (suite.trials == 1)
    text += "  one trial: this holds for these maps; other seeds draw other maps (--trials 10)\n";
  const PairNames names(suite, family.systems);
  for (const Comparison& c : family.comparisons)
    text += comparison_line(names, c) + margin_line(suite, names, c);
  return text + zero_text(family.comparisons);
}

std::string comparisons_text(const Suite& suite, const SceneFamily& family) {
  std::string text =
      heading(suite, family.systems, family.level, family.comparisons,
              "scenes resampled, 95 % intervals, Wilcoxon signed-rank", ", distance and ATE");
  const PairNames names(suite, family.systems);
  const std::size_t scenes = suite.environments.size();
  for (const Comparison& c : family.comparisons) {
    if (c.clusters == 0 && c.pairs < scenes)
      text += fmt::format("  over {} of {}, where both have a value:\n", c.pairs,
                          counted(scenes, "scene"));
    text += comparison_line(names, c) + margin_line(suite, names, c);
  }
  return text + zero_text(family.comparisons);
}

}  // namespace mh
