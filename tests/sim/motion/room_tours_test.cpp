// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "scenes/house/house.hpp"
#include "sim/motion/motion.hpp"
#include "source_dir.hpp"
#include "tests/sim/boxes.hpp"
#include "tests/sim/motion/limits_kept.hpp"
#include "tests/sim/motion/nearest_view.hpp"

namespace mh {
namespace {

const std::string kRooms = MH_SOURCE_DIR "/scenes/rooms/";

/// The mapping tour and the query tour of a place in scenes/rooms, driven.
class RoomTours : public testing::TestWithParam<const char*> {
 protected:
  RoomTours()
      : scene_(load_house(kRooms + GetParam() + ".yaml")),
        mapping_(driven("mapping")),
        query_(driven("query")) {}

  DrivenPath driven(const std::string& which) const {
    return drive(scene_, test::pepper(),
                 load_tour(kRooms + "tours/" + GetParam() + "_" + which + ".yaml"));
  }
  std::set<std::string> rooms_of(const DrivenPath& path) const {
    std::set<std::string> rooms;
    for (const TimedPose& pose : path.base)
      for (const Room& room : scene_.rooms) {
        const Eigen::Vector2d at = pose.world_from_camera.translation().head<2>();
        const auto& corners = room.polygon_m;  // rooms are rectangles
        if (((at - corners[0]).array() > 0).all() && ((corners[2] - at).array() > 0).all())
          rooms.insert(room.name);
      }
    return rooms;
  }

  Scene scene_;
  DrivenPath mapping_, query_;
};

TEST_P(RoomTours, TouchNothingAndTheMappingTourSeesAllRooms) {
  for (const DrivenPath* path : {&mapping_, &query_}) {
    EXPECT_LT(path->contact_time_s, 0.1);
    EXPECT_LT(path->max_penetration_m, 1e-3);
    EXPECT_GT(path->camera.size(), 300U);
    test::expect_limits_kept(path->peaks, test::pepper().limits);
  }
  EXPECT_EQ(rooms_of(mapping_).size(), scene_.rooms.size());
  EXPECT_GT(mapping_.length_m, 12.0);
  EXPECT_LT(mapping_.camera.size(), 2500U);
}

TEST_P(RoomTours, MappingComesBackToWhatItSawFirst) {
  double nearest = 1e9;
  const SE3& first = mapping_.camera.front().world_from_camera;
  for (std::size_t i = mapping_.camera.size() / 2; i < mapping_.camera.size(); ++i)
    nearest = std::min(nearest, test::view_distance(first, mapping_.camera[i].world_from_camera));
  EXPECT_LT(nearest, 1.3);
}

TEST_P(RoomTours, QueriesComeFromElsewhere) {
  EXPECT_GT(test::median_distance_to_nearest_view(query_.camera, mapping_.camera), 0.15);
}

INSTANTIATE_TEST_SUITE_P(Places, RoomTours,
                         testing::Values("office", "classroom", "bookshop", "lobby"),
                         [](const auto& place) { return std::string(place.param); });

}  // namespace
}  // namespace mh
