// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include "sim/sensors/label_faults.hpp"
#include "sim/sensors/labels.hpp"
#include "sim/sensors/visible_objects.hpp"

namespace mh {
namespace {

/// Palette entry c is class c with certainty; void is the empty distribution.
std::vector<ClassDistribution> one_hot_palette() {
  std::vector<ClassDistribution> palette;
  for (const ClassInfo& info : classes()) palette.push_back(ClassDistribution::one_hot(info.id));
  return palette;
}

template <class Box>
void fill(Grid2d<std::uint8_t>& index, const Box& box, std::uint8_t value) {
  for (int y = box.top; y <= box.bottom; ++y)
    std::fill_n(&index(box.left, y), box.right - box.left + 1, value);
}

SemanticImage boxes_image(const RenderedFrame& truth, std::vector<VisibleObject> objects) {
  std::erase_if(objects, [](const VisibleObject& object) {
    return object.pixels < kMinBoxPixels || !is_coco(object.class_id);
  });
  sort_for_painting(objects);
  SemanticImage image{{truth.classes.width(), truth.classes.height(), kBackground},
                      one_hot_palette()};
  for (const VisibleObject& box : objects) fill(image.index, box, box.class_id);
  return image;
}

/// Gives each visible object an entry of its own: equal distributions under different entries. If
/// the palette is too small, the smallest objects keep the entry of their class.
/// @param image  labels by class: entry c is class c
void name_objects(SemanticImage& image, const Grid2d<InstanceId>& instances) {
  constexpr std::size_t kMost = 256;
  struct Object {
    std::uint32_t pixels = 0;
    ClassId class_id = kVoid;  ///< class of its first pixel; excludes pixels of other classes
    std::uint8_t entry = 0;    ///< 0: it has no entry of its own
  };
  std::vector<Object> objects;  // by instance
  const auto object_at = [&](std::size_t pixel) -> Object* {
    const InstanceId instance = instances.data()[pixel];
    const ClassId class_id = image.index.data()[pixel];
    if (instance == 0 || class_id == kVoid) return nullptr;
    if (instance >= objects.size()) objects.resize(instance + 1U);
    Object& object = objects[instance];
    if (object.pixels == 0) object.class_id = class_id;
    return object.class_id == class_id ? &object : nullptr;
  };
  for (std::size_t i = 0; i < image.index.size(); ++i)
    if (Object* object = object_at(i)) ++object->pixels;
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].pixels > 0) seen.push_back(i);
  std::ranges::stable_sort(seen, std::ranges::greater(),
                           [&](std::size_t i) { return objects[i].pixels; });
  if (seen.size() > kMost - image.palette.size()) seen.resize(kMost - image.palette.size());
  for (const std::size_t i : seen) {
    objects[i].entry = static_cast<std::uint8_t>(image.palette.size());
    image.palette.push_back(ClassDistribution(image.palette[objects[i].class_id]));
  }
  for (std::size_t i = 0; i < image.index.size(); ++i)
    if (const Object* object = object_at(i); object && object->entry != 0)
      image.index.data()[i] = object->entry;
}

/// Each pixel's class, or the class that a fault gave to its instance; instances that lost their
/// class are void.
SemanticImage exact_image(const RenderedFrame& truth, const std::vector<VisibleObject>& before,
                          const std::vector<VisibleObject>& after) {
  SemanticImage image{truth.classes, one_hot_palette()};
  std::vector<ClassId> given, was;  // by instance
  for (const VisibleObject& object : before) {
    was.resize(object.instance + 1U, kVoid);
    was[object.instance] = object.class_id;
  }
  given.resize(was.size(), kVoid);
  for (const VisibleObject& object : after) given[object.instance] = object.class_id;
  if (was == given) return image;
  for (std::size_t i = 0; i < image.index.size(); ++i) {
    const InstanceId instance = truth.instances.data()[i];
    if (instance < was.size() && was[instance] != given[instance])
      image.index.data()[i] = given[instance];
  }
  return image;
}

/// Replaces each class by the one that represents it in a set; entries stay separate.
void group_classes(SemanticImage& image, ClassSet set) {
  if (set == ClassSet::kAll) return;
  for (ClassDistribution& labels : image.palette) {
    std::map<ClassId, float> shares;
    for (const auto& [class_id, share] : labels.entries) shares[class_in(set, class_id)] += share;
    labels.entries.assign(shares.begin(), shares.end());
  }
}

/// Labels of pixels or boxes, with one palette entry per class.
SemanticImage without_faults(const RenderedFrame& truth, LabelMode mode) {
  return is_per_pixel(mode) ? SemanticImage{truth.classes, one_hot_palette()}
                            : boxes_image(truth, visible_objects(truth));
}

SemanticImage detector_image(const RenderedFrame& truth, const std::vector<Detection>& found) {
  constexpr std::uint8_t kBackgroundIndex = 1;
  SemanticImage image{{truth.classes.width(), truth.classes.height(), kBackgroundIndex},
                      {ClassDistribution{}, ClassDistribution::one_hot(kBackground)}};
  for (const Detection& box : found) {
    fill(image.index, box, static_cast<std::uint8_t>(image.palette.size()));
    image.palette.push_back(box.classes);
  }
  return image;
}

}  // namespace

std::vector<VisibleObject> visible_objects(const RenderedFrame& truth) {
  std::vector<VisibleObject> objects;  // by instance
  for (int y = 0; y < truth.classes.height(); ++y)
    for (int x = 0; x < truth.classes.width(); ++x) {
      const InstanceId instance = truth.instances(x, y);
      if (instance == 0 || truth.classes(x, y) == kVoid) continue;
      if (instance >= objects.size()) objects.resize(instance + 1U);
      objects[instance].class_id = truth.classes(x, y);
      objects[instance].instance = instance;
      objects[instance].include(x, y);
    }
  std::erase_if(objects, [](const VisibleObject& object) { return object.pixels == 0; });
  return objects;
}

void sort_for_painting(std::vector<VisibleObject>& objects) {
  std::sort(objects.begin(), objects.end(), [](const VisibleObject& a, const VisibleObject& b) {
    return std::tuple(-a.area(), a.instance) < std::tuple(-b.area(), b.instance);
  });
}

SemanticImage label_image(const RenderedFrame& truth, LabelMode mode) {
  if (mode == LabelMode::kNone) return {};
  SemanticImage image = without_faults(truth, mode);
  if (is_per_pixel(mode)) name_objects(image, truth.instances);
  return image;
}

SemanticImage label_image(const RenderedFrame& truth, LabelMode mode, const LabelConfig& config,
                          const SE3& world_from_camera, RandomStream stream) {
  if (mode == LabelMode::kNone) return {};
  SemanticImage image;
  const LabelNoiseConfig noise = config.noise.enabled ? config.noise : LabelNoiseConfig{};
  if (mode == LabelMode::kDetector) {
    image = detector_image(truth, detect(truth, config, world_from_camera, stream));
  } else if (noise.confusion == 0.0 && noise.swap == 0.0 && noise.dropout == 0.0) {
    image = without_faults(truth, mode);
  } else {
    const std::vector<VisibleObject> objects = visible_objects(truth);
    const std::vector<VisibleObject> faulty =
        with_faults(objects, noise, FaultDraws(config, world_from_camera, stream));
    image = mode == LabelMode::kBoxes ? boxes_image(truth, faulty)
                                      : exact_image(truth, objects, faulty);
  }
  erode(image.index, noise.erosion_px);
  if (is_per_pixel(mode)) name_objects(image, truth.instances);
  group_classes(image, noise.class_set);
  return image;
}

}  // namespace mh
