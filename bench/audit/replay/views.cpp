// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/replay/views.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "bench/audit/query_replay.hpp"
#include "bench/audit/true_map.hpp"
#include "bench/protocol/streams.hpp"
#include "bench/protocol/usable_frame.hpp"
#include "bench/report/packed.hpp"
#include "sim/sensors/lens.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// Flags of a keypoint or a pair, one byte.
enum Flag : std::uint32_t {
  kHasLandmark = 1,  ///< a keypoint: the map has a landmark for it
  kIsRight = 1,      ///< a pair: both ends show the same surface
  kIsWrong = 2,      ///< a pair: its ends show different surfaces; neither flag: one shows none
  kIsPenalized = 4   ///< a pair: its labels differ (equation 2)
};

class ViewsOf {
 public:
  ViewsOf(const RunResult& run, const World& world, SlamState& frozen)
      : run_(run),
        world_(world),
        frozen_(frozen),
        camera_(frozen.camera),
        truth_(true_map(frozen.map, world, camera_)),
        again_(run.spec, world, frozen),
        scale_(std::min(1.0, static_cast<double>(kViewWidth_px) / frozen.camera.width_px)) {
    for (const KeyframeId k : truth_.live) place_of_.emplace(k, place_of_.size());
  }

  Json json() {
    const auto side = [&](int px) { return std::lround(px * scale_); };
    return {{"width_px", side(frozen_.camera.width_px)},
            {"height_px", side(frozen_.camera.height_px)},
            {"keyframes", keyframes()},
            {"queries", queries_of_first_point()}};
  }

 private:
  Json keyframes() const {
    std::map<Stamp, const MappedFrame*>
        call_of;  // the last call that added a keyframe at this stamp; earlier ones were culled
    for (const MappedFrame& call : run_.mapping.calls)
      if (call.keyframe_added) call_of[call.stamp_ns] = &call;
    Json list = Json::array();
    for (const KeyframeId k : truth_.live) {
      const Keyframe& keyframe = frozen_.map.at(k);
      const MappedFrame& call = *call_of.at(keyframe.stamp_ns);
      const auto flag_of = [&](std::size_t i) -> std::uint32_t {
        return keyframe.landmarks[i].valid() ? kHasLandmark : 0U;
      };
      list.push_back({{"frame", call.index},
                      {"ms", (keyframe.stamp_ns - run_.truth.front().stamp_ns) / 1'000'000},
                      {"jpeg", small_jpeg(shown(call).color, kViewWidth_px)},
                      {"keypoints", keypoints(keyframe.features, flag_of)}});
    }
    return list;
  }

  /// The image that the run mapped, noise included.
  RgbdFrame shown(const MappedFrame& call) const {
    RgbdFrame frame = usable_frame(*world_.mapping, call.index,
                                   mapping_noise(mapping_stream(run_.spec), call.restart));
    if (digest(frame) != call.image_digest)
      throw MachineError(
          fmt::format("{}: mapping frame {}: the replay's image differs from the run's",
                      run_.spec.name, call.index));
    return frame;
  }

  Json queries_of_first_point() {
    Json list = Json::array();
    again_.begin(run_.spec.points.front());
    for (const QuerySet set : kQuerySets)
      for (const QueryScore& score : queries(run_.points.front(), set))
        list.push_back(query(set, score));
    return list;
  }

  Json query(QuerySet set, const QueryScore& score) {
    const auto [noise, draws] = again_.first(set, score.answer.index);
    const RgbdFrame frame = again_.frame(set, score.answer.index, noise);
    PreparedFrame prepared = again_.prepared(frame);
    const std::vector<KeyframeId> candidates = again_.candidates(prepared);
    MatchTrace matches;
    StepObservers observers;
    observers.matches = &matches;
    const AnswerAgain answer = again_.ask(prepared, draws, observers);
    again_.leave(set, score.answer);
    const TrueView view = look(*scene_at(*world_.simulated, set, score.stamp_ns), camera_,
                               *score.true_world_from_camera, prepared.features);
    Json tried = Json::array();
    for (const KeyframeId k : candidates)
      tried.push_back(
          {{"keyframe", place_of_.at(k)}, {"pairs", pairs(k, matches, prepared.features, view)}});
    return {{"set", name(set)},
            {"frame", score.answer.index},
            {"stage", name(answer.stage)},
            {"jpeg", small_jpeg(frame.color, kViewWidth_px)},
            {"keypoints", keypoints(prepared.features, [](std::size_t) { return 0U; })},
            {"candidates", std::move(tried)}};
  }

  /// The query's matches with a keyframe that were found by words. Each has two bytes per
  /// coordinate of the query's end and of the keyframe's end, and a byte of flags.
  std::string pairs(KeyframeId k, const MatchTrace& matches, const Features& features,
                    const TrueView& view) const {
    const Keyframe& keyframe = frozen_.map.at(k);
    std::vector<std::uint8_t> bytes;
    for (const MatchedPair& pair : matches) {
      if (pair.matcher != Matcher::kRelocalizationWords || pair.keyframe != k) continue;
      put_pixel(features.keypoints[pair.feature], bytes);
      put_pixel(keyframe.features.keypoints[pair.other_feature], bytes);
      const auto& here = view.points[pair.feature];
      const auto& there = truth_.views[k.value]->points[pair.other_feature];
      std::uint32_t flags = pair.penalized ? kIsPenalized : 0U;
      if (here && there) flags |= same_place(*here, *there) ? kIsRight : kIsWrong;
      put(bytes, flags, 1);
    }
    return base64(bytes);
  }

  /// Keypoints as bytes: two per coordinate, one for the class, one for flags.
  template <class FlagOf>
  std::string keypoints(const Features& features, const FlagOf& flag_of) const {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < features.size(); ++i) {
      put_pixel(features.keypoints[i], bytes);
      put(bytes, features.keypoints[i].label, 1);
      put(bytes, flag_of(i), 1);
    }
    return base64(bytes);
  }

  /// Where the image, which has the lens distortion, shows a keypoint, in tenths of a pixel.
  void put_pixel(const Keypoint& keypoint, std::vector<std::uint8_t>& bytes) const {
    const Camera& c = frozen_.camera;
    const Eigen::Vector3d ray = c.unproject(keypoint.u_px, keypoint.v_px, 1.0);
    const Eigen::Vector2d seen = distort_px(c, ray.head<2>());
    for (const double pixel : {seen.x(), seen.y()}) {
      const double tenths = std::round(10.0 * ((pixel + 0.5) * scale_ - 0.5));
      put(bytes, static_cast<std::uint32_t>(std::clamp(tenths, 0.0, 65535.0)), 2);
    }
  }

  const RunResult& run_;
  const World& world_;
  SlamState& frozen_;
  TrueCamera camera_;
  TrueMap truth_;
  QueryReplay again_;
  double scale_;  ///< of images
  std::map<KeyframeId, std::size_t> place_of_;
};

}  // namespace

Json views_json(const RunResult& run, const World& world, SlamState& frozen) {
  return ViewsOf(run, world, frozen).json();
}

}  // namespace mh
