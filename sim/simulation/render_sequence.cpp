// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/render_sequence.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "scenes/recordings/frame_files.hpp"
#include "sim/simulation/simulated_sequence.hpp"

namespace mh {

Camera recorded_camera(Camera camera, const RenderSequenceOptions& options) {
  camera.rate_hz /= static_cast<double>(options.every);
  return camera;
}

std::vector<std::size_t> moments(const Shutter& shutter, const SensorConfig& sensors,
                                 const RenderSequenceOptions& options) {
  const std::size_t last = std::min(options.frames, shutter.path().size());
  std::vector<std::size_t> wanted = arriving(last, sensors, RandomStream(options.seed));
  std::erase_if(wanted, [&](std::size_t i) { return i % options.every != 0; });
  return wanted;
}

ExactFrame exact_frame(const Shutter& shutter, const SensorConfig& sensors,
                       const RenderSequenceOptions& options, std::size_t i) {
  constexpr std::uint64_t kSecond = ~std::uint64_t{0};  // not the number of any frame
  const RandomStream seed(options.seed);
  auto [seen, exact] = sense_moment(shutter, sensors, options.labels, i,
                                    options.is_second ? seed.fork(kSecond) : seed);
  if (options.relabel) options.relabel(seen, i);
  const bool labels_are_exact = !options.relabel && is_per_pixel(options.labels) &&
                                sensors.blank_frames.lost() == 0.0 && sensors.labels.noise.none();
  if (!labels_are_exact) exact.classes = classes_of(seen);
  return {std::move(seen), std::move(exact.classes), std::move(exact.instances),
          shutter.path()[i].world_from_camera};
}

RenderedSequence render_sequence(const Shutter& shutter, const SensorConfig& sensors,
                                 SequenceWriter& writer, const RenderSequenceOptions& options,
                                 const std::function<void(double)>& progress) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
  };
  const std::vector<std::size_t> wanted = moments(shutter, sensors, options);
  const std::size_t count = wanted.size();
  RenderedSequence result;
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::size_t done = 0;
  std::exception_ptr failure;

  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) try {
        const TimedPose& pose = shutter.path()[wanted[k]];
        const bool there =
            options.resume && writer.resume(k, pose.stamp_ns, pose.world_from_camera);
        double render_s = 0, encode_s = 0;
        if (!there) {
          const auto start = Clock::now();
          const ExactFrame frame = exact_frame(shutter, sensors, options, wanted[k]);
          const auto rendered = Clock::now();
          writer.add(k, frame);
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
