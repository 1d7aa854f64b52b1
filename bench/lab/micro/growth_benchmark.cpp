// SPDX-License-Identifier: Apache-2.0
// Time per frame and memory of the process as the map grows.
//   rooms  a small map and one ten times as large, made of features without images; both then see
//          the same frames, first of known and then of new ground, alternating frame by frame.
//   laps   a recorded sequence fed repeatedly, as if to a robot that stays in one house; features
//          are extracted once and read from a file.
// CPU time of this thread.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>

#include "bench/lab/micro/timing.hpp"
#include "bench/protocol/metrics/evaluate.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"
#include "slam/pipeline/slam.hpp"
#include "tests/slam/pipeline/feature_world.hpp"

namespace mh {
namespace {

using testing_support::FeatureWorld;

constexpr Stamp kPeriod_ns = 33'333'333;

struct Options {
  std::string vocabulary = "assets/vocabulary.mhvoc";
  int rooms = 2, times = 10;
  std::string folder, settings, cache;
  int laps = 12;
};

struct Times {
  std::vector<double> ms;
  double mean() const {
    double sum = 0;
    for (const double v : ms) sum += v;
    return sum / static_cast<double>(ms.size());
  }
  double quantile(double q) const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  }
};

double megabytes_now() {
  std::ifstream file("/proc/self/statm");
  double total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}
double megabytes_at_most() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// One run through the rows of rooms.
struct Run {
  SlamState state;
  Stamp stamp_ns = 0;
  std::size_t lost = 0, keyframes = 0, loops = 0;

  double feed(const FeatureWorld& world, const SE3& pose, std::uint64_t noise) {
    Features features = world.see(pose, RandomStream(2).fork(noise));
    const double start = thread_ms();
    const StepReport report =
        step(state, stamp_ns += kPeriod_ns, std::move(features), RandomStream(3).fork(noise));
    const double took = thread_ms() - start;
    lost += report.status == TrackStatus::kLost;
    keyframes += report.keyframe_added;
    loops += report.loop_closed;
    return took;
  }
};

void compare(const char* ground, Run& small, Run& large, const FeatureWorld& world,
             const std::vector<SE3>& path, std::uint64_t noise) {
  Times of_small, of_large;
  const std::size_t before_small = small.keyframes, before_large = large.keyframes;
  const std::size_t loops_small = small.loops, loops_large = large.loops;
  for (const SE3& pose : path) {
    ++noise;
    of_small.ms.push_back(small.feed(world, pose, noise));
    of_large.ms.push_back(large.feed(world, pose, noise));
  }
  const auto row = [](double a, double b) {
    return fmt::format("{:.2f} -> {:.2f} ms {:.2f}x", a, b, b / a);
  };
  fmt::print(
      "{} ground, {} frames, {} -> {} keyframes added, {} -> {} loops closed: median {}, p95 {}, "
      "mean {}, "
      "largest {}\n",
      ground, path.size(), small.keyframes - before_small, large.keyframes - before_large,
      small.loops - loops_small, large.loops - loops_large,
      row(of_small.quantile(0.5), of_large.quantile(0.5)),
      row(of_small.quantile(0.95), of_large.quantile(0.95)), row(of_small.mean(), of_large.mean()),
      row(of_small.quantile(1.0), of_large.quantile(1.0)));
}

void run_rooms(const Options& options) {
  const auto vocabulary = std::make_shared<const Vocabulary>(Vocabulary::load(options.vocabulary));
  const FeatureWorld world(4000, 1000);
  const auto mapped = [&](int rooms) {
    Run run{make_slam(FeatureWorld::camera(), SlamConfig{}, vocabulary)};
    std::uint64_t noise = 0;
    for (const SE3& pose : FeatureWorld::there_and_back(0, rooms)) run.feed(world, pose, ++noise);
    fmt::print("{} rooms, {} frames ({} lost): {} keyframes, {} landmarks, {:.0f} MB\n", rooms,
               noise, run.lost, run.state.map.keyframe_count(), run.state.map.landmark_count(),
               megabytes_now());
    return run;
  };
  Run small = mapped(options.rooms);
  Run large = mapped(options.rooms * options.times);
  compare("known", small, large, world, FeatureWorld::there_and_back(0, options.rooms), 1'000'000);
  compare("new", small, large, world, FeatureWorld::there_and_back(0, -1 - options.rooms),
          2'000'000);
}

// ---- laps ------------------------------------------------------------------------------------

void write_features(std::ofstream& file, Stamp stamp_ns, const Features& features) {
  const std::uint64_t size = features.size();
  const auto write = [&](const void* data, std::size_t bytes) {
    file.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
  };
  write(&stamp_ns, sizeof stamp_ns);
  write(&size, sizeof size);
  write(features.keypoints.data(), size * sizeof(Keypoint));
  write(features.descriptors.data(), size * sizeof(Descriptor));
}

bool read_features(std::ifstream& file, Stamp& stamp_ns, Features& features) {
  std::uint64_t size = 0;
  const auto read = [&](void* data, std::size_t bytes) {
    return static_cast<bool>(
        file.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes)));
  };
  if (!read(&stamp_ns, sizeof stamp_ns) || !read(&size, sizeof size)) return false;
  features.keypoints.resize(size);
  features.descriptors.resize(size);
  return read(features.keypoints.data(), size * sizeof(Keypoint)) &&
         read(features.descriptors.data(), size * sizeof(Descriptor));
}

