// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/shipped.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "slam/io/error.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

TEST(Shipped, EveryNameLeadsToAFile) {
  for (const Shipped what : {Shipped::kSuite, Shipped::kScene, Shipped::kTour, Shipped::kRobot,
                             Shipped::kLevel, Shipped::kVocabulary, Shipped::kSettings}) {
    const auto names = shipped_names(what);
    EXPECT_FALSE(names.empty()) << static_cast<int>(what);
    for (const std::string& name : names) {
      EXPECT_TRUE(fs::is_regular_file(find_shipped(name, what))) << name;
      EXPECT_EQ(find_shipped(name, what), shipped_file(name, what));
    }
  }
  const fs::path root = MH_SOURCE_DIR;
  EXPECT_EQ(find_shipped("pepper", Shipped::kLevel), root / "sim/sensors/levels/pepper.yaml");
  EXPECT_EQ(find_shipped("pepper", Shipped::kRobot), root / "robots/pepper/pepper.yaml");
  EXPECT_EQ(find_scene("model_house"), root / "scenes/model_house/house.yaml");
  EXPECT_EQ(find_scene("generated:bathroom:3"), "generated:bathroom:3");
  EXPECT_EQ(find_shipped("model_house/query", Shipped::kTour),
            root / "scenes/model_house/tours/query.yaml");
}

TEST(Shipped, APathBelowTheDataIsFoundFromAnywhere) {
  const fs::path here = fs::current_path();
  fs::current_path("/");
  EXPECT_TRUE(fs::is_regular_file(find_shipped("bench/suites/ci.yaml", Shipped::kSuite)));
  fs::current_path(here);
}

TEST(Shipped, AFileOfTheUsersGoesFirstAndAPathIsNoName) {
  const fs::path folder = fs::temp_directory_path() / "mh_shipped";
  fs::create_directories(folder);
  const fs::path here = fs::current_path();
  fs::current_path(folder);
  fs::create_directory("ci");  // a folder of that name is not a suite
  EXPECT_NE(find_shipped("ci", Shipped::kSuite), "ci");
  fs::copy_file(find_shipped("ci", Shipped::kSuite), "rooms");
  EXPECT_EQ(find_shipped("rooms", Shipped::kSuite), "rooms");
  EXPECT_EQ(find_shipped("nowhere/at_all.yaml", Shipped::kSuite), "nowhere/at_all.yaml");
  fs::current_path(here);
  fs::remove_all(folder);
}

TEST(Shipped, ASlipIsToldWhatItMayHaveMeant) {
  try {
    find_shipped("peper", Shipped::kLevel);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "'peper' is not a file, and no sensor level of that name is shipped; did you mean "
                 "'pepper'? There are: handheld, ideal, pepper");
  }
}

}  // namespace
}  // namespace mh
