// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/twin.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "bench/protocol/score.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr float kSamePlace_px = 3, kNear_px = 20;
constexpr int kSameDescriptor_bits = 50;  // MatchConfig::max_distance

bool has_return(float depth_m) {
  return std::isfinite(depth_m) && depth_m > 0;
}

double depth_share(const Grid2d<float>& depth_m) {
  const auto with = std::count_if(depth_m.begin(), depth_m.end(), has_return);
  return static_cast<double>(with) /
         static_cast<double>(depth_m.width() * static_cast<std::size_t>(depth_m.height()));
}

std::optional<double> median_difference_m(const Grid2d<float>& a, const Grid2d<float>& b) {
  std::vector<double> differences;
  for (int y = 0; y < std::min(a.height(), b.height()); ++y)
    for (int x = 0; x < std::min(a.width(), b.width()); ++x)
      if (has_return(a(x, y)) && has_return(b(x, y)))
        differences.push_back(std::abs(static_cast<double>(a(x, y)) - b(x, y)));
  if (differences.empty()) return std::nullopt;
  return percentile(std::move(differences), 0.5);
}

RandomStream draws(std::uint64_t of, std::size_t i) {
  return RandomStream(of).fork(i);
}

}  // namespace

PosedFrames::PosedFrames(std::unique_ptr<Sequence> all, const SE3& scene_from_recording,
                         std::size_t at_most)
    : all_(std::move(all)) {
  for (std::size_t i = 0; i < all_->size() && index_.size() < at_most; ++i) {
    const QueryMoment moment = moment_of(all_->stamp_ns(i), all_->truth());
    // The twin's camera moves along these poses (Shutter), so their stamps must increase.
    if (!moment.true_world_from_camera ||
        (!poses_.empty() && moment.stamp_ns <= poses_.back().stamp_ns)) {
      ++left_out_;
      continue;
    }
    index_.push_back(i);
    poses_.push_back({moment.stamp_ns, scene_from_recording * *moment.true_world_from_camera});
  }
  if (poses_.size() < 2)
    throw InputError(fmt::format("{} of the recording {} a true pose: a twin needs two",
                                 counted(poses_.size(), "frame"),
                                 poses_.size() == 1 ? "has" : "have"));
}

KeypointAgreement agreement(const Features& first, const Features& other) {
  KeypointAgreement result{.keypoints = first.size()};
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Keypoint& a = first.keypoints[i];
    bool repeated = false, best_is_here = false;
    int best = std::numeric_limits<int>::max();
    for (std::size_t j = 0; j < other.size(); ++j) {
      const Keypoint& b = other.keypoints[j];
      const float apart_px = std::hypot(a.u_px - b.u_px, a.v_px - b.v_px);
      if (apart_px > kNear_px || std::abs(a.octave - b.octave) > 1) continue;
      const bool here = apart_px <= kSamePlace_px;
      repeated = repeated || here;
      const int distance = hamming(first.descriptors[i], other.descriptors[j]);
      if (distance < best || (distance == best && here)) best = distance, best_is_here = here;
    }
    result.repeated += repeated ? 1 : 0;
    if (best > kSameDescriptor_bits) continue;
    (best_is_here ? result.matched : result.mismatched) += 1;
  }
  return result;
}

std::vector<TwinFrame> compare_twins(const Sequence& recorded, const Sequence& twin,
                                     const FeatureConfig& features, std::size_t every,
                                     const std::function<void(double)>& progress) {
  std::vector<TwinFrame> frames;
  for (std::size_t i = 0; i < recorded.size(); i += every) {
    if (progress) progress(static_cast<double>(i) / static_cast<double>(recorded.size()));
    RgbdFrame real;
    try {
      real = recorded.frame(i, draws(0, i));
    } catch (const InputError&) {
      continue;  // the image cannot be read
    }
    if (real.color.width() != recorded.camera().width_px ||
        real.color.height() != recorded.camera().height_px)
      continue;
    const RgbdFrame made = twin.frame(i, draws(1, i)), again = twin.frame(i, draws(2, i));
    const Features real_features = extract(real, recorded.camera(), features),
                   made_features = extract(made, twin.camera(), features),
                   again_features = extract(again, twin.camera(), features);
    frames.push_back({.stamp_ns = recorded.stamp_ns(i),
                      .recorded = measure_image(real.color),
                      .rendered = measure_image(made.color),
                      .recorded_depth_share = depth_share(real.depth_m),
                      .rendered_depth_share = depth_share(made.depth_m),
                      .depth_difference_m = median_difference_m(real.depth_m, made.depth_m),
                      .across = agreement(real_features, made_features),
                      .noise = agreement(made_features, again_features)});
  }
  return frames;
}

std::vector<TwinRow> summarize(const std::vector<TwinFrame>& frames) {
  const auto median = [&](const auto& value) {
    std::vector<double> values;
    for (const TwinFrame& frame : frames) values.push_back(value(frame));
    return percentile(std::move(values), 0.5);
  };
  std::vector<TwinRow> rows;
  for (std::size_t q = 0; q < kImageQuantityCount; ++q)
    rows.push_back({std::string(kImageQuantities[q].key), std::string(kImageQuantities[q].name),
                    median([&](const TwinFrame& f) { return f.recorded[q]; }),
                    median([&](const TwinFrame& f) { return f.rendered[q]; })});
  rows.push_back({"depth_share", "pixels with depth, share",
                  median([](const TwinFrame& f) { return f.recorded_depth_share; }),
                  median([](const TwinFrame& f) { return f.rendered_depth_share; })});
  const auto keypoints = [](const KeypointAgreement& a) {
    return static_cast<double>(a.keypoints);
  };
  rows.push_back({"keypoints", "keypoints of SLAM",
                  median([&](const TwinFrame& f) { return keypoints(f.across); }),
                  median([&](const TwinFrame& f) { return keypoints(f.noise); })});
  const auto share = [&](std::size_t KeypointAgreement::*part, KeypointAgreement TwinFrame::*of) {
    double hits = 0, all = 0;
    for (const TwinFrame& frame : frames) {
      hits += static_cast<double>(frame.*of.*part);
      all += static_cast<double>((frame.*of).keypoints);
    }
    return all > 0 ? hits / all : std::numeric_limits<double>::quiet_NaN();
  };
  // Agreement of recorded keypoints with the rendering and, as an upper bound, of rendered
  // keypoints with a rendering with different noise.
  for (const auto& [key, name, part] :
       {std::tuple{"repeated", "keypoints repeated in the rendering, share",
                   &KeypointAgreement::repeated},
        std::tuple{"matched", "keypoints matched to their place, share",
                   &KeypointAgreement::matched},
        std::tuple{"mismatched", "keypoints matched elsewhere, share",
                   &KeypointAgreement::mismatched}})
    rows.push_back({key, name, share(part, &TwinFrame::across), share(part, &TwinFrame::noise)});
  return rows;
}

}  // namespace mh
