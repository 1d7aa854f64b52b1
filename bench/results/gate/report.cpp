// SPDX-License-Identifier: Apache-2.0
#include "bench/results/gate/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "slam/io/counted.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

std::string shown(const std::optional<double>& value) {
  return value ? fmt::format("{:.4f}", *value) : "-";
}

std::string shown_change(double change) {
  if (std::isinf(change)) return "lost or gained";
  return fmt::format("{:+.4f}", change);
}

/// "blank_corridor, semantic-exact-pepper: completeness fell by 0.4600 (0.9800 -> 0.5200; ...)"
std::string sentence(const Change& c) {
  if (std::isinf(c.change))
    return fmt::format(
        "{}, {}: {} {} in most runs ({} -> {})", c.scenario, c.system, c.measure->name,
        c.verdict == ChangeVerdict::kWorse ? "is undetermined now" : "is determined now",
        shown(c.before), shown(c.after));
  const std::string_view unit = c.measure->unit == "%" ? "" : c.measure->unit;
  return fmt::format("{}, {}: {} {} by {:.4f}{}{} ({} -> {}; tolerance {:.4f}, {})", c.scenario,
                     c.system, c.measure->name, c.change > 0 ? "rose" : "fell", std::abs(c.change),
                     unit.empty() ? "" : " ", unit, shown(c.before), shown(c.after), c.tolerance,
                     counted(c.pairs, "seed"));
}

std::string list(const GateResult& result, ChangeVerdict verdict, const std::string& heading) {
  std::string text;
  for (const Change& c : result.changes)
    if (c.verdict == verdict) text += "  " + sentence(c) + "\n";
  return text.empty() ? text : heading + "\n" + text;
}

std::string table(const GateResult& result) {
  std::string text =
      fmt::format("{:<31}{:>9}{:>9}{:>16}{:>11}{:>10}  {}\n", "scenario, system, measure", "before",
                  "after", "median change", "tolerance", "would see", "");
  std::string head;
  for (const Change& c : result.changes) {
    const std::string group = fmt::format("{}, {}", c.scenario, c.system);
    if (group != head) text += group + "\n";
    head = group;
    text += fmt::format("  {:<29}{:>9}{:>9}{:>16}{:>11.4f}{:>10.4f}  {}\n", c.measure->name,
                        shown(c.before), shown(c.after), shown_change(c.change), c.tolerance,
                        c.detectable, name(c.verdict));
  }
  if (std::ranges::any_of(result.changes, [](const Change& c) { return !c.repeatable; }))
    text += fmt::format(
        "a system that is not repeatable is worse where its change exceeds the tolerance by more "
        "than chance (95 %, by the spread over its runs)\n");
  return text;
}

std::string origin_line(const GateResult& result) {
  return fmt::format(
      "equal to the baseline bit for bit: {} of {}{}\n", result.identical,
      counted(result.runs, "run"),
      result.same_origin ? ", and all of repeatable systems must be: same program, same kind of "
                           "machine"
      : result.changed_settings.empty() ? "; they need not be: another program or machine made it"
                                        : "; they need not be: it was made with other settings");
}

std::string settings_lines(const GateResult& result) {
  std::string text;
  for (const std::string& setting : result.changed_settings) text += "  " + setting + "\n";
  return text.empty() ? text : "settings, the baseline's -> these:\n" + text;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') out += c;
    }
  return out;
}

std::string junit_case(const std::string& classname, const std::string& name,
                       const std::string& failure) {
  const std::string head =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\"", escaped(classname), escaped(name));
  if (failure.empty()) return head + "/>\n";
  return head +
         fmt::format(">\n      <failure message=\"{}\"/>\n    </testcase>\n", escaped(failure));
}

struct JunitSuite {
  std::string cases;
  int tests = 0, failures = 0;
  void add(const std::string& classname, const std::string& name, const std::string& failure) {
    cases += junit_case(classname, name, failure);
    ++tests;
    failures += failure.empty() ? 0 : 1;
  }
};

}  // namespace

