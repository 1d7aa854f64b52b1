// SPDX-License-Identifier: Apache-2.0
#include "bench/run/forecast.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

RunSpec run_of(const std::string& system, const std::string& environment) {
  RunSpec spec;
  spec.system.name = system;
  spec.environment.name = environment;
  return spec;
}

TEST(Forecast, TakesTheMeanOfTheNearestKindThatHasFinished) {
  Forecast forecast;
  EXPECT_EQ(forecast.of(run_of("plain", "office")), std::nullopt);
  forecast.note(run_of("plain", "office"), 10);
  forecast.note(run_of("plain", "office"), 20);
  forecast.note(run_of("plain", "lobby"), 60);
  forecast.note(run_of("theirs", "lobby"), 2);
  EXPECT_EQ(forecast.of(run_of("plain", "office")), 15);
  EXPECT_EQ(forecast.of(run_of("plain", "bookshop")), 30) << "the system elsewhere";
  EXPECT_EQ(forecast.of(run_of("semantic", "office")), 23) << "any run";
}

TEST(Forecast, TellsNoTimeBeforeItIsKnown) {
  const RunSpec plain = run_of("plain", "office"), theirs = run_of("theirs", "office");
  const Forecast forecast;
  EXPECT_EQ(forecast.of_all({&plain}), std::nullopt) << "one waits of which nothing is known";
  EXPECT_EQ(forecast.of_all({}), 0);
  EXPECT_EQ(forecast.to_go_s(0, {{theirs, 50, 2, 0.01}}, 1), std::nullopt)
      << "a hundredth of the work, most of the time spent on light";
  EXPECT_EQ(forecast.to_go_s(0, {{theirs, 50, 30, 0.25}}, 1), 90) << "by the share that is done";
}

TEST(Forecast, SumsWhatIsLeftOverTheJobsButNoShorterThanTheLongestRun) {
  const RunSpec plain = run_of("plain", "office"), theirs = run_of("theirs", "office");
  Forecast forecast;
  forecast.note(plain, 100);
  forecast.note(theirs, 10);
  // The run in progress has 90 s left; the waiting runs need 100 and 10 s.
  const double both_s = forecast.of_all({&plain, &theirs}).value();
  EXPECT_EQ(forecast.to_go_s(both_s, {{plain, 10, 0, 0}}, 1), 200);
  EXPECT_EQ(forecast.to_go_s(both_s, {{plain, 10, 0, 0}}, 2), 100);
  EXPECT_EQ(forecast.to_go_s(forecast.of_all({&theirs}).value(), {{plain, 10, 0, 0}}, 8), 90);
}

}  // namespace
}  // namespace mh
