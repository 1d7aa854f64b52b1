// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/bundle.hpp"
#include "slam/config/features.hpp"
#include "slam/config/keyframe.hpp"
#include "slam/config/loop.hpp"
#include "slam/config/match.hpp"
#include "slam/config/pose.hpp"
#include "slam/config/relocalize.hpp"
#include "slam/config/semantics.hpp"
#include "slam/config/track.hpp"

namespace mh {

/// Configuration of one SLAM run: everything that determines its result, except the vocabulary and
/// the frames.
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
  friend bool operator==(const SlamConfig&, const SlamConfig&) = default;
};

/// Visits the sections.
template <MaybeConst<SlamConfig> C, class Visit>
void fields(C& config, Visit& v) {
  auto& [features, semantics, match, pose, bundle, keyframe, track, relocalize, loop] = config;
  v("features", features);
  v("semantics", semantics);
  v("match", match);
  v("pose", pose);
  v("bundle", bundle);
  v("keyframe", keyframe);
  v("track", track);
  v("relocalize", relocalize);
  v("loop", loop);
}

/// Calls visit.section(name) before each section and visit(name, value, range, note) for each
/// field.
template <MaybeConst<SlamConfig> C, class Visit>
void for_each_setting(C& config, Visit&& visit) {
  const auto part = [&](const char* name, auto& section) {
    visit.section(name);
    fields(section, visit);
  };
  fields(config, part);
}

/// Checks every setting. @throws InputError naming a field that is out of range, and its value.
void validate(const SlamConfig& config);

}  // namespace mh
