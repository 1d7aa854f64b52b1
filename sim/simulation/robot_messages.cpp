// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/robot_messages.hpp"

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

SE3 base_from_link(const RobotMoment& moment) {
  return moment.world_from_base.inverse() * moment.world_from_camera *
         ros::link_from_optical().inverse();
}

ros::LaserScan scan_message(const LaserScanner& laser, double rate_hz, const Header& header,
                            const std::vector<float>& ranges_m) {
  ros::LaserScan scan;
  scan.header = header;
  scan.angle_min = static_cast<float>(-0.5 * laser.field_of_view_rad);
  scan.angle_max = static_cast<float>(0.5 * laser.field_of_view_rad);
  scan.angle_increment = static_cast<float>(laser.field_of_view_rad / std::max(1, laser.rays - 1));
  scan.scan_time = static_cast<float>(1 / rate_hz);
  scan.range_min = static_cast<float>(laser.min_range_m);
  scan.range_max = static_cast<float>(laser.max_range_m);
  for (const float range_m : ranges_m) scan.ranges.push_back(range_of(range_m));
  return scan;
}

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

RobotMessages::RobotMessages(MessageLog& log, const Robot& robot, bool has_odometry,
                             bool has_readings, bool head_moves)
    : log_(log), robot_(robot), has_odometry_(has_odometry), head_moves_(head_moves) {
  tf_ = log.add_topic<ros::TfMessage>(ros::kTfTopic);
  tf_static_ = log.add_topic<ros::TfMessage>(ros::kTfStaticTopic, true);
  truth_ = log.add_topic<ros::PoseStamped>(ros::kBaseTruthTopic);
  if (has_odometry) odometry_ = log.add_topic<ros::Odometry>("/odom");
  if (!has_readings) return;
  const Equipment& e = *robot.equipment;
  for (const LaserScanner& laser : e.lasers)
    lasers_.push_back(log.add_topic<ros::LaserScan>("/scan/" + laser.name));
  for (const Sonar& sonar : e.sonars)
    sonars_.push_back(log.add_topic<ros::Range>("/sonar/" + sonar.name));
  for (const std::string& bumper : e.bumpers)
    bumpers_.push_back(log.add_topic<ros::Bool>("/bumper/" + bumper));
  if (e.base_from_imu) imu_ = log.add_topic<ros::Imu>("/imu/data");
}

void RobotMessages::add_fixed(const RobotMoment& moment) {
  ros::TfMessage once;
  const auto fix = [&](const char* parent, const std::string& child, const SE3& pose) {
    once.transforms.push_back(ros::transform_message(moment.stamp_ns, parent, child, pose));
  };
  fix(ros::kFootprintFrame, ros::kBaseFrame, SE3());
  fix(ros::kCameraFrame, ros::kOpticalFrame, ros::link_from_optical());
  if (!head_moves_) fix(ros::kBaseFrame, ros::kCameraFrame, base_from_link(moment));
  if (!has_odometry_) fix(ros::kMapFrame, ros::kOdomFrame, SE3());
  if (robot_.equipment) {
    const Equipment& e = *robot_.equipment;
    for (const LaserScanner& laser : e.lasers)
      fix(ros::kBaseFrame, "laser_" + laser.name, laser.base_from_laser);
    for (const Sonar& sonar : e.sonars)
      fix(ros::kBaseFrame, "sonar_" + sonar.name, sonar.base_from_sonar);
    if (e.base_from_imu) fix(ros::kBaseFrame, "imu_link", *e.base_from_imu);
  }
  log_.add(tf_static_, moment.stamp_ns, once);
}

void RobotMessages::add(const RobotMoment& moment) {
  if (count_ == 0) add_fixed(moment);
  ros::TfMessage tf;
  const auto move = [&](const char* parent, const char* child, const SE3& pose) {
    tf.transforms.push_back(ros::transform_message(moment.stamp_ns, parent, child, pose));
  };
  const SE3 odom_from_base = moment.odom_from_base.value_or(moment.world_from_base);
  if (has_odometry_)
    move(ros::kMapFrame, ros::kOdomFrame, moment.world_from_base * odom_from_base.inverse());
  move(ros::kOdomFrame, ros::kFootprintFrame, odom_from_base);
  if (head_moves_) move(ros::kBaseFrame, ros::kCameraFrame, base_from_link(moment));
  log_.add(tf_, moment.stamp_ns, tf);
  log_.add(
      truth_, moment.stamp_ns,
      ros::PoseStamped{header(moment, ros::kMapFrame), ros::pose_message(moment.world_from_base)});
  if (has_odometry_) add_odometry(moment);
  if (moment.reading != nullptr) add_reading(moment);
  before_ = moment;
  ++count_;
}

