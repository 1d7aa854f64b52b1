// SPDX-License-Identifier: Apache-2.0
#include "slam/relocalize/beyond_paper.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Core>

namespace mh {
namespace {

constexpr int kFewestKeypoints = 5, kFewestMatches = 10;

/// Where the keypoints of one class lie in a view.
struct Spread {
  int count = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0;

  double size_px() const {
    return std::sqrt(std::max(0.0, squares / count - (sum / count).squaredNorm()));
  }
};

std::map<ClassId, Spread> spreads(const Features& features) {
  std::map<ClassId, Spread> by_class;
  for (const Keypoint& k : features.keypoints) {
    if (k.label == kVoid) continue;
    Spread& spread = by_class[k.label];
    const Eigen::Vector2d at(k.u_px, k.v_px);
    ++spread.count;
    spread.sum += at;
    spread.squares += at.squaredNorm();
  }
  return by_class;
}

}  // namespace

double size_agreement(const Features& a, const Features& b) {
  const std::map<ClassId, Spread> in_a = spreads(a), in_b = spreads(b);
  double sum = 0, weights = 0;
  for (const auto& [label, spread] : in_a) {
    const auto other = in_b.find(label);
    if (other == in_b.end()) continue;
    const int fewer = std::min(spread.count, other->second.count);
    const double x = spread.size_px(), y = other->second.size_px();
    if (fewer < kFewestKeypoints || std::max(x, y) <= 0) continue;
    sum += fewer * std::min(x, y) / std::max(x, y);
    weights += fewer;
  }
  return weights > 0 ? sum / weights : 1.0;
}

std::vector<Candidate<KeyframeId>> side_by_side(std::span<const Candidate<KeyframeId>> a,
                                                std::span<const Candidate<KeyframeId>> b) {
  std::vector<Candidate<KeyframeId>> both;
  const auto add = [&](std::span<const Candidate<KeyframeId>> list, std::size_t i) {
    if (i < list.size() &&
        std::ranges::find(both, list[i].keyframe, &Candidate<KeyframeId>::keyframe) == both.end())
      both.push_back(list[i]);
  };
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    add(a, i);
    add(b, i);
  }
  return both;
}

double label_agreement(const Features& view, std::span<const LandmarkId> landmarks,
                       const Map& map) {
  int known = 0, equal = 0;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (!landmarks[i].valid()) continue;
    const ClassId seen = view.keypoints[i].label, mapped = map.at(landmarks[i]).label;
    if (seen == kVoid || mapped == kVoid) continue;
    ++known;
    equal += seen == mapped;
  }
  return known < kFewestMatches ? 1.0 : static_cast<double>(equal) / known;
}

}  // namespace mh
