// SPDX-License-Identifier: Apache-2.0
#include "bench/vocabulary_training.hpp"

#include <exception>
#include <mutex>
#include <vector>

#include <fmt/format.h>

#include "scenes/training/training.hpp"
#include "sim/render/bake.hpp"
#include "sim/render/parallel.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/sensors.hpp"
#include "slam/core/error.hpp"
#include "slam/core/random.hpp"

namespace mh {
namespace {

enum Stream : std::uint64_t { kRooms = 1, kViews, kNoise, kTree };

void require(bool good, const char* field, int value) {
  if (!good)
    throw InputError(fmt::format("vocabulary training: {} = {} is out of range: must be 1 or more",
                                 field, value));
}

// The descriptors of each view of one room.
std::vector<std::vector<Descriptor>> descriptors_of_room(const VocabularyTraining& config,
                                                         std::uint64_t room) {
  const RandomStream random(config.seed);
  Scene scene = make_training_room(random.fork(kRooms).bits(room));
  bake_light(scene, {.samples = config.light_samples,
                     .bounces = 1,
                     .sun_samples = config.light_samples,
                     .seed = room,
                     .threads = 1});
  const auto renderer = make_embree_renderer(scene, {.exposure = suggest_exposure(scene)});
  // Words should tell what a camera sees, noise included.
  const RandomStream noise = random.fork(kNoise).fork(room);
  std::vector<std::vector<Descriptor>> images;
  for (const SE3& world_from_camera :
       training_views(scene, random.fork(kViews).bits(room), config.views)) {
    const RgbdFrame frame = sense(renderer->render(config.camera, world_from_camera), config.camera,
                                  SensorConfig{}, noise.fork(images.size()), 0);
    images.push_back(extract(frame, config.camera, config.features).descriptors);
  }
  return images;
}

}  // namespace

Vocabulary train_vocabulary(const VocabularyTraining& config,
                            const std::function<void(int done, int total)>& progress) {
  require(config.rooms >= 1, "rooms", config.rooms);
  require(config.views >= 1, "views", config.views);
  require(config.light_samples >= 1, "light_samples", config.light_samples);
  require(config.threads >= 1, "threads", config.threads);

  // Rooms in any order, results in theirs.
  std::vector<std::vector<std::vector<Descriptor>>> rooms(static_cast<std::size_t>(config.rooms));
  std::vector<std::exception_ptr> faults(rooms.size());
  std::mutex mutex;
  int done = 0;
  parallel_for(config.rooms, config.threads, [&](int room) {
    const auto index = static_cast<std::size_t>(room);
    try {
      rooms[index] = descriptors_of_room(config, index);
      const std::scoped_lock lock(mutex);
      if (progress) progress(++done, config.rooms);
    } catch (...) {  // must not leave a thread
      faults[index] = std::current_exception();
    }
  });
  for (const std::exception_ptr& fault : faults)
    if (fault) std::rethrow_exception(fault);

  std::vector<std::vector<Descriptor>> images;
  for (auto& room : rooms)
    for (auto& image : room) images.push_back(std::move(image));
  Vocabulary::TrainConfig tree = config.tree;
  tree.seed = RandomStream(config.seed).fork(kTree).key();
  return Vocabulary::train(images, tree);
}

}  // namespace mh
