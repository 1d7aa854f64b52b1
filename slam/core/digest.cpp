// SPDX-License-Identifier: Apache-2.0
#include "slam/core/digest.hpp"
#include "slam/io/files.hpp"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

namespace mh {
namespace {

template <class T>
std::uint64_t digest_value(const T& value, std::uint64_t seed) {
  return digest_bytes(&value, sizeof value, seed);
}

template <class T>
std::uint64_t digest_grid(const Grid2d<T>& grid, std::uint64_t seed) {
  const int size[2] = {grid.width(), grid.height()};
  return digest_bytes(grid.data(), grid.size() * sizeof(T), digest_value(size, seed));
}

std::uint64_t digest_pose(const SE3& pose, std::uint64_t seed) {
  seed = digest_bytes(pose.rotation().data(), 9 * sizeof(double), seed);
  return digest_bytes(pose.translation().data(), 3 * sizeof(double), seed);
}

}  // namespace

std::uint64_t digest_bytes(const void* data, std::size_t size, std::uint64_t seed) {
  return XXH3_64bits_withSeed(data, size, seed);
}

std::uint64_t chained(std::uint64_t sum, std::uint64_t next) {
  return digest_bytes(&next, sizeof next, sum);
}

std::uint64_t digest_file(const std::filesystem::path& file, std::uint64_t seed) {
  const std::string content = read_file(file);
  return digest_bytes(content.data(), content.size(), seed);
}

std::uint64_t digest(const RgbdFrame& frame) {
  std::uint64_t d = digest_value(frame.stamp_ns, 0);
  d = digest_grid(frame.color, d);
  d = digest_grid(frame.depth_m, d);
  d = digest_grid(frame.semantics.index, d);
  for (const ClassDistribution& distribution : frame.semantics.palette) {
    d = digest_value(distribution.entries.size(), d);
    for (const auto& [id, probability] : distribution.entries)
      d = digest_value(probability, digest_value(id, d));
  }
  return d;
}

std::uint64_t digest(const std::optional<SE3>& pose) {
  return pose ? digest_pose(*pose, 1) : 0;
}

std::uint64_t digest(const Trajectory& trajectory) {
  std::uint64_t d = digest_value(trajectory.size(), 0);
  for (const TimedPose& pose : trajectory)
    d = digest_pose(pose.world_from_camera, digest_value(pose.stamp_ns, d));
  return d;
}

std::string hex(std::uint64_t digest) {
  return fmt::format("{:016x}", digest);
}

std::string text_key(std::string_view text) {
  const XXH128_hash_t h = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", h.high64, h.low64);
}

}  // namespace mh
