// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/features/features.hpp"
#include "slam/loop/loop.hpp"
#include "slam/match/config.hpp"
#include "slam/optimize/bundle.hpp"
#include "slam/optimize/pose.hpp"
#include "slam/relocalize/relocalize.hpp"
#include "slam/track/config.hpp"

namespace mh {

/// One SLAM run: everything that decides its result beside vocabulary and frames.
struct SlamConfig {
  FeatureConfig features;
  SemanticConfig semantics;
  MatchConfig match;
  PoseConfig pose;
  BundleConfig bundle;
  KeyframeConfig keyframe;
  TrackConfig track;
  RelocalizeConfig relocalize;
  LoopConfig loop;
};

/// @throws InputError naming field and value.
void validate(const SlamConfig& config);

}  // namespace mh
