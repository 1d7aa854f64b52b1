// SPDX-License-Identifier: Apache-2.0
// Times the whole system against cv::ORB::detectAndCompute with the same number of features. Both
// process the frames of a sequence in TUM's layout, interleaved frame by frame on one thread.
// Prints the cost of feature extraction, of tracking and of everything, as multiples of the cost of
// cv::ORB. CPU time of this thread, so that other work on the machine affects the figures only
// through the caches.
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "bench/lab/micro/timing.hpp"
#include "bench/protocol/metrics/evaluate.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "slam/core/digest.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {
namespace {

struct Options {
  std::string folder, settings, vocabulary = "assets/vocabulary.mhvoc", estimate;
  std::size_t frames = SIZE_MAX;
  bool plain = false;
};

/// Does the work and appends the time that it took.
template <class Work>
void time_into(std::vector<double>& times_ms, Work work) {
  const double start = thread_ms();
  work();
  times_ms.push_back(thread_ms() - start);
}

struct Times {
  std::vector<double> orb, extraction, tracking, everything;
};

double mean(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}
double quantile(std::vector<double> x, double q) {
  std::sort(x.begin(), x.end());
  return x[std::min(x.size() - 1, static_cast<std::size_t>(q * static_cast<double>(x.size())))];
}

void print(const char* what, const std::vector<double>& x, const std::vector<double>& orb) {
  const double base = quantile(orb, 0.5);
  const auto row = [&](double v) { return fmt::format("{:7.2f} ms {:5.2f}x", v, v / base); };
  fmt::print("{:<12} median {}  p95 {}  mean {}  largest {}\n", what, row(quantile(x, 0.5)),
             row(quantile(x, 0.95)), row(mean(x)), row(quantile(x, 1.0)));
}

void run(const Options& options) {
  const RecordedCamera camera = load_recorded_camera(options.settings);
  std::vector<RecordedFrame> frames = load_tum_folder(options.folder);
  if (frames.size() > options.frames) frames.resize(options.frames);
  SlamConfig config;
  if (options.plain) config.semantics = config.semantics.neutralized();
  SlamState state =
      make_slam(camera.camera, config,
                std::make_shared<const Vocabulary>(Vocabulary::load(options.vocabulary)));
  const auto orb = cv::ORB::create(config.features.count);

  Times times;
  std::size_t tracked = 0, keyframes = 0, loops = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RgbdFrame frame = read_frame(frames[i], camera);
    const cv::Mat color(frame.color.height(), frame.color.width(), CV_8UC3,
                        const_cast<Rgb8*>(frame.color.data()));
    // Converted to gray in advance, so that cv::ORB's time does not include it.
    cv::Mat gray;
    cv::cvtColor(color, gray, cv::COLOR_RGB2GRAY);
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    const RandomStream stream = RandomStream(0).fork(i);
    Tracker tracker = state.tracker;
    time_into(times.orb,
              [&] { orb->detectAndCompute(gray, cv::noArray(), keypoints, descriptors); });
    time_into(times.extraction,
              [&] { static_cast<void>(extract(frame, state.camera, config.features)); });
    // Tracking alone is localization in the current map. step() does the same and then maps.
    if (!state.map.empty() && tracker.tracking())
      time_into(times.tracking,
                [&] { static_cast<void>(localize(state, tracker, frame, stream)); });
    StepReport report;
    time_into(times.everything, [&] { report = step(state, frame, stream); });
    tracked += report.status != TrackStatus::kLost;
    keyframes += report.keyframe_added;
    loops += report.loop_closed;
  }

  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print(
      "{}: {} of {} frames tracked, {} keyframes added, {} stand, {} landmarks stand, {} loops\n",
      options.folder, tracked, frames.size(), keyframes, state.map.keyframe_count(),
      state.map.landmark_count(), loops);
  print("cv::ORB", times.orb, times.orb);
  print("extraction", times.extraction, times.orb);
  print("tracking", times.tracking, times.orb);
  print("everything", times.everything, times.orb);
  fmt::print("peak memory {:.0f} MB, map {:016x}, trajectory {:016x}\n",
             static_cast<double>(usage.ru_maxrss) / 1024.0, state.map.digest(),
             digest(trajectory(state)));
  const std::string truth = options.folder + "/groundtruth.txt";
  if (std::ifstream(truth))
    fmt::print("ATE RMSE {:.4f} m\n",
               evaluate(read_trajectory(truth), trajectory(state)).ape_translation_m.rmse);
  if (!options.estimate.empty()) write_tum(options.estimate, trajectory(state));
}

}  // namespace
}  // namespace mh

int main(int argc, char** argv) {
  mh::Options options;
  CLI::App app("Our system against cv::ORB on the frames of a sequence.");
  app.add_option("folder", options.folder, "Sequence in TUM's layout")->required();
  app.add_option("--settings", options.settings, "Calibration (YAML, ORB-SLAM's keys)")->required();
  app.add_option("--vocabulary", options.vocabulary, "Vocabulary file")->capture_default_str();
  app.add_option("--frames", options.frames, "At most so many");
  app.add_option("--estimate", options.estimate, "File for the trajectory (TUM)");
  app.add_flag("--plain", options.plain, "Without semantics");
  CLI11_PARSE(app, argc, argv);
  try {
    cv::setNumThreads(1);
    mh::run(options);
  } catch (const mh::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
