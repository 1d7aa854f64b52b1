// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/report.hpp"

namespace mh {

std::string_view name(TrackStatus status) {
  switch (status) {
    case TrackStatus::kInitialized: return "initialized";
    case TrackStatus::kTracked: return "tracked";
    case TrackStatus::kRelocalized: return "relocalized";
    case TrackStatus::kLost: return "lost";
  }
  return "?";
}

std::string_view name(RelocalizationStage stage) {
  switch (stage) {
    case RelocalizationStage::kNone: return "none";
    case RelocalizationStage::kNoCandidate: return "no_candidate";
    case RelocalizationStage::kMatches: return "matches";
    case RelocalizationStage::kPnp: return "pnp";
    case RelocalizationStage::kInliers: return "inliers";
    case RelocalizationStage::kVerified: return "verified";
  }
  return "?";
}

std::string_view name(Matcher matcher) {
  switch (matcher) {
    case Matcher::kMotionModel: return "motion_model";
    case Matcher::kReferenceKeyframe: return "reference_keyframe";
    case Matcher::kLocalMap: return "local_map";
    case Matcher::kTriangulation: return "triangulation";
    case Matcher::kFusion: return "fusion";
    case Matcher::kRelocalizationWords: return "relocalization_words";
    case Matcher::kRelocalizationProjection: return "relocalization_projection";
    case Matcher::kCount: break;
  }
  return "?";
}

MatcherCounts& MatcherCounts::operator+=(const MatcherCounts& other) {
  compared += other.compared;
  penalised += other.penalised;
  rejected_by_xi += other.rejected_by_xi;
  ratio_helped += other.ratio_helped;
  return *this;
}

}  // namespace mh