std::string gate_report(const GateResult& result, const std::string& suite) {
  std::string text = table(result) + "\n" + origin_line(result) + settings_lines(result);
  text +=
      "would see: a true worsening of this size fails the gate with 80 % power; chance alone as it "
      "shows between the baseline's seeds\n\n";
  if (!result.not_measured.empty()) {
    text += "not measured, neither before nor now, whatever the tolerance:\n";
    for (const std::string& what : result.not_measured) text += "  " + what + "\n";
  }
  text += list(result, ChangeVerdict::kBetter,
               "better than the baseline (keep it with --update, or later loss goes unseen):");
  text += list(result, ChangeVerdict::kWorse, "worse than the baseline:");
  if (!result.unrepeatable.empty()) {
    text += result.settings_known
                ? "not repeatable: same program, same settings, same machine, different bits:\n"
                : "not repeatable: same program, same machine, different bits; or other settings "
                  "(`slam`, vocabulary), which this baseline does not record (--update makes one "
                  "that does):\n";
    for (const std::string& run : result.unrepeatable) text += "  " + run + "\n";
  }
  text += fmt::format("{}: {}: {} of {} measures worse, {} better\n", suite,
                      result.passed() ? "passed" : "FAILED", result.worse(), result.changes.size(),
                      result.better());
  return text;
}

Json gate_json(const GateResult& result, const std::string& suite) {
  const auto number = [](const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(*value) : Json();
  };
  Json changes = Json::array();
  for (const Change& c : result.changes)
    changes.push_back({{"scenario", c.scenario},
                       {"system", c.system},
                       {"measure", c.measure->name},
                       {"seeds", c.pairs},
                       {"before", number(c.before)},
                       {"after", number(c.after)},
                       {"change", number(c.change)},
                       {"tolerance", c.tolerance},
                       {"detectable", c.detectable},
                       {"verdict", name(c.verdict)}});
  return {{"suite", suite},
          {"passed", result.passed()},
          {"runs", result.runs},
          {"identical", result.identical},
          {"same_origin", result.same_origin},
          {"changed_settings", result.changed_settings},
          {"unrepeatable", result.unrepeatable},
          {"not_measured", result.not_measured},
          {"changes", changes}};
}

std::string gate_junit(const GateResult& result, const std::string& suite) {
  std::vector<std::pair<std::string, JunitSuite>> suites;
  const auto of = [&](const std::string& scenario) -> JunitSuite& {
    for (auto& [name, s] : suites)
      if (name == scenario) return s;
    return suites.emplace_back(scenario, JunitSuite{}).second;
  };
  for (const Change& c : result.changes)
    of(c.scenario)
        .add(suite + "." + c.scenario, fmt::format("{} {}", c.system, c.measure->name),
             c.verdict == ChangeVerdict::kWorse ? sentence(c) : "");
  if (result.same_origin) {
    std::string differing;
    for (const std::string& run : result.unrepeatable)
      differing += (differing.empty() ? "" : "; ") + run;
    of("repeatability").add(suite + ".repeatability", "same bits", differing);
  }
  int tests = 0, failures = 0;
  std::string body;
  for (const auto& [name, s] : suites) {
    tests += s.tests, failures += s.failures;
    body +=
        fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\">\n{}  </testsuite>\n",
                    escaped(name), s.tests, s.failures, s.cases);
  }
  return fmt::format("{}<testsuites name=\"{}\" tests=\"{}\" failures=\"{}\">\n{}</testsuites>\n",
                     kJunitHead, escaped(suite), tests, failures, body);
}

std::string failures_junit(std::span<const FailedRun> failed, const std::string& suite) {
  std::string cases;
  for (const FailedRun& run : failed)
    cases += fmt::format(
        "    <testcase classname=\"{0}.runs\" name=\"{1}\">\n      <error message=\"{2}\"/>\n"
        "    </testcase>\n",
        escaped(suite), escaped(run.spec.name), escaped(run.error));
  return fmt::format(
      "{3}<testsuites name=\"{0}\" tests=\"{1}\" errors=\"{1}\">\n"
      "  <testsuite name=\"runs\" tests=\"{1}\" errors=\"{1}\">\n{2}"
      "  </testsuite>\n</testsuites>\n",
      escaped(suite), failed.size(), cases, kJunitHead);
}

}  // namespace mh