void make_cache(const Options& options, const RecordedCamera& camera) {
  const std::string temporary = options.cache + ".tmp";
  std::ofstream file(temporary, std::ios::binary);
  for (const RecordedFrame& frame : load_tum_folder(options.folder))
    write_features(file, frame.stamp_ns, extract(read_frame(frame, camera), camera.camera, {}));
  file.close();
  if (!file || std::rename(temporary.c_str(), options.cache.c_str()) != 0)
    throw InputError(options.cache + ": cannot be written");
}

void run_laps(const Options& options) {
  const RecordedCamera camera = load_recorded_camera(options.settings);
  if (!std::ifstream(options.cache)) {
    make_cache(options, camera);
    fmt::print("{} written; run again: the memory of this run is that of extraction too\n",
               options.cache);
    return;
  }
  const Trajectory truth = read_trajectory(options.folder + "/groundtruth.txt");
  SlamState state =
      make_slam(camera.camera, SlamConfig{},
                std::make_shared<const Vocabulary>(Vocabulary::load(options.vocabulary)));
  Stamp first = 0, shift = 0, last = 0;
  std::uint64_t fed = 0;
  for (int lap = 1; lap <= options.laps; ++lap) {
    std::ifstream file(options.cache, std::ios::binary);
    Times times;
    std::size_t lost = 0, keyframes = 0, loops = 0;
    Stamp stamp_ns = 0;
    Trajectory lap_truth;
    for (const TimedPose& pose : truth)
      lap_truth.push_back({pose.stamp_ns + shift, pose.world_from_camera});
    const Stamp begin = lap_truth.front().stamp_ns;
    for (Features features; read_features(file, stamp_ns, features);) {
      if (fed == 0) first = stamp_ns;
      last = stamp_ns + shift;
      const double start = thread_ms();
      const StepReport report = step(state, last, std::move(features), RandomStream(0).fork(fed++));
      times.ms.push_back(thread_ms() - start);
      lost += report.status == TrackStatus::kLost;
      keyframes += report.keyframe_added;
      loops += report.loop_closed;
    }
    shift = last + kPeriod_ns - first;
    Trajectory estimate;
    for (const TimedPose& pose : trajectory(state))
      if (pose.stamp_ns >= begin - kPeriod_ns) estimate.push_back(pose);
    fmt::print(
        "lap {:2}: {} frames, {} lost, {} keyframes added, {} stand, {} landmarks stand, {} made, "
        "{} loops, mean {:.2f} ms, median {:.2f}, largest {:.0f}, ATE {:.4f} m, {:.0f} MB now, "
        "{:.0f} at most\n",
        lap, times.ms.size(), lost, keyframes, state.map.keyframe_count(),
        state.map.landmark_count(), state.map.landmarks().size(), loops, times.mean(),
        times.quantile(0.5), times.quantile(1.0),
        evaluate(lap_truth, estimate).ape_translation_m.rmse, megabytes_now(), megabytes_at_most());
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace mh

int main(int argc, char** argv) {
  mh::Options options;
  CLI::App app("What a frame costs and what the process holds as the map grows.");
  app.require_subcommand(1);
  app.add_option("--vocabulary", options.vocabulary, "Vocabulary file")->capture_default_str();
  CLI::App* rooms = app.add_subcommand("rooms", "A small map against one many times as large");
  rooms->add_option("--rooms", options.rooms, "Of the small map")->capture_default_str();
  rooms->add_option("--times", options.times, "The large one has so many times as many")
      ->capture_default_str();
  CLI::App* laps = app.add_subcommand("laps", "A recorded sequence fed again and again");
  laps->add_option("folder", options.folder, "Sequence in TUM's layout")->required();
  laps->add_option("--settings", options.settings, "Calibration (YAML)")->required();
  laps->add_option("--cache", options.cache, "File of its features, made if missing")->required();
  laps->add_option("--laps", options.laps, "How often")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    cv::setNumThreads(1);
    if (rooms->parsed()) mh::run_rooms(options);
    if (laps->parsed()) mh::run_laps(options);
  } catch (const mh::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