void RobotMessages::add_odometry(const RobotMoment& moment) {
  ros::Odometry message{header(moment, ros::kOdomFrame), ros::kFootprintFrame, {}, {}};
  message.pose.pose = ros::pose_message(*moment.odom_from_base);
  if (before_) {  // the mean since the previous reading, in the base's frame
    const double seconds = 1e-9 * static_cast<double>(moment.stamp_ns - before_->stamp_ns);
    const Vector6d step =
        (before_->odom_from_base->inverse() * *moment.odom_from_base).log() / seconds;
    message.twist.twist = {vector_message(step.head<3>()), vector_message(step.tail<3>())};
  }
  log_.add(odometry_, moment.stamp_ns, message);
}

void RobotMessages::add_reading(const RobotMoment& moment) {
  const Equipment& e = *robot_.equipment;
  const RobotReading& reading = *moment.reading;
  for (std::size_t k = 0; k < lasers_.size(); ++k)
    log_.add(lasers_[k], moment.stamp_ns,
             scan_message(e.lasers[k], robot_.camera.rate_hz,
                          header(moment, "laser_" + e.lasers[k].name), reading.lasers_m[k]));
  for (std::size_t k = 0; k < sonars_.size(); ++k) {
    const Sonar& sonar = e.sonars[k];
    log_.add(sonars_[k], moment.stamp_ns,
             ros::Range{header(moment, "sonar_" + sonar.name), ros::Range::kUltrasound,
                        static_cast<float>(sonar.field_of_view_rad),
                        static_cast<float>(sonar.min_range_m),
                        static_cast<float>(sonar.max_range_m), range_of(reading.sonars_m[k])});
  }
  for (std::size_t k = 0; k < bumpers_.size(); ++k)
    log_.add(bumpers_[k], moment.stamp_ns, ros::Bool{reading.bumpers[k]});
  if (!e.base_from_imu) return;
  ros::Imu message;
  message.header = header(moment, "imu_link");
  message.orientation_covariance[0] = -1;  // as the message type prescribes if it is unknown
  message.angular_velocity = vector_message(reading.turn_rad_per_s);
  message.linear_acceleration = vector_message(reading.specific_force_m_per_s2);
  log_.add(imu_, moment.stamp_ns, message);
}

void RobotMessages::add_grid(const FloorGrid& grid, const SE3& world_from_level, Stamp stamp_ns) {
  const std::size_t topic = log_.add_topic<ros::OccupancyGrid>("/map", true);
  ros::OccupancyGrid message;
  message.header = {0, {stamp_ns}, ros::kMapFrame};
  message.info = {{stamp_ns},
                  static_cast<float>(grid.resolution_m),
                  static_cast<std::uint32_t>(grid.clearance_m.width()),
                  static_cast<std::uint32_t>(grid.clearance_m.height()),
                  {}};
  // The corner of cell (0, 0), whose center is the grid's origin.
  const Eigen::Vector2d corner_m = grid.origin_m.array() - 0.5 * grid.resolution_m;
  message.info.origin = ros::pose_message(
      world_from_level * SE3(Eigen::Matrix3d::Identity(), {corner_m.x(), corner_m.y(), 0.0}));
  constexpr std::int8_t kFree = 0, kOccupied = 100, kUnknown = -1;
  for (int y = 0; y < grid.clearance_m.height(); ++y)
    for (int x = 0; x < grid.clearance_m.width(); ++x)
      message.data.push_back(grid.clearance_m(x, y) > 0 ? kFree
                             : grid.occupant(x, y) != 0 ? kOccupied
                                                        : kUnknown);
  log_.add(topic, stamp_ns, message);
}

MessageLog robot_messages(ros::Wire wire, const DriveRecord& drive) {
  MessageLog log(wire);
  const bool has_odometry = drive.readings && !drive.readings->odometry.empty();
  RobotMessages messages(log, drive.robot, has_odometry, drive.readings.has_value(),
                         !drive.path.head.empty());
  const Trajectory& base = drive.path.base;
  for (std::size_t i = 0; i < base.size(); ++i)
    messages.add(
        {base[i].stamp_ns, base[i].world_from_camera, drive.camera[i].world_from_camera,
         has_odometry ? std::optional(drive.readings->odometry[i].world_from_camera) : std::nullopt,
         drive.readings ? &drive.readings->moments[i] : nullptr});
  if (drive.grid)
    messages.add_grid(*drive.grid, drive.world_from_level,
                      base.empty() ? 0 : base.front().stamp_ns);
  log.sort();
  return log;
}

}  // namespace mh
