// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/survey.hpp"

#include <algorithm>

#include "scenes/generate/generate.hpp"
#include "scenes/generate/grammar.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

double MeasuredPlace::at(std::size_t quantity, double share) const {
  std::vector<double> values;
  for (const ImageStatistics& frame : frames) values.push_back(frame[quantity]);
  return percentile(std::move(values), share);
}

std::vector<RealFrames> load_real_frames(const std::filesystem::path& file) {
  YamlReader yaml = YamlReader::load(file);
  std::vector<RealFrames> all;
  for (auto& [name, entry] : yaml.entries()) {
    RealFrames real{.name = name, .source = entry.string("source"), .percentiles = {}};
    for (std::size_t q = 0; q < kImageQuantityCount; ++q) {
      const YamlReader list = entry.at(std::string(kImageQuantities[q].key));
      const std::vector<double> values = list.as_numbers(kShares.size());
      for (std::size_t k = 0; k < values.size(); ++k) {
        if (k > 0 && values[k] < values[k - 1]) list.fail("percentiles must not fall");
        real.percentiles[q][k] = values[k];
      }
    }
    entry.finish();
    all.push_back(std::move(real));
  }
  if (all.empty()) yaml.fail("holds no data set");
  return all;
}

RealismRow compare(const std::vector<MeasuredPlace>& places, const RealFrames& real,
                   std::size_t quantity) {
  const std::array<double, 5>& theirs = real.percentiles[quantity];
  RealismRow row;
  std::vector<double> frames, medians;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (const ImageStatistics& frame : places[i].frames) frames.push_back(frame[quantity]);
    const double median = places[i].at(quantity, 0.5);
    medians.push_back(median);
    if (median < theirs.front() || median > theirs.back()) row.outside.push_back(i);
  }
  for (std::size_t k = 0; k < kShares.size(); ++k) row.ours[k] = percentile(frames, kShares[k]);
  row.median_of_places = percentile(medians, 0.5);
  row.in_range = row.median_of_places >= theirs[1] && row.median_of_places <= theirs[3];
  row.spread_ratio = (row.ours[4] - row.ours[0]) / (theirs[4] - theirs[0]);
  return row;
}

std::vector<std::string> generated_rooms(int per_category) {
  std::vector<std::string> names;
  for (const Category& category : categories()) {
    const int count = per_category > 0 ? std::min(per_category, category.count) : category.count;
    for (int i = 0; i < count; ++i)
      names.push_back(to_string({category.name, static_cast<std::uint64_t>(i)}));
  }
  return names;
}

ScanMoment scan_moment(const Trajectory& scan, std::size_t k, std::size_t count) {
  constexpr std::size_t kAround = 3;
  const std::size_t at = (2 * k + 1) * scan.size() / (2 * count);
  const std::size_t first = std::clamp(at, kAround, scan.size() - 1 - kAround) - kAround;
  const auto from = scan.begin() + static_cast<std::ptrdiff_t>(first);
  return {Trajectory(from, from + 2 * kAround + 1), kAround};
}

}  // namespace mh
