// SPDX-License-Identifier: Apache-2.0
#include "bench/live/live_watch.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "bench/live/live_page.hpp"
#include "bench/suite/shipped.hpp"

namespace mh {
namespace {

using WatchJson = nlohmann::json;

constexpr auto kBetween = std::chrono::milliseconds(66);

std::string hello_of(const RunSpec& spec, const Scene* scene) {
  WatchJson hello = plan_for_page(scene);
  hello.update({{"scene", spec.name},
                {"robot", spec.system.name},
                {"radius_m", 0.26},
                {"watch", true}});  // no controls
  return WatchJson{{"hello", hello}}.dump();
}

}  // namespace

LiveWatch::LiveWatch(int port, const RunSpec& spec)
    : spec_(spec),
      hello_(hello_of(spec, nullptr)),
      server_({.port = port},
              {.page = data_folder() / "bench/live/page",
               .greeting =
                   [this] {
                     const std::lock_guard lock(mutex_);
                     return hello_;
                   },
               .take = [](const std::string&) { return "a run of the bench is only watched"; }}) {}

void LiveWatch::show(const World& world, const MappedFrame& call, const RgbdFrame& frame,
                     const SystemReport& report) {
  if (!is_known_) {
    is_known_ = true;
    const std::lock_guard lock(mutex_);
    hello_ = hello_of(spec_, world.simulated ? world.simulated->scene.get() : nullptr);
    server_.send_text(hello_);
  }
  if (report.map_reset) {
    keyframes_ = 0;
    world_from_map_.reset();
  }
  keyframes_ += report.keyframe_added ? 1 : 0;
  const Trajectory* const truth = world.mapping->truth();
  const SE3* const true_pose = truth != nullptr && call.index < truth->size() &&
                                       (*truth)[call.index].stamp_ns == call.stamp_ns
                                   ? &(*truth)[call.index].world_from_camera
                                   : nullptr;
  if (!world_from_map_ && report.world_from_camera)
    world_from_map_ =
        true_pose != nullptr ? *true_pose * report.world_from_camera->inverse() : SE3();
  const auto now = std::chrono::steady_clock::now();
  if (server_.viewers() == 0 || now - shown_ < kBetween) return;
  shown_ = now;
  WatchJson state = {{"time_s", rounded_for_page(1e-9 * static_cast<double>(call.stamp_ns))},
                     {"frame", call.index + 1},
                     {"of", world.mapping->size()},
                     {"restarts", call.restart},
                     {"status", std::string(name(report.status))},
                     {"keypoints", report.keypoints ? WatchJson(*report.keypoints) : WatchJson()},
                     {"inliers", report.inliers ? WatchJson(*report.inliers) : WatchJson()},
                     {"keyframes", keyframes_},
                     {"lasers", WatchJson::array()},
                     {"light", true},
                     {"camera", nullptr},
                     {"base", nullptr},
                     {"estimate", nullptr}};
  if (true_pose != nullptr) state["camera"] = state["base"] = from_above_for_page(*true_pose);
  if (world_from_map_ && report.world_from_camera) {
    const SE3 estimate = *world_from_map_ * *report.world_from_camera;
    state["estimate"] = from_above_for_page(estimate);
    if (true_pose != nullptr)
      state["error_m"] =
          rounded_for_page((estimate.translation() - true_pose->translation()).norm());
  }
  server_.send_text(state.dump());
  server_.send_images(images_for_page(frame));
}

}  // namespace mh
