// SPDX-License-Identifier: Apache-2.0
// Runs in the bench's process: a shared library with one function (docs/outside_systems.md).
#include <modelhouse/system.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "odometry.hpp"

namespace {

struct Library {
  mh_system system;
  example::VisualOdometry odometry;
  char* message;
};

/// Calls `work`. No exception may leave the library, so the text of one becomes the message.
/// @returns 0, or 1 after an exception
template <class Work>
int guarded(void* self, Work&& work) {
  auto& library = *static_cast<Library*>(self);
  try {
    work(library.odometry);
    return 0;
  } catch (const std::exception& error) {
    std::snprintf(library.message, MH_MESSAGE_SIZE, "%s", error.what());
    return 1;
  }
}

cv::Mat bgr_of(const mh_frame& frame) {
  const cv::Mat rgb(frame.height_px, frame.width_px, CV_8UC3, const_cast<uint8_t*>(frame.color));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

cv::Mat depth_of(const mh_frame& frame) {
  return {frame.height_px, frame.width_px, CV_16UC1, const_cast<uint16_t*>(frame.depth)};
}

std::optional<cv::Affine3d> wheels_of(const mh_frame& frame) {
  if (frame.odometry == nullptr) return {};
  return example::pose_of(std::to_array(frame.odometry->values));
}

void report(const example::Found& found, mh_reply& reply) {
  if (found.world_from_camera) {
    reply.has_pose = 1;
    const auto values = example::pose_values(*found.world_from_camera);
    std::copy(values.begin(), values.end(), reply.pose.values);
  }
  reply.inliers = found.inliers;
  reply.keyframe_added = found.keyframe_added;
  if (found.candidates == 0) return;
  reply.keyframes = found.keyframes;
  reply.final = found.candidates;
}

int track(void* self, const mh_frame* frame, mh_reply* reply) {
  return guarded(self, [&](example::VisualOdometry& odometry) {
    report(odometry.track(bgr_of(*frame), depth_of(*frame), wheels_of(*frame)), *reply);
  });
}
int relocalize(void* self, const mh_frame* frame, mh_reply* reply) {
  return guarded(self, [&](const example::VisualOdometry& odometry) {
    report(odometry.relocalize(bgr_of(*frame), depth_of(*frame)), *reply);
  });
}
int rewind(void* self) {
  return guarded(self, [](example::VisualOdometry& odometry) { odometry.lose(); });
}
int reset(void* self) {
  return guarded(self, [](example::VisualOdometry& odometry) { odometry.forget_map(); });
}
int freeze(void*) {
  return 0;  // relocalize() only reads the keyframes: they stay unchanged
}
void destroy(void* self) {
  delete static_cast<Library*>(self);
}

}  // namespace

mh_system* mh_make_system(const mh_setup* setup) try {
  const mh_camera& c = setup->camera;
  example::Camera camera;
  camera.matrix = {c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1};
  camera.distortion = {c.k1, c.k2, c.p1, c.p2, c.k3, setup->k4, setup->k5, setup->k6};
  camera.depth_per_meter = c.depth_per_meter;
  auto* library = new Library{{}, example::VisualOdometry(std::move(camera)), setup->message};
  library->system = {.version = MH_SYSTEM_VERSION,
                     .self = library,
                     .track = track,
                     .rewind = rewind,
                     .reset = reset,
                     .freeze = freeze,
                     .trajectory = nullptr,   // the poses in the replies suffice
                     .begin_query = nullptr,  // relocalize() keeps no state:
                     .blank = nullptr,        // nothing to forget or to lose
                     .relocalize = relocalize,
                     .destroy = destroy};
  return &library->system;
} catch (const std::exception& error) {
  std::snprintf(setup->message, MH_MESSAGE_SIZE, "%s", error.what());
  return nullptr;
}
