// SPDX-License-Identifier: Apache-2.0
// The map file, little-endian:
//   8 bytes  magic "MHMAP\n\0\0"
//   u32      version
//   u64      digest of the vocabulary
//   u64      size of the content
//   content  settings (YAML), camera, keyframes, landmarks, state of tracking and loop closing,
//            tracked frames; lists start with their length (u64), see slam/map/archive.hpp
//   u64      xxh3-64 of all preceding bytes
#include "slam/files/map_file.hpp"

#include <fstream>

#include <fmt/format.h>
#include <xxhash.h>

#include "slam/files/settings_file.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/map/archive.hpp"

namespace mh {
namespace archive {

template <class A, MaybeConst<LastFrame> T>
void fields(A& a, T& last) {
  auto& [stamp_ns, camera_from_world, features, landmarks, odom_from_camera] = last;
  a(stamp_ns, camera_from_world, features, landmarks, odom_from_camera);
}
template <class A, MaybeConst<Reckoning> T>
void fields(A& a, T& reckoning) {
  auto& [distance_m, turn_rad] = reckoning;
  a(distance_m, turn_rad);
}
template <class A, MaybeConst<Motion> T>
void fields(A& a, T& motion) {
  auto& [velocity_per_s, pose_covariance, pose_velocity_covariance, velocity_covariance] = motion;
  a(velocity_per_s, pose_covariance, pose_velocity_covariance, velocity_covariance);
}
template <class A, MaybeConst<ImuReading> T>
void fields(A& a, T& reading) {
  auto& [stamp_ns, turn_rad_per_s, specific_force_m_per_s2] = reading;
  a(stamp_ns, turn_rad_per_s, specific_force_m_per_s2);
}
template <class A, MaybeConst<InertialMotion> T>
void fields(A& a, T& motion) {
  auto& [velocity_m_per_s, gravity_m_per_s2, turn_bias, force_bias, covariance, before,
         own_from_tracked] = motion;
  a(velocity_m_per_s, gravity_m_per_s2, turn_bias, force_bias);
  elements(a, covariance);
  a(before, own_from_tracked);
}
template <class A, MaybeConst<InertialMotion::Known> T>
void fields(A& a, T& known) {
  auto& [gravity_in_world, turn_bias, force_bias, covariance] = known;
  a(gravity_in_world, turn_bias, force_bias);
  elements(a, covariance);
}
template <class A, MaybeConst<StaleScores::Score> T>
void fields(A& a, T& score) {
  auto& [similarity, query] = score;
  a(similarity, query);
}
template <class A, MaybeConst<StaleScores> T>
void fields(A& a, T& scores) {
  auto& [of, queries] = scores;
  a(of, queries);
}
template <class A, MaybeConst<Tracker> T>
void fields(A& a, T& tracker) {
  auto& [last, velocity_per_s, motion, reference, frames_since_keyframe, coasting, reckoning,
         inertial, inertial_known, stale_scores] = tracker;
  a(last, velocity_per_s, motion, reference, frames_since_keyframe, coasting, reckoning, inertial,
    inertial_known, stale_scores);
}
template <class A, MaybeConst<PiecePlace> T>
void fields(A& a, T& place) {
  auto& [origin, other, other_from_own, keyframe, agreeing, way_m] = place;
  a(origin, other, other_from_own, keyframe, agreeing, way_m);
}
template <class A, MaybeConst<LoopMemory> T>
void fields(A& a, T& memory) {
  auto& [drift, keyframe, agreeing, places] = memory;
  a(drift, keyframe, agreeing, places);
}
template <class A, MaybeConst<TrackedFrame> T>
void fields(A& a, T& frame) {
  auto& [reference, camera_from_reference] = frame;
  a(reference, camera_from_reference);
}

namespace {

using TrackedFrames = std::map<Stamp, TrackedFrame>;

void write_tracked_frames(Writer& writer, const TrackedFrames& frames) {
  writer(static_cast<std::uint64_t>(frames.size()));
  for (const auto& [stamp_ns, frame] : frames) writer(stamp_ns, frame);
}

TrackedFrames read_tracked_frames(Reader& reader, const Map& map) {
  std::uint64_t size = 0;
  reader(size);
  TrackedFrames frames;
  for (std::uint64_t i = 0; i < size; ++i) {
    Stamp stamp_ns = 0;
    TrackedFrame frame;
    reader(stamp_ns, frame);
    reader.require(frame.reference.value < map.keyframes().size(), "a tracked frame's keyframe");
    reader.require(frames.empty() || frames.rbegin()->first < stamp_ns, "the order of frames");
    frames.emplace_hint(frames.end(), stamp_ns, std::move(frame));
  }
  return frames;
}

void check(const Reader& reader, const Tracker& tracker, const Map& map) {
  const StaleScores& scores = tracker.stale_scores;
  reader.require(scores.of.size() <= map.keyframes().size(), "the number of released scores");
  for (const StaleScores::Score& score : scores.of)
    reader.require(score.query >= 0 && score.query <= scores.queries, "a released score's query");
  if (!tracker.last) return;
  reader.require(tracker.last->landmarks.size() == tracker.last->features.size(),
                 "the last frame's number of landmarks");
  for (const LandmarkId id : tracker.last->landmarks)
    reader.require(!id.valid() || id.value < map.landmarks().size(), "the last frame's landmark");
  reader.require(tracker.reference.value < map.keyframes().size(), "the reference keyframe");
}

/// Version and vocabulary digest are read before the checksum is known to match, so that an older
/// program can still report what kind of file it received.
constexpr std::string_view kMagic{"MHMAP\n\0\0", 8};
constexpr std::size_t kHeaderSize = kMagic.size() + 4 + 8 + 8;

/// The content of a map file, after its header and checksum are checked.
std::string_view checked_content(std::string_view bytes, const std::string& name,
                                 std::uint64_t vocabulary_digest) {
  const std::string_view start = bytes.substr(0, kMagic.size());
  if (start.empty() || start != kMagic.substr(0, start.size()))
    throw InputError(fmt::format("{}: is not a Modelhouse map", name));
  const auto cut_short = [&](std::uint64_t needed) {
    throw InputError(fmt::format("{}: is {}: has {} bytes, needs {}", name,
                                 bytes.size() < needed ? "truncated" : "too long", bytes.size(),
                                 needed));
  };
  if (bytes.size() < kHeaderSize) cut_short(kHeaderSize);
  Reader header(bytes.substr(kMagic.size()), name);
  std::uint32_t version = 0;
  std::uint64_t vocabulary = 0, size = 0, stored = 0;
  header(version, vocabulary, size);
  if (version != kMapFileVersion)
    throw InputError(fmt::format("{}: is a map of version {}, but this program reads {}", name,
                                 version, kMapFileVersion));
  const std::uint64_t all =
      bytes.size() - kHeaderSize;  // nothing is added to `size`, which may be wrong and overflow
  if (all < sizeof stored || size != all - sizeof stored)
    cut_short(size > (UINT64_MAX >> 1) ? size : kHeaderSize + size + sizeof stored);
  const std::string_view before = bytes.substr(0, bytes.size() - sizeof stored);
  Reader end(bytes.substr(before.size()), name);
  end(stored);
  if (const std::uint64_t actual = XXH3_64bits(before.data(), before.size()); actual != stored)
    throw InputError(
        fmt::format("{}: is damaged: checksum {:016x} instead of {:016x}", name, actual, stored));
  if (vocabulary != vocabulary_digest)
    throw InputError(
        fmt::format("{}: was made with another vocabulary: digest {:016x}, this one has {:016x}",
                    name, vocabulary, vocabulary_digest));
  return before.substr(kHeaderSize);
}

SlamConfig parse_config(const std::string& text, const std::string& name) {
  YamlReader yaml = YamlReader::parse(text, name + ": settings");
  const SlamConfig config = read_slam_config(yaml);
  yaml.finish();
  return config;
}

}  // namespace
}  // namespace archive

std::string encode_slam(const SlamState& state) {
  using namespace archive;
  const auto& [camera, depth_frames, config, vocabulary, map, tracker, loop_memory, tracked_frames,
               last_stamp_ns] = state;
  Writer content;
  content(format_slam_config(config), camera, depth_frames);
  write_map(content, map);
  content(tracker, loop_memory);
  write_tracked_frames(content, tracked_frames);
  content(last_stamp_ns);
  const std::string body = content.take();

  Writer whole;
  whole.bytes(kMagic.data(), kMagic.size());
  whole(kMapFileVersion, vocabulary->digest(), static_cast<std::uint64_t>(body.size()));
  whole.bytes(body.data(), body.size());
  std::string bytes = whole.take();
  const std::uint64_t checksum = XXH3_64bits(bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  return bytes;
}

SlamState decode_slam(const std::string& bytes, const std::string& name,
                      std::shared_ptr<const Vocabulary> vocabulary) {
  using namespace archive;
  Reader content(checked_content(bytes, name, vocabulary->digest()), name);
  std::string settings;
  Camera camera;
  int depth_frames = 0;
  content(settings, camera, depth_frames);
  content.require(depth_frames >= 0, "the number of frames that taught the depth's sigma");
  SlamState state = make_slam(camera, parse_config(settings, name), std::move(vocabulary));
  state.depth_frames = depth_frames;
  state.map = read_map(content, camera, state.config.features.levels, state.vocabulary->size());
  content(state.tracker, state.loop_memory);
  check(content, state.tracker, state.map);
  for (const PiecePlace& place : state.loop_memory.places)
    content.require(
        std::max({place.origin, place.other, place.keyframe}).value < state.map.keyframes().size(),
        "a keyframe of a piece's place");
  state.tracked_frames = read_tracked_frames(content, state.map);
  content(state.last_stamp_ns);
  content.require(content.at_end(), "it has data after its end");
  return state;
}

bool is_map_file(const std::filesystem::path& file) {
  std::string start(archive::kMagic.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  return in.read(start.data(), static_cast<std::streamsize>(start.size())) &&
         start == archive::kMagic;
}

void save_slam(const std::filesystem::path& file, const SlamState& state) {
  write_atomically(file, encode_slam(state));
}

SlamState load_slam(const std::filesystem::path& file,
                    std::shared_ptr<const Vocabulary> vocabulary) {
  return decode_slam(read_file(file), file.string(), std::move(vocabulary));
}

}  // namespace mh
