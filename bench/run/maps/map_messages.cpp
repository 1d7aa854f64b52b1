// SPDX-License-Identifier: Apache-2.0
#include "bench/run/maps/map_messages.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "bench/report/drawing/false_colors.hpp"
#include "scenes/recordings/messages/marker_types.hpp"
#include "scenes/recordings/messages/message_file.hpp"
#include "scenes/recordings/messages/robot_types.hpp"
#include "scenes/recordings/ros/names.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/occupancy/cost_map.hpp"

namespace mh {
namespace {

constexpr std::array kTopics = {"/map", "/global_costmap/costmap", "/objects", "/voxels"};

ros::OccupancyGrid grid_message(const OccupancyGrid& grid) {
  ros::OccupancyGrid message;
  message.header.frame_id = ros::kMapFrame;
  message.info.resolution = static_cast<float>(grid.resolution_m);
  message.info.width = static_cast<std::uint32_t>(grid.cells.width());
  message.info.height = static_cast<std::uint32_t>(grid.cells.height());
  message.info.origin.position = {grid.origin_m.x(), grid.origin_m.y(), 0};
  message.data.assign(grid.cells.begin(), grid.cells.end());
  return message;
}

ros::ColorRgba color_of(ClassId class_id, float opacity) {
  const Rgb8 c = class_color(class_id);
  return {static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255,
          static_cast<float>(c.b) / 255, opacity};
}

ros::Point point_message(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

ros::MarkerArray objects_message(const std::vector<MapObject>& objects) {
  ros::MarkerArray message;
  for (const MapObject& object : objects) {
    ros::Marker marker;
    marker.header.frame_id = ros::kMapFrame;
    marker.id = static_cast<std::int32_t>(message.markers.size());
    marker.ns = "boxes";
    marker.type = ros::Marker::kCube;
    marker.pose.position = point_message(object.center_m);
    const Eigen::Vector3d size_m = object.max_m - object.min_m;
    marker.scale = {size_m.x(), size_m.y(), size_m.z()};
    marker.color = color_of(object.class_id, 0.4F);
    message.markers.push_back(marker);
    marker.id += 1;
    marker.ns = "names";
    marker.type = ros::Marker::kText;
    marker.pose.position.z = object.max_m.z() + 0.1;
    marker.scale = {0, 0, 0.12};
    marker.color = {1, 1, 1, 1};
    marker.text = fmt::format("{} ({:.2f})", object.name, object.score);
    message.markers.push_back(std::move(marker));
  }
  return message;
}

ros::Marker voxels_message(const VoxelMap& map) {
  ros::Marker marker;
  marker.header.frame_id = ros::kMapFrame;
  marker.ns = "voxels";
  marker.type = ros::Marker::kCubeList;
  const double side_m = map.resolution_m();
  marker.scale = {side_m, side_m, side_m};
  map.for_each([&](const Voxel& voxel) {
    if (!voxel.occupied) return;
    marker.points.push_back(point_message(voxel.center_m(side_m)));
    marker.colors.push_back(color_of(voxel.label, 1));
  });
  return marker;
}

}  // namespace

void write_map_messages(MessageWriter& file, const VoxelMap& map, const MapStudy& study) {
  const auto write_once = [&]<class M>(const char* topic, const M& message) {
    const std::uint16_t number = file.add_topic(topic_spec<M>(topic, file.wire(), true));
    file.write(number, 0, ros::serialized(message, file.wire()));
  };
  write_once(kTopics[0], grid_message(study.grid));
  write_once(kTopics[1], grid_message(as_published(cost_map(study.grid))));
  write_once(kTopics[2], objects_message(study.objects));
  write_once(kTopics[3], voxels_message(map));
  file.finish();
}

bool holds_map_messages(const std::filesystem::path& file) {
  const HeldBytes bytes = map_file(file, MapPages::kAsTouched);
  const auto open = bytes.view.starts_with("#ROSBAG") ? open_bag : open_mcap;
  try {
    const auto held = open(bytes, file.string(), [](auto&&...) {});
    return held->channels().size() == std::size(kTopics) &&
           std::ranges::all_of(held->channels(), [](const MessageChannel& channel) {
             return std::ranges::count(kTopics, channel.topic) > 0;
           });
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace mh
