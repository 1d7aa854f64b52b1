// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "sim/motion/motion.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

constexpr const char* kHead = "name: t\nstart: {position: [1, 2], heading_deg: 90}\n";

Tour load(const std::string& text) {
  const std::string file = testing::TempDir() +
                           testing::UnitTest::GetInstance()->current_test_info()->name() +
                           "_tour_test.yaml";
  write_atomically(file, text);
  return load_tour(file);
}

std::string refusal(const std::string& text) {
  try {
    load(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(LoadTour, ReadsEveryField) {
  const Tour tour = load(std::string(kHead) +
                         "speed_m_per_s: 0.4\nturn_deg_per_s: 45\nwaypoints:\n"
                         "  - {to: [3, 4], face: travel}\n"
                         "  - {to: [5, 6], face: [7, 8]}\n"
                         "  - {to: [6, 6], heading_deg: -90, pause_s: 0.5}\n"
                         "  - {turn_deg: 360}\n");
  EXPECT_EQ(tour.name, "t");
  EXPECT_EQ(tour.start_m, Eigen::Vector2d(1, 2));
  EXPECT_DOUBLE_EQ(tour.start_heading_rad, M_PI_2);
  EXPECT_DOUBLE_EQ(tour.max_velocity_m_per_s.value(), 0.4);
  EXPECT_DOUBLE_EQ(tour.max_turn_rad_per_s.value(), M_PI_4);
  ASSERT_EQ(tour.waypoints.size(), 4U);
  EXPECT_FALSE(tour.waypoints[0].heading_rad || tour.waypoints[0].look_at_m);
  EXPECT_EQ(tour.waypoints[1].look_at_m.value(), Eigen::Vector2d(7, 8));
  EXPECT_DOUBLE_EQ(tour.waypoints[2].heading_rad.value(), -M_PI_2);
  EXPECT_DOUBLE_EQ(tour.waypoints[2].pause_s, 0.5);
  EXPECT_EQ(tour.waypoints[3].position_m, Eigen::Vector2d(6, 6));  // it stays where it was
  EXPECT_DOUBLE_EQ(tour.waypoints[3].turn_rad, 2 * M_PI);
  EXPECT_EQ(tour.waypoints[3].line, 9);
}

TEST(LoadTour, RefusesBadFilesWithLineAndPlace) {
  const auto with = [](const std::string& item) {
    return refusal(std::string(kHead) + "waypoints:\n  - " + item + "\n");
  };
  EXPECT_NE(with("{to: [1]}").find(":4: waypoints[0].to: has 1 numbers"), std::string::npos);
  EXPECT_NE(with("{to: [1, x]}").find("'x' is not a number"), std::string::npos);
  EXPECT_NE(with("{to: [1, 1e9]}").find("1e9 is outside"), std::string::npos);
  EXPECT_NE(with("{too: [1, 2]}").find("too"), std::string::npos);
  EXPECT_NE(with("{}").find("does nothing"), std::string::npos);
  EXPECT_NE(with("{to: [1, 2], face: up}").find("'up' is neither"), std::string::npos);
  EXPECT_NE(with("{to: [1, 2], face: [1, 1], heading_deg: 3}").find("only one"), std::string::npos);
  EXPECT_NE(with("{to: [1, 2], pause_s: -1}").find("-1 is outside"), std::string::npos);
  EXPECT_NE(refusal(std::string(kHead) + "waypoints: []\n").find("at least one"),
            std::string::npos);
  EXPECT_NE(refusal("name: t\nwaypoints: []\n").find("'start' is missing"), std::string::npos);
  EXPECT_THROW(load_tour("/no/such/tour.yaml"), InputError);
}

}  // namespace
}  // namespace mh
