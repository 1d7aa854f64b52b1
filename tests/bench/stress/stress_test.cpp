// SPDX-License-Identifier: Apache-2.0
#include "bench/run/stress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/report/stress_report.hpp"
#include "bench/suite/shipped.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using testing::HasSubstr;

StressDial dial(const std::string& name, const std::string& unit, double from, double to) {
  StressDial made;
  made.dial = name;
  made.name = name;
  made.unit = unit;
  made.from = from;
  made.to = to;
  return made;
}

/// A suite of the shipped one's rooms, with these dials and 10 bisections.
Suite suite_of(std::vector<StressDial> dials) {
  Suite suite = load_suite(shipped_file("stress", Shipped::kSuite));
  suite.stress->dials = std::move(dials);
  suite.stress->steps = 10;
  return suite;
}

/// A system that answers everything until a dose is exceeded, and nothing beyond.
StressedAt answer(double dose, double share, bool right) {
  return {.dose = dose,
          .result = {.at = share,
                     .right = std::vector(6, right ? 10.0 : 0.0),
                     .asked = std::vector(6, 10.0)},
          .completeness = right ? 1.0 : 0.0,
          .ate_rmse_m = std::nullopt};
}

/// Whether a system answers right at a dose.
using Judge = std::function<bool(std::size_t system, const StressDial& dial, double dose)>;
RunAtDose judged_by(const Judge& judge) {
  return [judge](const std::vector<std::size_t>& systems, const StressDial& dial, double dose,
                 bool is_fault) {
    std::vector<StressedAt> all;
    for (const std::size_t s : systems)
      all.push_back(answer(dose, is_fault ? share_of(dial, dose) : 0, judge(s, dial, dose)));
    return all;
  };
}

TEST(Stress, FindsTheDosesAtWhichOraclesFail) {
  // Depth missing, delay of depth, focal length: fail beyond 35 %, 40 ms, 2 %.
  const Suite suite =
      suite_of({dial("depth_faults.holes", "", 0, 1), dial("depth_offset.offset_ms", "ms", 0, 900),
                dial("told.focal", "", 1, 1.5)});
  const std::vector<double> limits{0.35, 40, 1.02};
  const StressResults results = find_breaking_points(
      suite, judged_by([](std::size_t, const StressDial& at, double dose) {
        return dose <= (at.dial == "told.focal" ? 1.02 : at.unit == "ms" ? 40 : 0.35);
      }),
      {});
  ASSERT_EQ(results.dials_reached, 3U);
  ASSERT_EQ(results.curves.size(), 6U);
  for (const StressCurve& curve : results.curves) {
    const StressDial& at = suite.stress->dials[curve.dial];
    EXPECT_EQ(curve.point.breaks, Breaks::kAtDose) << at.dial;
    const double limit = share_of(at, limits[curve.dial]);
    EXPECT_LE(curve.point.low, limit) << at.dial;
    EXPECT_GE(curve.point.high, limit) << at.dial;
    EXPECT_NEAR(curve.point.at, limit, 0.002) << at.dial;
  }
}

TEST(Stress, AWholeDialIsTriedAtWholeDosesOnly) {
  Suite suite = suite_of({dial("feed.keep_every", "", 1, 12)});
  std::vector<double> tried;
  find_breaking_points(suite, judged_by([&](std::size_t system, const StressDial&, double dose) {
                         if (system == 0) tried.push_back(dose);
                         return dose <= 4;
                       }),
                       {});
  EXPECT_LE(tried.size(), 7U);
  for (const double dose : tried) EXPECT_EQ(dose, std::round(dose));
}

TEST(Stress, SaysWhatStandsWhatFailsAndWhatWasNotReached) {
  const Suite suite = suite_of({dial("lens_blur.sigma_px", "px", 0, 10),
                                dial("jpeg.loss", "", 0, 99), dial("light.flicker", "", 0, 0.9)});
  StressOptions options;
  options.budget_s = 1e-9;
  const RunAtDose answers = judged_by([](std::size_t system, const StressDial&, double dose) {
    return system == 1 || dose <= 2.5;
  });
  const RunAtDose run = [&](const std::vector<std::size_t>& systems, const StressDial& at,
                            double dose, bool is_fault) {
    std::vector<StressedAt> all = answers(systems, at, dose, is_fault);
    if (at.dial == "jpeg.loss" && is_fault) all.back().error = "it crashed";
    return all;
  };
  const StressResults none = find_breaking_points(suite, run, options);
  EXPECT_EQ(none.dials_reached, 0U);
  EXPECT_THAT(stress_text(suite, none),
              HasSubstr("not reached within the budget: lens_blur.sigma_px, "));
  const StressResults all = find_breaking_points(suite, run, {});
  const std::string text = stress_text(suite, all);
  EXPECT_THAT(text, HasSubstr("2.5 (2.5 to 2.51)"));
  EXPECT_THAT(text, HasSubstr("stands 10"));
  EXPECT_THAT(text, HasSubstr("jpeg.loss failed: it crashed"));
  EXPECT_THAT(stress_latex(suite, all), HasSubstr("lens\\_blur.sigma\\_px & px & - & 2.5"));
  EXPECT_THAT(stress_json(suite, all).dump(), HasSubstr("\"breaks\":\"never\""));
}

TEST(Stress, ASystemThatFailsWithoutAFaultIsSaidTo) {
  const Suite suite = suite_of({dial("lens_blur.sigma_px", "px", 0, 10)});
  const StressResults results = find_breaking_points(
      suite, judged_by([](std::size_t, const StressDial&, double) { return false; }), {});
  EXPECT_THAT(stress_text(suite, results), HasSubstr("fails without it"));
  for (const StressCurve& curve : results.curves) EXPECT_EQ(curve.doses.size(), 1U);
}

std::string why_refused(const std::string& section) {
  std::string text = load_suite(shipped_file("stress", Shipped::kSuite)).text;
  text = text.substr(0, text.find("stress:\n  measure")) + section;
  try {
    parse_suite(text, shipped_file("stress", Shipped::kSuite));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StressSpec, RefusesWhatCannotBeMeant) {
  EXPECT_EQ(why_refused("stress: {dials: {light.share: {from: 1, to: 0.1}}}\n"), "");
  EXPECT_THAT(why_refused("stress: {dials: {light.shares: {to: 0.1}}}\n"),
              HasSubstr("did you mean 'light.share'?"));
  EXPECT_THAT(why_refused("stress: {dials: {light.share: {from: 1, to: 2}}}\n"),
              HasSubstr("2 is outside [0, 1]"));
  EXPECT_THAT(why_refused("stress: {dials: {light.share: {from: 1, to: 0, scale: log}}}\n"),
              HasSubstr("log: needs doses above 0"));
  EXPECT_THAT(why_refused("stress: {dials: {jpeg.loss: {to: 50, usual: 20}}}\n"),
              HasSubstr("needs its `source`"));
  EXPECT_THAT(why_refused("stress: {bar: 2, dials: {jpeg.loss: {to: 50}}}\n"),
              HasSubstr("2 is outside"));
  EXPECT_THAT(why_refused("stress: {dials: {}}\n"), HasSubstr("dials"));
}

}  // namespace
}  // namespace mh
