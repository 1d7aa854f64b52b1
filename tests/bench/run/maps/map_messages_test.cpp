// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/map_messages.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "scenes/recordings/messages/marker_types.hpp"
#include "scenes/recordings/messages/message_file.hpp"
#include "scenes/recordings/messages/robot_types.hpp"
#include "slam/io/temporary_folder.hpp"
#include "slam/occupancy/cost_map.hpp"
#include "source_dir.hpp"
#include "tests/slam/occupancy/made_map.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class MapMessages : public testing::TestWithParam<ros::Wire> {
 protected:
  /// The messages of a written map by topic.
  std::map<std::string, std::string> written(const VoxelMap& map, const MapStudy& study) {
    const fs::path file = work_.path() / "map";
    const bool mcap = GetParam() == ros::Wire::kCdr;
    write_map_messages(mcap ? *write_mcap(file) : *write_bag(file), map, study);
    std::map<std::string, std::string> messages;
    (mcap ? open_mcap : open_bag)(map_file(file), "map",
                                  [&](const MessageChannel& channel, std::string_view message,
                                      const MessagePlace&) { messages[channel.topic] = message; });
    return messages;
  }
  template <class M>
  static M parsed(const std::map<std::string, std::string>& messages, const char* topic) {
    return ros::parsed<M>(messages.at(topic), GetParam());
  }

  TemporaryFolder work_{fs::temp_directory_path()};
};

TEST_P(MapMessages, HoldGridCostsObjectsAndVoxels) {
  const ClassId chair = 5, table = 7;
  MadeMap made;
  for (int x = 0; x < 60; ++x)
    for (int y = 0; y < 40; ++y) made.free({x, y, 4});
  made.box({20, 10, 2}, {27, 17, 8}, chair);
  made.box({45, 20, 2}, {54, 35, 12}, table);
  const VoxelMap map = made.map();
  const MapStudy study = study_of(map, {});
  ASSERT_EQ(study.objects.size(), 2U);
  const auto messages = written(map, study);
  ASSERT_EQ(messages.size(), 4U);
  EXPECT_TRUE(holds_map_messages(work_.path() / "map"));
  EXPECT_FALSE(holds_map_messages(std::string(MH_SOURCE_DIR) + "/tests/fuzz/seeds/bag/bz2.bag"));

  const auto grid = parsed<ros::OccupancyGrid>(messages, "/map");
  EXPECT_EQ(grid.header.frame_id, "map");
  EXPECT_EQ(grid.info.width, static_cast<std::uint32_t>(study.grid.cells.width()));
  EXPECT_EQ(grid.info.height, static_cast<std::uint32_t>(study.grid.cells.height()));
  EXPECT_FLOAT_EQ(grid.info.resolution, 0.05F);
  EXPECT_EQ(grid.info.origin.position.x, study.grid.origin_m.x());
  EXPECT_EQ(grid.info.origin.position.y, study.grid.origin_m.y());
  EXPECT_TRUE(std::ranges::equal(grid.data, study.grid.cells));
  EXPECT_NE(std::ranges::count(grid.data, kOccupiedCell), 0);
  const auto costs = parsed<ros::OccupancyGrid>(messages, "/global_costmap/costmap");
  EXPECT_TRUE(std::ranges::equal(costs.data, as_published(cost_map(study.grid)).cells));

  const auto objects = parsed<ros::MarkerArray>(messages, "/objects");
  ASSERT_EQ(objects.markers.size(), 4U);
  const ros::Marker& box = objects.markers[0];
  EXPECT_EQ(box.type, ros::Marker::kCube);
  EXPECT_DOUBLE_EQ(box.pose.position.x, study.objects[0].center_m.x());
  EXPECT_DOUBLE_EQ(box.scale.z, study.objects[0].max_m.z() - study.objects[0].min_m.z());
  EXPECT_EQ(objects.markers[1].type, ros::Marker::kText);
  EXPECT_EQ(objects.markers[1].text, "chair 1 (1.00)");
  EXPECT_GT(objects.markers[1].pose.position.z, study.objects[0].max_m.z());

  const auto voxels = parsed<ros::Marker>(messages, "/voxels");
  EXPECT_EQ(voxels.points.size(), 8U * 8 * 7 + 10 * 16 * 11);
  EXPECT_EQ(voxels.colors.size(), voxels.points.size());
  EXPECT_FLOAT_EQ(static_cast<float>(voxels.scale.x), 0.05F);
}

INSTANTIATE_TEST_SUITE_P(Both, MapMessages, testing::Values(ros::Wire::kRos1, ros::Wire::kCdr));

}  // namespace
}  // namespace mh
