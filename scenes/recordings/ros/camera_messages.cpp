// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/ros/camera_messages.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "scenes/recordings/frame_files.hpp"
#include "scenes/recordings/messages/vision_types.hpp"
#include "scenes/recordings/ros/names.hpp"

namespace mh {
namespace {

template <class T>
ros::Bytes bytes_of(const Grid2d<T>& grid) {
  return {reinterpret_cast<const char*>(grid.data()), grid.size() * sizeof(T)};
}

template <class T>
ros::Image image_message(const ros::Header& header, const char* encoding, const Grid2d<T>& grid) {
  return {header,
          static_cast<std::uint32_t>(grid.height()),
          static_cast<std::uint32_t>(grid.width()),
          encoding,
          0,
          static_cast<std::uint32_t>(grid.width() * sizeof(T)),
          bytes_of(grid)};
}

/// The depth as it would be read back from TUM's files.
Grid2d<float> rounded_depth(const Grid2d<float>& depth_m) {
  Grid2d<float> rounded(depth_m.width(), depth_m.height());
  std::transform(depth_m.begin(), depth_m.end(), rounded.begin(),
                 [](float z_m) { return static_cast<float>(depth_units(z_m) / kDepthPerMeter); });
  return rounded;
}

/// The names of our classes as lines like "5: chair", which can serve as a class map.
std::string class_names() {
  std::string text;
  for (const ClassInfo& info : classes()) text += fmt::format("{}: {}\n", info.id, info.name);
  return text;
}

/// The calibration as a message.
ros::CameraInfo camera_info_message(const Camera& camera) {
  const double fx = camera.fx_px, fy = camera.fy_px, cx = camera.cx_px, cy = camera.cy_px;
  ros::CameraInfo info;
  info.header.frame_id = ros::kOpticalFrame;
  info.height = static_cast<std::uint32_t>(camera.height_px);
  info.width = static_cast<std::uint32_t>(camera.width_px);
  info.distortion_model = distortion_model(camera.distortion);
  info.d = coefficients_of(camera.distortion);
  info.k = {fx, 0, cx, 0, fy, cy, 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0};
  return info;
}

/// A box around each instance that has a class, with its most frequent class.
std::vector<ros::Detection2D> detections_of(const Grid2d<ClassId>& classes,
                                            const Grid2d<InstanceId>& instances) {
  struct Seen {
    int left = 0, right = 0, top = 0, bottom = 0;  // first and last pixels
    std::array<int, 256> pixels;                   // by class
  };
  std::map<InstanceId, Seen> all;
  Seen* seen = nullptr;  // of the previous pixel, usually also of this one
  InstanceId last = 0;
  for (int y = 0; y < instances.height(); ++y)
    for (int x = 0; x < instances.width(); ++x) {
      const InstanceId id = instances(x, y);
      const ClassId c = classes(x, y);
      if (id == 0 || c == kVoid || c == kBackground) continue;
      if (seen == nullptr || id != last) {
        seen = &all.try_emplace(id, Seen{x, x, y, y, {}}).first->second;
        last = id;
      }
      seen->left = std::min(seen->left, x);
      seen->right = std::max(seen->right, x);
      seen->bottom = y;
      ++seen->pixels[c];
    }
  std::vector<ros::Detection2D> detections;
  for (const auto& [id, found] : all) {
    const auto c =
        static_cast<ClassId>(std::ranges::max_element(found.pixels) - found.pixels.begin());
    ros::Detection2D detection;
    // Pixel centers are at integers: the box reaches half a pixel beyond them.
    const double x = 0.5 * (found.left + found.right), y = 0.5 * (found.top + found.bottom);
    detection.bbox = {{x, y, 0},
                      {{x, y}, 0},
                      static_cast<double>(found.right - found.left + 1),
                      static_cast<double>(found.bottom - found.top + 1)};
    ros::ObjectHypothesisWithPose result;
    result.id = c;
    result.hypothesis = {std::string(mh::classes()[c].name), 1.0};
    detection.results.push_back(std::move(result));
    detection.id = std::to_string(id);
    detections.push_back(std::move(detection));
  }
  return detections;
}

}  // namespace

CameraMessages::CameraMessages(MessageLog& log, const Camera& camera, bool on_robot)
    : camera_(camera), on_robot_(on_robot), wire_(log.wire()) {
  topics_ = {.color = log.add_topic<ros::Image>(ros::kColorTopic),
             .color_info = log.add_topic<ros::CameraInfo>(ros::kColorInfoTopic),
             .depth = log.add_topic<ros::Image>(ros::kDepthTopic),
             .depth_info = log.add_topic<ros::CameraInfo>(ros::kDepthInfoTopic),
             .projector_info = log.add_topic<ros::CameraInfo>(ros::kProjectorInfoTopic, true),
             .labels = log.add_topic<ros::Image>(ros::kLabelTopic),
             .names = log.add_topic<ros::String>(ros::kLabelNamesTopic, true),
             .instances = log.add_topic<ros::Image>(ros::kInstanceTopic),
             .detections = log.add_topic<ros::Detection2DArray>(ros::kDetectionTopic),
             .truth = log.add_topic<ros::PoseStamped>(ros::kCameraTruthTopic),
             .tf = log.add_topic<ros::TfMessage>(ros::kTfTopic),
             .tf_static = log.add_topic<ros::TfMessage>(ros::kTfStaticTopic, true)};
}

CameraMessages::Entries CameraMessages::once(Stamp stamp_ns) const {
  Entries entries;
  if (!on_robot_)
    entries.push_back(
        entry(topics_.tf_static, stamp_ns,
              ros::TfMessage{{ros::transform_message(
                  stamp_ns, ros::kCameraFrame, ros::kOpticalFrame, ros::link_from_optical())}}));
  entries.push_back(entry(topics_.names, stamp_ns, ros::String{class_names()}));
  ros::CameraInfo projector = camera_info_message(camera_);
  projector.header.stamp = {stamp_ns};
  projector.p[3] = -(camera_.baseline_m * camera_.fx_px);
  entries.push_back(entry(topics_.projector_info, stamp_ns, projector));
  return entries;
}

CameraMessages::Entries CameraMessages::of(std::size_t index, const ExactFrame& frame) const {
  const Stamp stamp_ns = frame.seen.stamp_ns;
  const ros::Header header{static_cast<std::uint32_t>(index), {stamp_ns}, ros::kOpticalFrame};
  ros::CameraInfo info = camera_info_message(camera_);
  info.header = header;
  ros::Detection2DArray detections{header, detections_of(frame.classes, frame.instances)};
  for (ros::Detection2D& detection : detections.detections)
    detection.header = detection.source_img.header = header;
  ros::PoseStamped truth{header, ros::pose_message(frame.world_from_camera)};
  truth.header.frame_id = ros::kMapFrame;
  Entries entries;
  const auto add = [&](std::size_t topic, const auto& message) {
    entries.push_back(entry(topic, stamp_ns, message));
  };
  add(topics_.truth, truth);
  if (!on_robot_)
    add(topics_.tf, ros::TfMessage{{ros::transform_message(
                        stamp_ns, ros::kMapFrame, ros::kCameraFrame,
                        frame.world_from_camera * ros::link_from_optical().inverse())}});
  add(topics_.color_info, info);
  add(topics_.depth_info, info);
  add(topics_.color, image_message(header, "rgb8", frame.seen.color));
  const Grid2d<float> depth_m = rounded_depth(frame.seen.depth_m);
  add(topics_.depth, image_message(header, "32FC1", depth_m));
  add(topics_.labels, image_message(header, "8UC1", frame.classes));
  add(topics_.instances, image_message(header, "16UC1", frame.instances));
  add(topics_.detections, detections);
  return entries;
}

}  // namespace mh
