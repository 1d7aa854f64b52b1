// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/lab/image_statistics.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// The names of the first generated environments of each category.
/// @param per_category  largest number of names per category; 0: all
std::vector<std::string> generated_rooms(int per_category);

/// One of several frames that are spread evenly over a scan, with the poses before and after it,
/// which determine its blur.
struct ScanMoment {
  Trajectory around;
  std::size_t at = 0;  ///< index of the frame's pose in `around`
};
/// @param k  index of the frame among `count`, from 0
ScanMoment scan_moment(const Trajectory& scan, std::size_t k, std::size_t count);

/// The measured frames of one environment or one recording.
struct MeasuredPlace {
  std::string name;
  std::vector<ImageStatistics> frames;
  double at(std::size_t quantity, double share) const;  ///< percentile over the frames
};

/// Percentiles 5, 25, 50, 75, 95 of each quantity, measured on real frames.
struct RealFrames {
  std::string name, source;
  std::array<std::array<double, 5>, kImageQuantityCount> percentiles;
};
inline constexpr std::array<double, 5> kShares = {0.05, 0.25, 0.5, 0.75, 0.95};

/// Reads assets/real_frames.yaml. @throws InputError naming file, line and value
std::vector<RealFrames> load_real_frames(const std::filesystem::path& file);

/// How one quantity of our places compares with that of real frames.
struct RealismRow {
  std::array<double, 5> ours;   ///< our percentiles over all frames
  double median_of_places = 0;  ///< median of the places' medians
  bool in_range = false;        ///< median_of_places is between the real 25th and 75th percentiles
  double spread_ratio = 0;      ///< 5th to 95th percentile over frames: ours / real
  std::vector<std::size_t> outside;  ///< places with medians beyond the real 5th or 95th
};
RealismRow compare(const std::vector<MeasuredPlace>& places, const RealFrames& real,
                   std::size_t quantity);

}  // namespace mh
