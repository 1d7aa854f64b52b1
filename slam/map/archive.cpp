// SPDX-License-Identifier: Apache-2.0
#include "slam/map/archive.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>
#include <xxhash.h>

#include "slam/core/labels.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace archive {

void Reader::bytes(void* data, std::size_t size) {
  require(size <= bytes_.size(), "it ends too early");
  std::memcpy(data, bytes_.data(), size);
  bytes_.remove_prefix(size);
}

void Reader::fail(std::string_view what) const {
  throw InputError(fmt::format("{}: is not a consistent map: {}", name_, what));
}

namespace {

void check_members(const Reader& reader, const std::vector<WeightedMember>& members,
                   std::size_t count) {
  for (std::size_t i = 0; i < members.size(); ++i)
    reader.require(members[i].id < count && (i == 0 || members[i - 1].id < members[i].id),
                   "the order of labels or words");
}

/// Positions beyond this (m) are not plausible for a camera, and too far for integer cells.
constexpr double kFarthest_m = 1e6;

void check_features(const Reader& reader, const Keyframe& keyframe, int levels, std::size_t words) {
  check_members(reader, keyframe.words.vector.labels, classes().size());
  check_members(reader, keyframe.words.vector.words, words);
  reader.require(keyframe.camera_from_world.translation().norm() < kFarthest_m,
                 "a keyframe's place");
  for (const Keypoint& k : keyframe.features.keypoints) {
    reader.require(k.octave >= 0 && k.octave < levels, "a keypoint's octave");
    reader.require(k.label < classes().size(), "a keypoint's label");
  }
  for (const auto& [node, feature] : keyframe.words.by_node)
    reader.require(feature < keyframe.features.size(), "a word's feature");
  reader.require(std::is_sorted(keyframe.words.by_node.begin(), keyframe.words.by_node.end()),
                 "the order of words");
}

/// Checks that ids are within range and that chains of parents end: preconditions of Map's own
/// checks.
void check_references(const Reader& reader, const std::vector<Keyframe>& keyframes,
                      const std::vector<Landmark>& landmarks, int levels, std::size_t words) {
  const auto keyframe_stands = [&](KeyframeId id) {
    return id.value < keyframes.size() && !keyframes[id.value].erased;
  };
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Keyframe& k = keyframes[i];
    reader.require(k.id.value == i, "a keyframe's id");
    reader.require(keyframe_stands(k.origin) && keyframes[k.origin.value].origin == k.origin,
                   "a keyframe's origin");
    check_features(reader, k, levels, words);
    reader.require(k.landmarks.size() == k.features.size(), "a keyframe's number of landmarks");
    for (const LandmarkId id : k.landmarks)
      reader.require(!id.valid() || id.value < landmarks.size(), "a keyframe's landmark");
    for (const Keyframe::Neighbor& n : k.covisible)
      reader.require(keyframe_stands(n.id), "a keyframe's neighbor");
    KeyframeId ancestor = k.id;
    for (std::size_t steps = 0; !keyframe_stands(ancestor); ++steps) {
      reader.require(ancestor.value < keyframes.size() && steps < keyframes.size(),
                     "a keyframe's parent");
      ancestor = keyframes[ancestor.value].parent;
    }
  }
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Landmark& l = landmarks[i];
    if (l.erased) continue;
    reader.require(l.id.value == i, "a landmark's id");
    reader.require(l.label < classes().size(), "a landmark's label");
    reader.require(l.first_keyframe.value < keyframes.size(), "a landmark's first keyframe");
    for (std::size_t j = 0; j < l.observations.size(); ++j) {
      const Observation& o = l.observations[j];
      reader.require(
          keyframe_stands(o.keyframe) && o.feature < keyframes[o.keyframe.value].features.size(),
          "a landmark's observation");
      reader.require(j == 0 || l.observations[j - 1].keyframe < o.keyframe,
                     "the order of a landmark's observations");
    }
  }
}

}  // namespace

void write_map(Writer& writer, const Map& map) {
  writer(map.keyframes(), map.landmarks());
}

Map read_map(Reader& reader, const Camera& camera, int levels, std::size_t words) {
  std::vector<Keyframe> keyframes;
  std::vector<Landmark> landmarks;
  reader(keyframes, landmarks);
  check_references(reader, keyframes, landmarks, levels, words);
  for (Keyframe& k : keyframes)
    if (!k.erased) k.grid = FeatureGrid(k.features.keypoints, camera);
  try {
    return Map::restore(std::move(keyframes), std::move(landmarks));
  } catch (const std::logic_error& error) {
    reader.fail(error.what());
  }
}

}  // namespace archive

std::uint64_t Map::digest() const {
  archive::Writer writer;
  archive::write_map(writer, *this);
  const std::string bytes = writer.take();
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace mh
