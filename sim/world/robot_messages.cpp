// SPDX-License-Identifier: Apache-2.0
#include "sim/world/robot_messages.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "scenes/floor.hpp"
#include "scenes/recordings/messages/robot_types.hpp"
#include "scenes/recordings/ros/names.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using ros::Header;

/// REP 117: a range sensor that measured nothing reports +infinity.
float range_of(float range_m) {
  return range_m > 0 ? range_m : std::numeric_limits<float>::infinity();
}

ros::Vector3 vector_message(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

class RobotMessages {
 public:
  RobotMessages(ros::Wire wire, const DriveRecord& drive)
      : drive_(drive), path_(drive.path), log_(wire) {}

  MessageLog collect() {
    add_tf();
    add_truth();
    if (has_odometry()) add_odometry();
    if (drive_.readings) add_sensors();
    if (drive_.grid) add_grid();
    log_.sort();
    return std::move(log_);
  }

 private:
  std::size_t count() const { return path_.base.size(); }
  Stamp stamp_ns(std::size_t i) const { return path_.base[i].stamp_ns; }
  Header header(std::size_t i, const std::string& frame) const {
    return {static_cast<std::uint32_t>(i), {stamp_ns(i)}, frame};
  }
  const SE3& world_from_base(std::size_t i) const { return path_.base[i].world_from_camera; }
  bool has_odometry() const { return drive_.readings && !drive_.readings->odometry.empty(); }
  SE3 odom_from_base(std::size_t i) const {
    return has_odometry() ? drive_.readings->odometry[i].world_from_camera : world_from_base(i);
  }
  SE3 base_from_link(std::size_t i) const {
    return world_from_base(i).inverse() * drive_.camera[i].world_from_camera *
           ros::link_from_optical().inverse();
  }

  void add_tf() {
    const std::size_t moving = log_.add_topic<ros::TfMessage>(ros::kTfTopic);
    const std::size_t fixed = log_.add_topic<ros::TfMessage>(ros::kTfStaticTopic, true);
    if (count() == 0) return;
    const Stamp first_ns = stamp_ns(0);
    const bool head_moves = !path_.head.empty();
    ros::TfMessage once;
    const auto fix = [&](const char* parent, const std::string& child, const SE3& pose) {
      once.transforms.push_back(ros::transform_message(first_ns, parent, child, pose));
    };
    fix(ros::kFootprintFrame, ros::kBaseFrame, SE3());
    fix(ros::kCameraFrame, ros::kOpticalFrame, ros::link_from_optical());
    if (!head_moves) fix(ros::kBaseFrame, ros::kCameraFrame, base_from_link(0));
    if (!has_odometry()) fix(ros::kMapFrame, ros::kOdomFrame, SE3());
    if (drive_.robot.equipment) {
      const Equipment& e = *drive_.robot.equipment;
      for (const LaserScanner& laser : e.lasers)
        fix(ros::kBaseFrame, "laser_" + laser.name, laser.base_from_laser);
      for (const Sonar& sonar : e.sonars)
        fix(ros::kBaseFrame, "sonar_" + sonar.name, sonar.base_from_sonar);
      if (e.base_from_imu) fix(ros::kBaseFrame, "imu_link", *e.base_from_imu);
    }
    log_.add(fixed, first_ns, once);
    for (std::size_t i = 0; i < count(); ++i) {
      ros::TfMessage message;
      const auto move = [&](const char* parent, const char* child, const SE3& pose) {
        message.transforms.push_back(ros::transform_message(stamp_ns(i), parent, child, pose));
      };
      const SE3 odom_from = odom_from_base(i);
      if (has_odometry())
        move(ros::kMapFrame, ros::kOdomFrame, world_from_base(i) * odom_from.inverse());
      move(ros::kOdomFrame, ros::kFootprintFrame, odom_from);
      if (head_moves) move(ros::kBaseFrame, ros::kCameraFrame, base_from_link(i));
      log_.add(moving, stamp_ns(i), message);
    }
  }

  void add_truth() {
    const std::size_t topic = log_.add_topic<ros::PoseStamped>(ros::kBaseTruthTopic);
    for (std::size_t i = 0; i < count(); ++i)
      log_.add(topic, stamp_ns(i),
               ros::PoseStamped{header(i, ros::kMapFrame), ros::pose_message(world_from_base(i))});
  }

  void add_odometry() {
    const std::size_t topic = log_.add_topic<ros::Odometry>("/odom");
    for (std::size_t i = 0; i < count(); ++i) {
      ros::Odometry message{header(i, ros::kOdomFrame), ros::kFootprintFrame, {}, {}};
      message.pose.pose = ros::pose_message(odom_from_base(i));
      if (i > 0) {  // the mean since the previous reading, in the base's frame
        const double seconds = 1e-9 * static_cast<double>(stamp_ns(i) - stamp_ns(i - 1));
        const Vector6d step = (odom_from_base(i - 1).inverse() * odom_from_base(i)).log() / seconds;
        message.twist.twist = {vector_message(step.head<3>()), vector_message(step.tail<3>())};
      }
      log_.add(topic, stamp_ns(i), message);
    }
  }

  void add_sensors() {
    const Equipment& e = *drive_.robot.equipment;
    const std::vector<RobotReading>& moments = drive_.readings->moments;
    for (std::size_t k = 0; k < e.lasers.size(); ++k) {
      const std::size_t topic = log_.add_topic<ros::LaserScan>("/scan/" + e.lasers[k].name);
      for (std::size_t i = 0; i < moments.size(); ++i)
        log_.add(topic, stamp_ns(i), scan_message(e.lasers[k], i, moments[i].lasers_m[k]));
    }
    for (std::size_t k = 0; k < e.sonars.size(); ++k) {
      const Sonar& sonar = e.sonars[k];
      const std::size_t topic = log_.add_topic<ros::Range>("/sonar/" + sonar.name);
      for (std::size_t i = 0; i < moments.size(); ++i)
        log_.add(
            topic, stamp_ns(i),
            ros::Range{header(i, "sonar_" + sonar.name), ros::Range::kUltrasound,
                       static_cast<float>(sonar.field_of_view_rad),
                       static_cast<float>(sonar.min_range_m), static_cast<float>(sonar.max_range_m),
                       range_of(moments[i].sonars_m[k])});
    }
    for (std::size_t k = 0; k < e.bumpers.size(); ++k) {
      const std::size_t topic = log_.add_topic<ros::Bool>("/bumper/" + e.bumpers[k]);
      for (std::size_t i = 0; i < moments.size(); ++i)
        log_.add(topic, stamp_ns(i), ros::Bool{moments[i].bumpers[k]});
    }
    if (!e.base_from_imu) return;
    const std::size_t imu = log_.add_topic<ros::Imu>("/imu/data");
    for (std::size_t i = 0; i < moments.size(); ++i) {
      ros::Imu message;
      message.header = header(i, "imu_link");
      message.orientation_covariance[0] = -1;  // as the message type prescribes if it is unknown
      message.angular_velocity = vector_message(moments[i].turn_rad_per_s);
      message.linear_acceleration = vector_message(moments[i].specific_force_m_per_s2);
      log_.add(imu, stamp_ns(i), message);
    }
  }

  ros::LaserScan scan_message(const LaserScanner& laser, std::size_t i,
                              const std::vector<float>& ranges_m) const {
    ros::LaserScan scan;
    scan.header = header(i, "laser_" + laser.name);
    scan.angle_min = static_cast<float>(-0.5 * laser.field_of_view_rad);
    scan.angle_max = static_cast<float>(0.5 * laser.field_of_view_rad);
    scan.angle_increment =
        static_cast<float>(laser.field_of_view_rad / std::max(1, laser.rays - 1));
    scan.scan_time = static_cast<float>(1 / drive_.robot.camera.rate_hz);
    scan.range_min = static_cast<float>(laser.min_range_m);
    scan.range_max = static_cast<float>(laser.max_range_m);
    for (const float range_m : ranges_m) scan.ranges.push_back(range_of(range_m));
    return scan;
  }

  void add_grid() {
    const FloorGrid& grid = *drive_.grid;
    const std::size_t topic = log_.add_topic<ros::OccupancyGrid>("/map", true);
    const Stamp first_ns = count() == 0 ? 0 : stamp_ns(0);
    ros::OccupancyGrid message;
    message.header = {0, {first_ns}, ros::kMapFrame};
    message.info = {{first_ns},
                    static_cast<float>(grid.resolution_m),
                    static_cast<std::uint32_t>(grid.clearance_m.width()),
                    static_cast<std::uint32_t>(grid.clearance_m.height()),
                    {}};
    // The corner of cell (0, 0), whose center is the grid's origin.
    const Eigen::Vector2d corner_m = grid.origin_m.array() - 0.5 * grid.resolution_m;
    message.info.origin =
        ros::pose_message(drive_.world_from_level *
                          SE3(Eigen::Matrix3d::Identity(), {corner_m.x(), corner_m.y(), 0.0}));
    constexpr std::int8_t kFree = 0, kOccupied = 100, kUnknown = -1;
    for (int y = 0; y < grid.clearance_m.height(); ++y)
      for (int x = 0; x < grid.clearance_m.width(); ++x)
        message.data.push_back(grid.clearance_m(x, y) > 0 ? kFree
                               : grid.occupant(x, y) != 0 ? kOccupied
                                                          : kUnknown);
    log_.add(topic, first_ns, message);
  }

  const DriveRecord& drive_;
  const DrivenPath& path_;
  MessageLog log_;
};

}  // namespace

DriveRecord record_drive(const Scene& scene, const Robot& robot, const DrivenPath& path,
                         const Trajectory& camera, std::uint64_t seed,
                         const std::vector<MovingObstacle>& others) {
  const LevelScene level(scene);
  DriveRecord record{robot, path, camera, {}, {}, level.world_from_level()};
  if (robot.equipment) {
    Trajectory base = path.base;
    for (TimedPose& pose : base)
      pose.world_from_camera = level.world_from_level().inverse() * pose.world_from_camera;
    record.readings = read_sensors(*level, robot, base, seed, others);
  }
  try {
    record.grid = make_floor_grid(*level, {.top_m = robot.height_m});
  } catch (const InputError&) {  // a scene without a floor has no grid
  }
  return record;
}

MessageLog robot_messages(ros::Wire wire, const DriveRecord& drive) {
  return RobotMessages(wire, drive).collect();
}

}  // namespace mh
