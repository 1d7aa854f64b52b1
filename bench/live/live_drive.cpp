// SPDX-License-Identifier: Apache-2.0
#include "bench/live/live_drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/live/live_page.hpp"
#include "bench/protocol/episodes/starts.hpp"
#include "bench/report/drawing/false_colors.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "scenes/recordings/ros/names.hpp"
#include "sim/motion/floor_grid.hpp"
#include "slam/core/labels.hpp"
#include "slam/io/error.hpp"
#include "slam/io/json_text.hpp"

namespace mh {
namespace {

using Json = nlohmann::json;

constexpr int kTicksPerFrame = 2;          // camera ticks (30 Hz) per frame
constexpr int kStepsWithoutDriver = 8;     // half a second until the robot stops
constexpr int kDarkSteps = 15;             // a kidnapping takes one second
constexpr std::size_t kMostPoints = 4000;  // most points of the map in one message
constexpr std::uint64_t kStepsPerMap = 15;
constexpr double kMaxSpeed_m_per_s = 5, kMaxTurn_rad_per_s = 10;

SimulationConfig config_of(const SimulatedScene& scene, const Robot& robot, std::uint64_t seed) {
  const auto [place_m, heading_rad] = draw_place(*scene.scene, robot, RandomStream(seed));
  return {.start_m = place_m,
          .start_heading_rad = heading_rad,
          .ticks_per_frame = kTicksPerFrame,
          .seed = seed};
}

}  // namespace

LiveDrive::LiveDrive(std::vector<SimulatedScene> scenes, const Robot& robot,
                     const SensorConfig& level, std::shared_ptr<const Vocabulary> vocabulary,
                     std::uint64_t seed)
    : scenes_(std::move(scenes)),
      robot_(robot),
      level_(level),
      vocabulary_(std::move(vocabulary)),
      seed_(seed),
      simulation_(scene(), robot_, level_, config_of(scene(), robot_, seed)),
      camera_messages_(log_, with_lens(robot.camera, level), true),
      robot_messages_(log_, robot_, true, robot.equipment != nullptr, false),
      slam_topics_{.pose = log_.add_topic<ros::PoseStamped>("/slam/pose"),
                   .keyframes = log_.add_topic<ros::Path>("/slam/keyframes"),
                   .landmarks = log_.add_topic<ros::PointCloud2>("/slam/landmarks")},
      slam_(make_slam(with_lens(robot.camera, level), {}, vocabulary_)),
      views_(with_lens(robot.camera, level)) {
  try {
    robot_messages_.add_grid(make_floor_grid(*scene().scene, {.top_m = robot_.height_m}), SE3(), 0);
  } catch (const InputError&) {  // a scene without a floor has no grid
  }
  put_down();
}

void LiveDrive::put_down() {
  const SE3 world_from_base = simulation_.truth().world_from_base();
  const Eigen::Vector3d ahead = world_from_base.rotation().col(0);
  driven_ = {.name = "driven",
             .file = {},
             .start_m = world_from_base.translation().head<2>(),
             .start_heading_rad = std::atan2(ahead.y(), ahead.x()),
             .reflex = false,
             .commands = {}};
}

void LiveDrive::note(const Twist2d& velocity) {
  const VelocityCommand command{.duration_s = kStep_s,
                                .forward_m_per_s = velocity.x(),
                                .left_m_per_s = velocity.y(),
                                .turn_rad_per_s = velocity.z()};
  std::vector<VelocityCommand>& all = driven_.commands;
  const bool is_same = !all.empty() && all.back().forward_m_per_s == command.forward_m_per_s &&
                       all.back().left_m_per_s == command.left_m_per_s &&
                       all.back().turn_rad_per_s == command.turn_rad_per_s;
  if (is_same)
    all.back().duration_s += kStep_s;
  else
    all.push_back(command);
}

std::string LiveDrive::greeting() const {
  const BaseLimits& limits = robot_.limits;
  const SimulatedScene& mapped = scenes_.front();
  Json scenes = Json::array();
  for (const SimulatedScene& each : scenes_) scenes.push_back(each.scene->name);
  Json hello = plan_for_page(mapped.scene.get());
  hello.update({{"scene", mapped.scene->name},
                {"scenes", scenes},
                {"robot", robot_.name},
                {"radius_m", robot_.footprint_radius_m},
                {"speed_m_per_s", limits.max_velocity_m_per_s},
                {"turn_rad_per_s", limits.max_turn_rad_per_s}});
  return Json{{"hello", hello}}.dump();
}

std::string LiveDrive::take(const std::string& message) {
  const Json json = parse_json_or_discard<Json>(message);
  if (!json.is_object() || json.size() != 1) return "expected an object with one key";
  const std::string& key = json.begin().key();
  const Json& value = json.begin().value();
  const auto number = [](const Json& n, double low, double high) -> std::optional<double> {
    if (!n.is_number() || !std::isfinite(n.get<double>())) return std::nullopt;
    return std::clamp(n.get<double>(), low, high);
  };
  const std::lock_guard lock(mutex_);
  if (key == "drive" && value.is_array() && value.size() == 3) {
    const auto vx = number(value[0], -kMaxSpeed_m_per_s, kMaxSpeed_m_per_s),
               vy = number(value[1], -kMaxSpeed_m_per_s, kMaxSpeed_m_per_s),
               wz = number(value[2], -kMaxTurn_rad_per_s, kMaxTurn_rad_per_s);
    if (!vx || !vy || !wz) return "drive: expected three finite numbers";
    asked_.velocity = {*vx, *vy, *wz};
    asked_.steps_left = kStepsWithoutDriver;
    if (!asked_.velocity.isZero()) asked_.go = "";
    return "";
  }
  if (key == "do" && value == "kidnap") {
    asked_.kidnap = true;
    return "";
  }
  if (key == "do" && value == "restart") {
    asked_.restart = true;
    return "";
  }
  if (key == "go" && value.is_string() && value.get_ref<const std::string&>().size() < 100) {
    asked_.go = value.get<std::string>();
    return "";
  }
  if (key == "light" && value.is_boolean()) {
    asked_.light = value.get<bool>();
    return "";
  }
  if (key == "wheels" && value.is_boolean()) {
    asked_.wheels = value.get<bool>();
    return "";
  }
  if (key == "gamma")
    if (const auto gamma = number(value, 0, 1000)) {
      asked_.gamma = gamma;
      return "";
    }
  if (key == "xi")
    if (const auto xi = number(value, 1, 1000)) {
      asked_.xi = xi;
      return "";
    }
  if (key == "scene" && value.is_number_unsigned() && value.get<std::size_t>() < scenes_.size()) {
    asked_.scene = value.get<std::size_t>();
    return "";
  }
  return "not understood: one of drive, do, go, light, wheels, gamma, xi, scene";
}

void LiveDrive::obey(const Asked& asked) {
  if (asked.restart) {
    SemanticConfig semantics = slam_.config.semantics;
    slam_ = make_slam(with_lens(robot_.camera, level_), {}, vocabulary_);
    set_query_settings(slam_, semantics);
    world_from_map_.reset();
    views_.forget();
    errand_.reset();
  }
  if (asked.gamma || asked.xi) {
    SemanticConfig semantics = slam_.config.semantics;
    semantics.gamma = asked.gamma.value_or(semantics.gamma);
    semantics.xi = asked.xi.value_or(semantics.xi);
    set_query_settings(slam_, semantics);
  }
  if (asked.go) {
    errand_.reset();
    errand_command_ = Twist2d::Zero();
    note_.clear();
    try {
      if (!asked.go->empty()) errand_.emplace(views_, trajectory(slam_), robot_, *asked.go);
    } catch (const InputError& error) {
      note_ = error.what();
    }
  }
  if (asked.light) light_ = *asked.light;
  if (asked.wheels) wheels_ = *asked.wheels;
  if (asked.scene && *asked.scene != at_) try {
      simulation_.change_scene(scenes_[*asked.scene]);
      at_ = *asked.scene;
      note_.clear();
      put_down();
    } catch (const InputError& error) {
      note_ = error.what();
    }
  if (asked.kidnap) {
    const auto [place_m, heading_rad] =
        draw_place(*scene().scene, robot_, RandomStream(seed_).fork(++carried_));
    simulation_.carry_to(place_m, heading_rad);
    put_down();
    dark_steps_ = kDarkSteps;
    lifted_ = true;
  }
  simulation_.switch_light(light_ && dark_steps_ == 0);
  if (dark_steps_ > 0) --dark_steps_;
}

LiveDrive::Shown LiveDrive::step(int wanted) {
  Asked asked;
  {
    const std::lock_guard lock(mutex_);
    if (asked_.steps_left == 0)
      asked_.velocity = {};
    else
      --asked_.steps_left;
    asked = asked_;
    asked_.kidnap = asked_.restart = false;
    asked_.go.reset();
    asked_.light.reset();
    asked_.wheels.reset();
    asked_.gamma.reset();
    asked_.xi.reset();
    asked_.scene.reset();
  }
  obey(asked);
  velocity_ = errand_ ? errand_command_ : asked.velocity;
  const RobotObservation seen = simulation_.step(velocity_, kStep_s);
  note(velocity_);
  if (!seen.frame) return {};
  RgbdFrame frame = *seen.frame;
  if (wheels_ && !lifted_) frame.odom_from_camera = seen.odom_from_camera;
  const StepReport report = mh::step(slam_, frame, RandomStream(seed_).fork(frames_++));
  if (dark_steps_ == 0 && report.inliers > 0 && report.status != TrackStatus::kLost)
    lifted_ = false;
  if (!world_from_map_ && report.world_from_camera)
    world_from_map_ =
        simulation_.truth_of_frame()->world_from_camera * report.world_from_camera->inverse();
  const bool is_found = report.status != TrackStatus::kLost && report.inliers > 0;
  if (is_found && report.world_from_camera) views_.see(seen, *report.world_from_camera);
  if (errand_)
    errand_command_ = is_end(errand_->state())
                          ? Twist2d(Twist2d::Zero())
                          : errand_->step(simulation_.time_s(), seen,
                                          is_found ? report.world_from_camera : std::nullopt);
  Shown shown;
  if ((wanted & kMessages) != 0) shown.messages = messages(seen, report);
  if ((wanted & kPage) != 0) {
    shown.state = state(seen, report);
    shown.images = images_for_page(frame);
  }
  return shown;
}

std::vector<MessageLog::Entry> LiveDrive::messages(const RobotObservation& seen,
                                                   const StepReport& report) {
  const ExactFrame frame{*seen.frame, classes_of(*seen.frame), seen.instances,
                         simulation_.truth_of_frame()->world_from_camera};
  const Stamp frame_ns = frame.seen.stamp_ns;
  std::vector<MessageLog::Entry> all = log_.take_entries();  // the grid, once
  const auto append = [&](std::vector<MessageLog::Entry> more) {
    std::ranges::move(more, std::back_inserter(all));
  };
  if (!has_told_) append(camera_messages_.once(frame_ns));
  has_told_ = true;
  append(camera_messages_.of(frames_, frame));
  const ros::Header header{static_cast<std::uint32_t>(frames_), {frame_ns}, ros::kMapFrame};
  if (world_from_map_ && report.world_from_camera)
    log_.add(
        slam_topics_.pose, frame_ns,
        ros::PoseStamped{header, ros::pose_message(*world_from_map_ * *report.world_from_camera)});
  if (frames_ % kStepsPerMap == 1 && world_from_map_) {
    ros::Path path{header, {}};
    for (const Keyframe& keyframe : slam_.map.keyframes())
      if (!keyframe.erased)
        path.poses.push_back(
            {header, ros::pose_message(*world_from_map_ * keyframe.camera_from_world.inverse())});
    log_.add(slam_topics_.keyframes, frame_ns, path);
    add_landmarks(header);
  }
  const SE3 world_from_base = simulation_.truth().world_from_base();
  robot_messages_.add({seen.stamp_ns, world_from_base, world_from_base * robot_.base_from_camera,
                       seen.odom_from_base, &seen.reading});
  append(log_.take_entries());
  return all;
}

void LiveDrive::add_landmarks(const ros::Header& header) {
  struct Point {
    float x, y, z;
    std::uint8_t blue, green, red, none;  // the field "rgb", as PCL packs it
    std::uint32_t label;
  };
  std::vector<Point> points;
  for (const Landmark& landmark : slam_.map.landmarks()) {
    if (landmark.erased) continue;
    const Eigen::Vector3f at = (*world_from_map_ * landmark.position_in_world).cast<float>();
    const Rgb8 color = class_color(landmark.label);
    points.push_back({at.x(), at.y(), at.z(), color.b, color.g, color.r, 0, landmark.label});
  }
  ros::PointCloud2 cloud;
  cloud.header = header;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.points = {{"x", offsetof(Point, x)},
                  {"y", offsetof(Point, y)},
                  {"z", offsetof(Point, z)},
                  {"rgb", offsetof(Point, blue)},
                  {"label", offsetof(Point, label), ros::PointField::kUint32}};
  cloud.point_step = sizeof(Point);
  cloud.row_step = static_cast<std::uint32_t>(sizeof(Point) * points.size());
  cloud.data = {reinterpret_cast<const char*>(points.data()), sizeof(Point) * points.size()};
  log_.add(slam_topics_.landmarks, header.stamp.ns, cloud);
}

std::string LiveDrive::state(const RobotObservation& seen, const StepReport& report) const {
  const SE3 world_from_base = simulation_.truth().world_from_base();
  const Eigen::Vector3d ahead = world_from_base.rotation().col(0);
  Json lasers = Json::array();
  const Equipment& equipment = *robot_.equipment;
  for (std::size_t k = 0; k < seen.reading.lasers_m.size(); ++k) {
    const LaserScanner& laser = equipment.lasers[k];
    const SE3 world_from_laser = world_from_base * laser.base_from_laser;
    for (std::size_t i = 0; i < seen.reading.lasers_m[k].size(); ++i) {
      const double range_m = seen.reading.lasers_m[k][i];
      if (range_m == 0) continue;
      const double a = laser.angle_rad(i);
      const Eigen::Vector3d end_m =
          world_from_laser * Eigen::Vector3d(range_m * std::cos(a), range_m * std::sin(a), 0);
      lasers.push_back({rounded_for_page(end_m.x()), rounded_for_page(end_m.y())});
    }
  }
  Json json = {{"time_s", rounded_for_page(simulation_.time_s())},
               {"base",
                {rounded_for_page(world_from_base.translation().x()),
                 rounded_for_page(world_from_base.translation().y()),
                 rounded_for_page(std::atan2(ahead.y(), ahead.x()))}},
               {"camera", from_above_for_page(simulation_.truth_of_frame()->world_from_camera)},
               {"estimate", nullptr},
               {"status", std::string(name(report.status))},
               {"keypoints", report.keypoints},
               {"inliers", report.inliers},
               {"keyframes", slam_.map.keyframe_count()},
               {"landmarks", slam_.map.landmark_count()},
               {"command", {velocity_.x(), velocity_.y(), velocity_.z()}},
               {"light", light_ && dark_steps_ == 0},
               {"wheels", wheels_},
               {"scene", at_},
               {"gamma", slam_.config.semantics.gamma},
               {"xi", slam_.config.semantics.xi},
               {"lasers", lasers}};
  if (world_from_map_ && report.world_from_camera) {
    const SE3 estimate = *world_from_map_ * *report.world_from_camera;
    json["estimate"] = from_above_for_page(estimate);
    json["error_m"] = rounded_for_page(
        (estimate.translation() - simulation_.truth_of_frame()->world_from_camera.translation())
            .norm());
  }
  if (!note_.empty()) json["note"] = note_;
  if (errand_) {
    Json path = Json::array();
    for (const Eigen::Vector3d& p : errand_->path()) {
      const Eigen::Vector3d at = *world_from_map_ * p;
      path.push_back({rounded_for_page(at.x()), rounded_for_page(at.y())});
    }
    json["errand"] = {
        {"goal", errand_->goal()}, {"state", std::string(name(errand_->state()))}, {"path", path}};
  }
  if (frames_ % kStepsPerMap == 1 && world_from_map_) {
    Json points = Json::array(), keyframes = Json::array();
    const std::size_t every =
        1 + static_cast<std::size_t>(slam_.map.landmark_count()) / kMostPoints;
    std::size_t count = 0;
    for (const Landmark& landmark : slam_.map.landmarks()) {
      if (landmark.erased || count++ % every != 0) continue;
      const Eigen::Vector3d at = *world_from_map_ * landmark.position_in_world;
      points.push_back({rounded_for_page(at.x()), rounded_for_page(at.y()), landmark.label});
    }
    for (const Keyframe& keyframe : slam_.map.keyframes())
      if (!keyframe.erased)
        keyframes.push_back(
            from_above_for_page(*world_from_map_ * keyframe.camera_from_world.inverse()));
    json["map"] = {{"points", points}, {"keyframes", keyframes}};
  }
  return json.dump();
}

}  // namespace mh
