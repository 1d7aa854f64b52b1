// SPDX-License-Identifier: Apache-2.0
#include "bench/run/shard.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/suite/run_spec.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

// Measured: docs/measurements/cost_of_the_bench.md, "Shares of an array".
constexpr double kImage_s = 0.066;  // an image with blur and rolling shutter, 640x480
constexpr double kFrame_s = 0.017;  // noise, SLAM and files of a run, for each frame with an image
constexpr double kEpisode_s = 6;    // 0.3 s per simulated second
constexpr double kAssumedFrames = 600;  // generated rooms have 300 to 1,500

double frames_of(const std::optional<std::filesystem::path>& tour, const RunSpec& run) {
  if (!tour) return 0;
  const auto stated = frames_stated(tour->string());
  const double frames = stated ? static_cast<double>(*stated) : kAssumedFrames;
  return run.max_frames ? std::min(frames, static_cast<double>(*run.max_frames)) : frames;
}

/// Finds the cheapest split of runs into any number of parts.
class SplitTable {
 public:
  explicit SplitTable(std::span<const PredictedCost> runs) {
    double own_s = 0;                   // of the runs so far
    double before_s = 0, images_s = 0;  // of the images so far, without and with those of this run
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (i > 0 && runs[i].images != runs[i - 1].images) before_s = images_s;
      images_s = before_s + runs[i].images_s;
      begin_s_.push_back(own_s + before_s);
      own_s += runs[i].own_s;
      end_s_.push_back(own_s + images_s);
    }
  }

  /// Predicted cost of the runs [begin, end), a range that is not empty.
  double cost_s(std::size_t begin, std::size_t end) const {
    return end_s_[end - 1] - begin_s_[begin];
  }

  /// Starts of `parts` shares, none of them empty. @pre 1 <= parts <= runs
  std::vector<std::size_t> begins(std::size_t parts) {
    const std::size_t runs = begin_s_.size();
    std::vector<std::vector<std::size_t>> last_begin;  // by part, then number of runs
    least_.assign(runs + 1, std::numeric_limits<double>::infinity());
    least_[0] = 0;
    for (std::size_t part = 1; part <= parts; ++part) {
      next_.assign(runs + 1, std::numeric_limits<double>::infinity());
      begin_.assign(runs + 1, 0);
      fill(part, runs, part - 1, runs - 1);
      least_ = next_;
      last_begin.push_back(begin_);
    }
    std::vector<std::size_t> found(parts);
    for (std::size_t part = parts, end = runs; part > 0; --part)
      found[part - 1] = end = last_begin[part - 1][end];
    return found;
  }

 private:
  /// Fills next_[low .. high], given that their best last shares begin within [first, last]. The
  /// eighth power of a share's cost, end_s_[end] - begin_s_[begin], is convex, and both terms
  /// ascend. The best start therefore never decreases as the end increases, and each half needs to
  /// search only the starts on its own side of the middle's best start.
  void fill(std::size_t low, std::size_t high, std::size_t first, std::size_t last) {
    if (low > high) return;
    const std::size_t middle = (low + high) / 2;
    for (std::size_t begin = first; begin <= std::min(last, middle - 1); ++begin) {
      const double square = cost_s(begin, middle) * cost_s(begin, middle);
      const double sum = least_[begin] + square * square * square * square;
      if (sum >= next_[middle]) continue;
      next_[middle] = sum;
      begin_[middle] = begin;
    }
    fill(low, middle - 1, first, begin_[middle]);
    fill(middle + 1, high, begin_[middle], last);
  }

  std::vector<double> begin_s_, end_s_;  // for cost_s()
  std::vector<double> least_, next_;  // lowest sum for the first n runs, without and with this part
  std::vector<std::size_t> begin_;    // start of the last part of the first n runs
};

/// The number of graded queries if every bin is filled; the actual number is not known before the
/// drive.
double graded_queries(const RunSpec& run) {
  if (!run.graded) return 0;
  const GradedSpec& g = *run.graded;
  return static_cast<double>(bins(g.distance_m) * bins(g.angle_deg) * g.per_bin * g.speed.size());
}

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  char slash = 0, more = 0;
  if (std::sscanf(text.c_str(), "%zu%c%zu%c", &shard.index, &slash, &shard.of, &more) != 3 ||
      slash != '/' || shard.index < 1 || shard.index > shard.of ||
      text.find('-') != std::string::npos)
    throw InputError(fmt::format("shard '{}' is not i/n with 1 <= i <= n", text));
  return shard;
}

std::string images_of(const RunSpec& run) {
  const nlohmann::ordered_json json = to_json(run);
  return text_key(json.at("environment").dump() + json.at("level").dump() +
                  json.at("max_frames").dump());
}

PredictedCost predicted_cost(const RunSpec& run) {
  const Environment& e = run.environment;
  const double toured = e.is_recorded()
                            ? frames_of(e.sequence, run)
                            : frames_of(e.mapping_tour, run) + frames_of(e.kidnapped_tour, run);
  const double mapped = run.episodes ? toured / run.episodes->ticks_per_frame : toured;
  const double second = e.is_recorded() ? frames_of(e.queries, run) : frames_of(e.query_tour, run);
  const double share = run.protocol.test_interval > 0 ? 1.0 / run.protocol.test_interval : 0;
  const double episodes = run.episodes ? static_cast<double>(run.episodes->count()) : 0;
  const double graded = graded_queries(run);
  const double asked =
      static_cast<double>(run.points.size()) * (share * (mapped + second) + graded);
  return {.images = images_of(run),
          .images_s = e.is_recorded() ? 0 : kImage_s * (mapped + share * second + graded),
          .own_s = kFrame_s * (mapped + asked) + kEpisode_s * episodes};
}

std::vector<PredictedShare> split_runs(std::span<const PredictedCost> runs, std::size_t parts) {
  std::vector<PredictedShare> shares(parts, {runs.size(), runs.size(), 0});
  if (runs.empty() || parts == 0) return shares;
  SplitTable table(runs);
  const std::vector<std::size_t> begins = table.begins(std::min(parts, runs.size()));
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const std::size_t end = i + 1 < begins.size() ? begins[i + 1] : runs.size();
    shares[i] = {begins[i], end, table.cost_s(begins[i], end)};
  }
  return shares;
}

std::vector<PredictedShare> split_runs(std::span<const RunSpec> runs, std::size_t parts) {
  std::vector<PredictedCost> costs;
  for (const RunSpec& run : runs) costs.push_back(predicted_cost(run));
  return split_runs(costs, parts);
}

}  // namespace mh
