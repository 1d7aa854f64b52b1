// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/features/undistort.hpp"
#include "slam/loop/loop.hpp"
#include "slam/map/local_mapping.hpp"
#include "slam/pipeline/slam.hpp"
#include "slam/track/rolling_shutter.hpp"
#include "slam/track/track.hpp"

namespace mh {
namespace {

constexpr int kMinInitialPoints = 100;  // with depth, for a frame to become the origin
constexpr double kSecond_ns = 1e9;

/// A frame's features, indexed. Words are looked up only where a stage asks for them.
struct PreparedFrame {
  Stamp stamp_ns;
  Features features;
  FeatureGrid grid;
  std::optional<WordIndex> words;
};

/// Tells the observer that a stage lasts as long as this.
class InStage {
 public:
  InStage(const StepObservers& observers, Stage stage) : observers_(observers), stage_(stage) {
    if (observers_.stage) observers_.stage(stage_, StageEvent::kBegin);
  }
  ~InStage() {
    if (observers_.stage) observers_.stage(stage_, StageEvent::kEnd);
  }
  InStage(const InStage&) = delete;
  InStage& operator=(const InStage&) = delete;

 private:
  const StepObservers& observers_;
  Stage stage_;
};

Features observed_features(const RgbdFrame& frame, const SlamState& state,
                           const StepObservers& observers) {
  const InStage stage(observers, Stage::kFeatures);
  return extract(frame, state.camera, state.config.features);
}

/// @param tracker  that of the frames before, which tells how a rolling shutter moved
PreparedFrame prepare(Stamp stamp_ns, Features features, const SlamState& state,
                      const Tracker& tracker) {
  const Camera& camera = state.camera;
  if (tracker.tracking() && tracker.velocity_per_s)
    straighten(features.keypoints, camera, *tracker.velocity_per_s, state.config.track.readout_s);
  FeatureGrid grid(features.keypoints, camera);
  return {stamp_ns, std::move(features), std::move(grid), std::nullopt};
}

WordIndex index_words(const Features& features, const Vocabulary& vocabulary,
                      const SemanticConfig& semantics) {
  WordIndex index;
  std::vector<Label> labels;
  std::vector<WordId> words;
  for (std::uint32_t i = 0; i < features.size(); ++i) {
    const Vocabulary::Quantized quantized = vocabulary.quantize(features.descriptors[i]);
    words.push_back(quantized.word);
    labels.push_back(features.keypoints[i].label);
    index.by_node.emplace_back(quantized.node, i);
  }
  std::sort(index.by_node.begin(), index.by_node.end());
  index.vector = augmented_vector(
      std::span<const Label>(labels), std::span<const WordId>(words), semantics.gamma,
      [&](WordId word) { return static_cast<double>(vocabulary.idf(word)); },
      semantics.void_is_a_label ? VoidPolicy::kIsALabel : VoidPolicy::kUnknown);
  return index;
}

Query with_words(PreparedFrame& frame, const SlamState& state, const StepObservers& observers) {
  if (!frame.words) {
    const InStage stage(observers, Stage::kWords);
    frame.words = index_words(frame.features, *state.vocabulary, state.config.semantics);
  }
  return {frame.features, frame.grid, *frame.words};
}

Query without_words(const PreparedFrame& frame) {
  static const WordIndex kNone;
  return {frame.features, frame.grid, frame.words ? *frame.words : kNone};
}

double seconds_since_last(const Tracker& tracker, Stamp stamp_ns) {
  return static_cast<double>(stamp_ns - tracker.last->stamp_ns) / kSecond_ns;
}

SE3 predict(const Tracker& tracker, Stamp stamp_ns) {
  if (!tracker.velocity_per_s) return tracker.last->camera_from_world;
  const double elapsed_s = seconds_since_last(tracker, stamp_ns);
  return SE3::exp(*tracker.velocity_per_s * elapsed_s) * tracker.last->camera_from_world;
}

int points_with_depth(const Features& features) {
  return static_cast<int>(std::count_if(features.keypoints.begin(), features.keypoints.end(),
                                        [](const Keypoint& k) { return k.depth_m > 0; }));
}

struct Located {
  TrackedPose tracked;
  KeyframeId reference;
  std::vector<LandmarkId> expected;
  std::optional<Motion> motion = {};  ///< with this frame taken in
};

bool is_sure(const Matrix6d& covariance, const TrackConfig& config) {
  const PoseSigma sigma = worst_sigma(covariance);
  return sigma.position_m <= config.sure_position_m && sigma.angle_rad <= config.sure_angle_rad;
}

std::optional<TrackedPose> search_everywhere(const SlamState& state, PreparedFrame& frame,
                                             RandomStream stream, const StepObservers& observers,
                                             StepReport& report) {
  const SlamConfig& config = state.config;
  const InStage stage(observers, Stage::kRelocalization);
  RelocalizationResult found = relocalize(
      with_words(frame, state, observers), state.map, state.camera, config.features,
      config.semantics, config.match, config.relocalize, stream, report.matches, observers.matches);
  report.relocalization = found.stage;
  report.candidates = found.candidates;
  if (!found.camera_from_world) return std::nullopt;
  return TrackedPose{*found.camera_from_world, std::move(found.landmarks), found.inliers};
}

std::optional<Located> confirm_in_local_map(const SlamState& state, const PreparedFrame& frame,
                                            const TrackedPose& tracked, int min_inliers,
                                            const TrackContext& context,
                                            const StepObservers& observers, StepReport& report) {
  const InStage stage(observers, Stage::kLocalMap);
  const LocalMap local = local_map(tracked, context);
  auto refined = track_local_map(without_words(frame), tracked, local,
                                 static_cast<float>(context.config.local_radius_px), context,
                                 at(report.matches, Matcher::kLocalMap));
  if (!refined || refined->tracked.inliers < min_inliers) return std::nullopt;
  const KeyframeId reference = reference_of(refined->tracked, state.map);
  return Located{std::move(refined->tracked), reference, std::move(refined->expected)};
}

/// Landmarks that a frame must hold to be tracked: fewer where it shows little.
int inliers_needed(const Features& features, const TrackConfig& config) {
  const int share = static_cast<int>(features.size()) / 6;
  return std::min(config.min_inliers, std::max(config.min_inliers_sparse, share));
}

/// Where a frame is, told by the last one that was tracked: by the motion model or the reference
/// keyframe, whichever holds in the local map first. One that comes after lost frames needs as much
/// as relocalization asks for.
std::optional<Located> follow(const SlamState& state, const Tracker& tracker, PreparedFrame& frame,
                              const TrackContext& context, const StepObservers& observers,
                              StepReport& report) {
  if (!tracker.last) return std::nullopt;
  const auto by_motion = [&] {
    return track_motion(without_words(frame), *tracker.last, predict(tracker, frame.stamp_ns),
                        context, at(report.matches, Matcher::kMotionModel));
  };
  const auto by_reference = [&] {
    return track_reference(with_words(frame, state, observers),
                           state.map.standing(tracker.reference), tracker.last->camera_from_world,
                           context, at(report.matches, Matcher::kReferenceKeyframe));
  };
  const int min_inliers = tracker.coasting ? state.config.relocalize.min_inliers
                                           : inliers_needed(frame.features, state.config.track);
  // Where the motion is not known yet, appearance needs no guess.
  const bool moving = tracker.velocity_per_s.has_value();
  for (const bool use_motion : {moving, !moving}) {
    std::optional<TrackedPose> tracked;
    {
      const InStage stage(observers, Stage::kTracking);
      tracked = use_motion ? by_motion() : by_reference();
    }
    if (!tracked) continue;
    if (auto located =
            confirm_in_local_map(state, frame, *tracked, min_inliers, context, observers, report))
      return located;
  }
  return std::nullopt;
}

/// Takes a frame that followed the last one into the motion. Where the picture alone leaves its
/// pose unsure (few points in a narrow strip: turning and shifting look alike), it is put between
/// where it was seen and where the motion leads, each by its covariance.
void weigh(Located& located, const Tracker& tracker, Stamp stamp_ns, const TrackConfig& config) {
  const Matrix6d covariance = located.tracked.information.inverse();
  const double elapsed_s = seconds_since_last(tracker, stamp_ns);
  if (!tracker.motion || elapsed_s <= 0) {
    located.motion = Motion::at_rest(covariance);
    return;
  }
  SE3& pose = located.tracked.camera_from_world;
  const SE3 predicted = tracker.motion->predict(tracker.last->camera_from_world, elapsed_s);
  Motion motion = tracker.motion->after(elapsed_s);
  const Vector6d off = motion.correct((pose * predicted.inverse()).log(), covariance);
  located.tracked.unsure = !is_sure(covariance, config);
  if (located.tracked.unsure) pose = SE3::exp(off) * predicted;
  located.motion = motion;
}

/// Finds the camera of a frame in the map: from the frames before; where that does not hold,
/// anywhere. Reads the map, never writes it.
std::optional<Located> locate(const SlamState& state, const Tracker& tracker, PreparedFrame& frame,
                              RandomStream stream, const StepObservers& observers,
                              StepReport& report) {
  const SlamConfig& config = state.config;
  const TrackContext context{state.map,    state.camera, config.features, config.semantics,
                             config.match, config.pose,  config.track,    observers.matches};
  if (auto located = follow(state, tracker, frame, context, observers, report)) {
    weigh(*located, tracker, frame.stamp_ns, config.track);
    report.status = tracker.coasting ? TrackStatus::kRelocalized : TrackStatus::kTracked;
    return located;
  }
  const auto found = search_everywhere(state, frame, stream, observers, report);
  if (!found) return std::nullopt;
  auto located = confirm_in_local_map(state, frame, *found, config.relocalize.min_inliers, context,
                                      observers, report);
  if (located) {
    located->motion = Motion::at_rest(located->tracked.information.inverse());
    report.status = TrackStatus::kRelocalized;
  } else {
    report.relocalization = RelocalizationStage::kInliers;
  }
  return located;
}

/// A frame placed by its motion alone, where the last one's points have left the picture: a corner
/// so bare that a turn lets go of all it showed. The motion must be as sure as a picture must be,
/// and what the frame shows itself enough to hold the next one.
std::optional<Located> carry(const SlamState& state, const PreparedFrame& frame) {
  const Tracker& tracker = state.tracker;
  const TrackConfig& config = state.config.track;
  if (!tracker.tracking() || !tracker.motion) return std::nullopt;
  if (points_with_depth(frame.features) < config.min_inliers) return std::nullopt;
  const double elapsed_s = seconds_since_last(tracker, frame.stamp_ns);
  const Motion motion = tracker.motion->after(elapsed_s);
  const SE3 guess = tracker.motion->predict(tracker.last->camera_from_world, elapsed_s);
  if (!is_sure(motion.pose_covariance, config)) return std::nullopt;
  if (count_that_can_be_found(*tracker.last, guess, state.map, state.camera) >= config.min_inliers)
    return std::nullopt;
  return Located{{guess, std::vector<LandmarkId>(frame.features.size())},
                 state.map.standing(tracker.reference),
                 {},
                 motion};
}

/// The frame is lost. For a while the last tracked one still tells where to look for the next.
void lose(Tracker& tracker, Stamp stamp_ns, const TrackConfig& config) {
  const double lost_s = tracker.last ? seconds_since_last(tracker, stamp_ns) : HUGE_VAL;
  if (lost_s >= 0 && lost_s < config.coast_s)
    tracker.coasting = true;
  else
    tracker = Tracker{};
}

/// How the camera moved since the last frame. Taken before mapping, which may move the world.
void update_velocity(Tracker& tracker, Stamp stamp_ns, const SE3& camera_from_world) {
  tracker.velocity_per_s.reset();
  if (!tracker.last || stamp_ns <= tracker.last->stamp_ns) return;
  const double elapsed_s = seconds_since_last(tracker, stamp_ns);
  tracker.velocity_per_s =
      (camera_from_world * tracker.last->camera_from_world.inverse()).log() / elapsed_s;
}

/// What the next frame is matched against.
void remember(Tracker& tracker, PreparedFrame&& frame, const SE3& camera_from_world,
              std::vector<LandmarkId> landmarks, KeyframeId reference,
              const std::optional<Motion>& motion) {
  tracker.last =
      LastFrame{frame.stamp_ns, camera_from_world, std::move(frame.features), std::move(landmarks)};
  tracker.motion = motion;
  tracker.reference = reference;
  tracker.coasting = false;
}

KeyframeId insert_keyframe(SlamState& state, PreparedFrame& frame, const SE3& camera_from_world,
                           const std::vector<LandmarkId>& landmarks, RandomStream stream,
                           const StepObservers& observers, StepReport& report) {
  const SlamConfig& config = state.config;
  const MappingContext context{state.camera,  config.features, config.semantics, config.match,
                               config.bundle, config.keyframe, observers.matches};
  Keyframe keyframe;
  keyframe.stamp_ns = frame.stamp_ns;
  keyframe.camera_from_world = camera_from_world;
  keyframe.words = with_words(frame, state, observers).words;
  keyframe.features = frame.features;
  keyframe.grid = frame.grid;
  KeyframeId id;
  {
    const InStage stage(observers, Stage::kMapping);
    id = state.map.add(std::move(keyframe));
    for (std::uint32_t i = 0; i < landmarks.size(); ++i)
      if (landmarks[i].valid()) {
        state.map.add_observation(landmarks[i], id, i);
        state.map.refresh(landmarks[i], config.features);
      }
    add_landmarks_from_depth(state.map, id, context);
    if (state.map.keyframe_count() > 1) map_keyframe(state.map, id, context, report.matches);
  }
  if (config.loop.enabled) {
    const InStage stage(observers, Stage::kLoop);
    if (const auto loop = detect_loop(state.map, id, state.loop_memory, context, config.relocalize,
                                      config.loop, stream, report.matches)) {
      const Keyframe& old = state.map.at(loop->old_keyframe);
      report.loop = LoopClosure{frame.stamp_ns, old.stamp_ns,
                                old.camera_from_world * loop->camera_from_world.inverse()};
      close_loop(state.map, *loop, context, config.loop, report.matches);
      report.loop_closed = true;
    }
  }
  report.keyframe_added = true;
  state.tracker.frames_since_keyframe = 0;
  return id;
}

StepReport initialize(SlamState& state, PreparedFrame frame, const StepObservers& observers,
                      StepReport report) {
  const int with_depth = points_with_depth(frame.features);
  if (with_depth < kMinInitialPoints) return report;
  const std::vector<LandmarkId> none(frame.features.size());
  const KeyframeId id =
      insert_keyframe(state, frame, SE3(), none, RandomStream(), observers, report);
  state.tracked_frames[frame.stamp_ns] = {id, SE3()};
  report.status = TrackStatus::kInitialized;
  report.world_from_camera = SE3();
  report.inliers = with_depth;
  remember(state.tracker, std::move(frame), SE3(), state.map.at(id).landmarks, id, std::nullopt);
  return report;
}

}  // namespace

void need_later(Stamp stamp_ns, std::optional<Stamp> last_ns) {
  if (last_ns && stamp_ns <= *last_ns)
    throw InputError(fmt::format("frame at {:.6f} s: stamps must grow, the last was {:.6f} s",
                                 static_cast<double>(stamp_ns) * 1e-9,
                                 static_cast<double>(*last_ns) * 1e-9));
}

SlamState make_slam(const Camera& camera, const SlamConfig& config,
                    std::shared_ptr<const Vocabulary> vocabulary) {
  validate(camera);
  require_undistortable(camera);
  validate(config);
  SlamState state;
  state.camera = camera;
  state.config = config;
  state.vocabulary = std::move(vocabulary);
  return state;
}

StepReport step(SlamState& state, const RgbdFrame& frame, RandomStream stream,
                const StepObservers& observers) {
  need_later(frame.stamp_ns, state.last_stamp_ns);
  return step(state, frame.stamp_ns, observed_features(frame, state, observers), stream, observers);
}

StepReport step(SlamState& state, Stamp stamp_ns, Features features, RandomStream stream,
                const StepObservers& observers) {
  need_later(stamp_ns, state.last_stamp_ns);
  if (features.descriptors.size() != features.keypoints.size())
    throw InputError(fmt::format("frame at {} ns: {} keypoints, but {} descriptors", stamp_ns,
                                 features.keypoints.size(), features.descriptors.size()));
  state.last_stamp_ns = stamp_ns;
  PreparedFrame prepared = prepare(stamp_ns, std::move(features), state, state.tracker);
  StepReport report;
  report.keypoints = static_cast<int>(prepared.features.size());
  state.tracked_frames.erase(stamp_ns);
  if (state.map.empty()) return initialize(state, std::move(prepared), observers, report);

  auto located = locate(state, state.tracker, prepared, stream, observers, report);
  if (!located) {
    located = carry(state, prepared);
    if (located) report.status = TrackStatus::kTracked;
  }
  if (!located) {
    lose(state.tracker, stamp_ns, state.config.track);
    return report;
  }
  for (const LandmarkId id : located->expected) state.map.count_visible(id);
  for (const LandmarkId id : located->tracked.landmarks)
    if (id.valid()) state.map.count_found(id);

  update_velocity(state.tracker, stamp_ns, located->tracked.camera_from_world);
  ++state.tracker.frames_since_keyframe;
  const bool wants_keyframe =
      needs_keyframe(located->tracked, prepared.features, state.map, located->reference,
                     state.tracker.frames_since_keyframe, state.config.keyframe);
  KeyframeId reference = located->reference;
  SE3 camera_from_world = located->tracked.camera_from_world;
  std::vector<LandmarkId> landmarks = std::move(located->tracked.landmarks);
  report.inliers = located->tracked.inliers;
  if (wants_keyframe) {
    reference = insert_keyframe(state, prepared, camera_from_world, landmarks, stream.fork(1),
                                observers, report);
    camera_from_world = state.map.at(reference).camera_from_world;
    landmarks = state.map.at(reference).landmarks;
#ifndef NDEBUG
    state.map.check_invariants();
#endif
  }

  report.world_from_camera = camera_from_world.inverse();
  state.tracked_frames[stamp_ns] = {
      reference, camera_from_world * state.map.camera_from_world(reference).inverse()};
  remember(state.tracker, std::move(prepared), camera_from_world, std::move(landmarks), reference,
           located->motion);
  return report;
}

void rewind(SlamState& state) {
  state.tracker = Tracker{};
  state.last_stamp_ns.reset();
}

StepReport localize(const SlamState& frozen, Tracker& tracker, const RgbdFrame& frame,
                    RandomStream stream, const StepObservers& observers) {
  PreparedFrame prepared =
      prepare(frame.stamp_ns, observed_features(frame, frozen, observers), frozen, tracker);
  StepReport report;
  report.keypoints = static_cast<int>(prepared.features.size());
  auto located = locate(frozen, tracker, prepared, stream, observers, report);
  if (!located) {
    lose(tracker, frame.stamp_ns, frozen.config.track);
    return report;
  }
  report.inliers = located->tracked.inliers;
  update_velocity(tracker, frame.stamp_ns, located->tracked.camera_from_world);
  report.world_from_camera = located->tracked.camera_from_world.inverse();
  remember(tracker, std::move(prepared), located->tracked.camera_from_world,
           std::move(located->tracked.landmarks), located->reference, located->motion);
  return report;
}

struct LocalizeMemo::Content {
  /// What came of the winner: its pose in the local map, and the counts of getting it.
  struct Refined {
    std::optional<SE3> camera_from_world;
    int inliers = 0;
    MatchCounts counts{};
  };
  std::optional<PreparedFrame> frame;
  double gamma = 0;  ///< of the frame's words
  AttemptMemo attempts;
  std::map<KeyframeId, Refined> refined;
};
LocalizeMemo::LocalizeMemo() : content_(std::make_unique<Content>()) {}
LocalizeMemo::~LocalizeMemo() = default;
LocalizeMemo::LocalizeMemo(LocalizeMemo&&) noexcept = default;

StepReport localize(const SlamState& frozen, const RgbdFrame& frame, RandomStream stream,
                    LocalizeMemo& memo) {
  LocalizeMemo::Content& known = *memo.content_;
  const SlamConfig& config = frozen.config;
  if (!known.frame)
    known.frame =
        prepare(frame.stamp_ns, extract(frame, frozen.camera, config.features), frozen, Tracker{});
  if (known.gamma != config.semantics.gamma) known.frame->words.reset();
  known.gamma = config.semantics.gamma;

  const StepObservers observers;
  StepReport report;
  report.keypoints = static_cast<int>(known.frame->features.size());
  const RelocalizationResult found =
      relocalize(with_words(*known.frame, frozen, observers), frozen.map, frozen.camera,
                 config.features, config.semantics, config.match, config.relocalize, stream,
                 report.matches, nullptr, &known.attempts);
  report.relocalization = found.stage;
  report.candidates = found.candidates;
  if (!found.camera_from_world) return report;

  const auto [place, is_new] = known.refined.try_emplace(found.keyframe);
  LocalizeMemo::Content::Refined& refined = place->second;
  if (is_new) {
    const TrackContext context{frozen.map,   frozen.camera, config.features, config.semantics,
                               config.match, config.pose,   config.track,    nullptr};
    StepReport of_refining;
    if (const auto located = confirm_in_local_map(
            frozen, *known.frame, {*found.camera_from_world, found.landmarks, found.inliers},
            config.relocalize.min_inliers, context, observers, of_refining)) {
      refined.camera_from_world = located->tracked.camera_from_world;
      refined.inliers = located->tracked.inliers;
    }
    refined.counts = of_refining.matches;
  }
  for (std::size_t m = 0; m < report.matches.size(); ++m) report.matches[m] += refined.counts[m];
  if (!refined.camera_from_world) {
    report.relocalization = RelocalizationStage::kInliers;
    return report;
  }
  report.status = TrackStatus::kRelocalized;
  report.inliers = refined.inliers;
  report.world_from_camera = refined.camera_from_world->inverse();
  return report;
}

void set_query_settings(SlamState& state, const SemanticConfig& settings) {
  SemanticConfig& own = state.config.semantics;
  const bool same_vectors =
      settings.gamma == own.gamma && settings.void_is_a_label == own.void_is_a_label;
  SlamConfig config = state.config;
  config.semantics = settings;
  validate(config);
  own = settings;
  if (same_vectors) return;
  for (const Keyframe& keyframe : state.map.keyframes())
    if (!keyframe.erased)
      state.map.set_words(keyframe.id, index_words(keyframe.features, *state.vocabulary, settings));
}

Trajectory trajectory(const SlamState& state) {
  Trajectory poses;
  for (const auto& [stamp_ns, frame] : state.tracked_frames)
    poses.push_back(
        {stamp_ns,
         (frame.camera_from_reference * state.map.camera_from_world(frame.reference)).inverse()});
  return poses;
}

}  // namespace mh
