// SPDX-License-Identifier: Apache-2.0
#include "bench/recorded/render_sequence.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace mh {

Camera recorded_camera(Camera camera, const RenderSequenceOptions& options) {
  camera.rate_hz /= static_cast<double>(options.every);
  return camera;
}

ExactFrame exact_frame(const Shutter& shutter, const SensorConfig& sensors,
                       const RenderSequenceOptions& options, std::size_t k) {
  const std::size_t i = k * options.every;
  const TimedPose& pose = shutter.path()[i];
  Shutter::Exposed exposed = shutter.expose(i);
  RgbdFrame seen = sense(exposed.seen, shutter.camera(), sensors,
                         RandomStream(options.seed).fork(i), pose.stamp_ns, exposed.gain);
  return {std::move(seen), std::move(exposed.seen), pose.world_from_camera};
}

RenderedSequence render_sequence(const Shutter& shutter, const SensorConfig& sensors,
                                 SequenceWriter& writer, const RenderSequenceOptions& options,
                                 const std::function<void(double)>& progress) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
  };
  const std::size_t last = std::min(options.frames, shutter.path().size());
  const std::size_t count = (last + options.every - 1) / options.every;
  RenderedSequence result;
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::size_t done = 0;
  std::exception_ptr failure;

  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) try {
        const TimedPose& pose = shutter.path()[k * options.every];
        const bool there =
            options.resume && writer.resume(k, pose.stamp_ns, pose.world_from_camera);
        double render_s = 0, encode_s = 0;
        if (!there) {
          const auto start = Clock::now();
          const ExactFrame frame = exact_frame(shutter, sensors, options, k);
          const auto rendered = Clock::now();
          writer.add(k, frame.seen, frame.exact, frame.world_from_camera);
          render_s = seconds(start, rendered);
          encode_s = seconds(rendered, Clock::now());
        }
        const std::scoped_lock lock(mutex);
        result.render_s += render_s;
        result.encode_s += encode_s;
        ++(there ? result.resumed : result.frames);
        progress(static_cast<double>(++done) / static_cast<double>(count));
      } catch (...) {
        const std::scoped_lock lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
  };
  {
    std::vector<std::jthread> helpers;
    for (int t = 1; t < options.threads && static_cast<std::size_t>(t) < count; ++t)
      helpers.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  writer.finish();
  return result;
}

}  // namespace mh
