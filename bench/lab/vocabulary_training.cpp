// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/vocabulary_training.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "scenes/image_file.hpp"
#include "scenes/vocabulary_rooms/vocabulary_rooms.hpp"
#include "sim/render/bake.hpp"
#include "sim/render/parallel.hpp"
#include "sim/render/renderer.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

enum Stream : std::uint64_t { kRooms = 1, kViews, kNoise, kTree };

/// The descriptors of some images, one list per image.
using Images = std::vector<std::vector<Descriptor>>;

void require(bool good, const char* field, double value) {
  if (!good)
    throw InputError(fmt::format("vocabulary training: {} = {} is out of range", field, value));
}

void validate(const VocabularyTraining& config) {
  require(config.rooms >= 1, "rooms", config.rooms);
  require(config.views >= 1, "views", config.views);
  require(config.light_samples >= 1, "light_samples", config.light_samples);
  require(config.threads >= 1, "threads", config.threads);
  require(config.noise >= 0 && config.noise < 1, "noise", config.noise);
}

std::vector<Descriptor> describe_image(Grid2d<Rgb8> image, const VocabularyTraining& config) {
  Camera camera = config.camera;
  camera.width_px = image.width();
  camera.height_px = image.height();
  RgbdFrame frame;
  frame.color = std::move(image);
  return extract(frame, camera, config.features).descriptors;
}

/// Adds Gaussian noise that is the same on all channels of a pixel, since features are found in
/// gray.
void add_noise(Grid2d<Rgb8>& image, double sigma, RandomStream random) {
  std::uint64_t pixel = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double noise = 255.0 * sigma * random.normal(pixel++);
      const auto noisy = [&](std::uint8_t level) {
        return static_cast<std::uint8_t>(std::clamp(std::floor(level + noise + 0.5), 0.0, 255.0));
      };
      Rgb8& c = image(x, y);
      c = {noisy(c.r), noisy(c.g), noisy(c.b)};
    }
}

Images describe_room(const VocabularyTraining& config, std::uint64_t room) {
  const RandomStream random(config.seed);
  Scene scene = make_training_room(random.fork(kRooms).bits(room));
  bake_light(scene, {.samples = config.light_samples,
                     .bounces = 1,
                     .sun_samples = config.light_samples,
                     .seed = room,
                     .threads = 1});
  const auto renderer = make_embree_renderer(scene, {.exposure = suggest_exposure(scene)});
  const RandomStream noise = random.fork(kNoise).fork(room);
  Images images;
  for (const SE3& world_from_camera :
       training_views(scene, random.fork(kViews).bits(room), config.views)) {
    Grid2d<Rgb8> image = renderer->render(config.camera, world_from_camera).color;
    add_noise(image, config.noise, noise.fork(images.size()));
    images.push_back(describe_image(std::move(image), config));
  }
  return images;
}

Images describe_file(const VocabularyTraining& config, const std::filesystem::path& file) {
  const cv::Mat bgr = read_image(file, ImageForm::kColor);
  Grid2d<Rgb8> image(bgr.cols, bgr.rows);
  for (int y = 0; y < bgr.rows; ++y)
    for (int x = 0; x < bgr.cols; ++x) {
      const auto& pixel = bgr.at<cv::Vec3b>(y, x);
      image(x, y) = {pixel[2], pixel[1], pixel[0]};
    }
  return {describe_image(std::move(image), config)};
}

/// Runs jobs in any order. Their results are returned in the order of the jobs.
template <class Job>
Images collect(int count, int threads, const std::function<void(int, int)>& progress,
               const Job& job) {
  std::vector<Images> parts(static_cast<std::size_t>(count));
  std::vector<std::exception_ptr> faults(parts.size());
  std::mutex mutex;
  int done = 0;
  parallel_for(count, threads, [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    try {
      parts[index] = job(index);
      const std::scoped_lock lock(mutex);
      if (progress) progress(++done, count);
    } catch (...) {  // must not escape a thread
      faults[index] = std::current_exception();
    }
  });
  for (const std::exception_ptr& fault : faults)
    if (fault) std::rethrow_exception(fault);
  Images images;
  for (Images& part : parts) std::ranges::move(part, std::back_inserter(images));
  return images;
}

}  // namespace

std::vector<std::filesystem::path> load_image_list(const std::filesystem::path& list) {
  std::istringstream text(read_text(list));
  std::vector<std::filesystem::path> images;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    line.resize(std::min(line.find('#'), line.size()));
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos) continue;
    const std::string name = line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
    images.push_back(list.parent_path() / name);
    if (!std::filesystem::is_regular_file(images.back()))
      throw InputError(fmt::format("{}:{}: no such image: {}", list.string(), number, name));
  }
  if (images.empty()) throw InputError(fmt::format("{}: names no image", list.string()));
  return images;
}

Vocabulary train_vocabulary(const VocabularyTraining& config,
                            const std::function<void(int done, int total)>& progress) {
  validate(config);
  const Images images =
      config.images.empty()
          ? collect(config.rooms, config.threads, progress,
                    [&](std::size_t room) { return describe_room(config, room); })
          : collect(static_cast<int>(config.images.size()), config.threads, progress,
                    [&](std::size_t i) { return describe_file(config, config.images[i]); });
  Vocabulary::TrainConfig tree = config.tree;
  tree.seed = RandomStream(config.seed).fork(kTree).key();
  return Vocabulary::train(images, tree);
}

}  // namespace mh
