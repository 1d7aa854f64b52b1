// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/audit.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "bench/audit/query_replay.hpp"
#include "bench/audit/retrieval.hpp"
#include "bench/audit/trials.hpp"
#include "bench/protocol/query.hpp"
#include "bench/systems/builtin.hpp"
#include "bench/systems/timed.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"
#include "slam/pipeline/locate.hpp"
#include "slam/relocalize/relocalize.hpp"

namespace mh {
namespace {

/// One test frame, with everything about it that does not depend on the parameter point.
struct Asked {
  QuerySet set;
  std::size_t place;  ///< index in its set's answers
  Presentation first;
  PreparedFrame frame;  ///< of the first attempt
  TrueView view;
  QueryMoment moment;
  std::optional<Anchor> anchor;
  std::vector<double> co_visible = {};  ///< by keyframe id
  std::vector<double> distance = {};    ///< by keyframe id, m + rad
  std::vector<KeyframeId> nearest = {}, best_in_view = {};
  std::map<TrialKey, TrialMemo> tried = {};
};

/// What Algorithm 1 does with one query.
struct Retrieved {
  std::vector<KeyframeId> candidates;
  std::vector<KeyframeId> by_similarity;  ///< all keyframes that share anything with the query
};

class RunAuditor {
 public:
  RunAuditor(const RunResult& run, const World& world, SlamState& frozen)
      : run_(run),
        spec_(run.spec),
        world_(world),
        frozen_(frozen),
        camera_(frozen.camera),
        truth_(true_map(frozen.map, world, camera_)),
        again_(run.spec, world, frozen) {}

  RunAudit audit(const std::function<void(double)>& progress) {
    RunAudit made;
    for (const QuerySet set : kQuerySets) prepare_set(set);
    made.points.resize(spec_.points.size());
    const double pieces = static_cast<double>(asked_.size() * spec_.points.size());
    double done = 0;
    for (std::size_t p = 0; p < spec_.points.size(); ++p) {
      again_.begin(spec_.points[p]);
      for (Asked& asked : asked_) {
        asked.frame.words.reset();
        queries(made.points[p], asked.set).push_back(audit_query(asked, p));
        progress(++done / pieces);
      }
    }
    return made;
  }

 private:
  void prepare_set(QuerySet set) {
    // Every point has the same frames: those of the first point are used.
    const std::vector<QueryScore>& scores = queries(run_.points.front(), set);
    for (std::size_t i = 0; i < scores.size(); ++i) asked_.push_back(prepare_query(set, i));
  }

  Asked prepare_query(QuerySet set, std::size_t place) {
    const QueryScore& score = queries(run_.points.front(), set)[place];
    const Presentation first = again_.first(set, score.answer.index);
    PreparedFrame frame = again_.prepared(again_.frame(set, score.answer.index, first.noise));
    const SE3& pose = *score.true_world_from_camera;
    TrueView view =
        look(*scene_at(*world_.simulated, set, score.stamp_ns), camera_, pose, frame.features);
    const QueryMoment moment(score.stamp_ns, score.true_world_from_camera);
    Asked asked{.set = set,
                .place = place,
                .first = first,
                .frame = std::move(frame),
                .view = std::move(view),
                .moment = moment,
                .anchor = find_anchor(mapped_beside(run_, score.answer), run_.truth, moment,
                                      nearest_by(set), spec_.protocol)};
    compare_with_map(asked);
    return asked;
  }

  void compare_with_map(Asked& asked) const {
    asked.co_visible.resize(truth_.views.size());
    asked.distance.resize(truth_.views.size());
    for (const KeyframeId k : truth_.live) {
      const TrueView& there = *truth_.views[k.value];
      asked.co_visible[k.value] = co_visible_share(asked.view, there);
      asked.distance[k.value] =
          pose_distance(asked.view.world_from_camera, there.world_from_camera);
      if (asked.co_visible[k.value] > 0) asked.best_in_view.push_back(k);
    }
    asked.nearest = truth_.live;
    std::ranges::stable_sort(asked.nearest, {},
                             [&](KeyframeId k) { return asked.distance[k.value]; });
    std::ranges::stable_sort(asked.best_in_view, std::greater(),
                             [&](KeyframeId k) { return asked.co_visible[k.value]; });
  }

  QueryAudit audit_query(Asked& asked, std::size_t p) {
    const QueryScore& score = queries(run_.points[p], asked.set)[asked.place];
    QueryAudit audit{
        .frame = score.answer.index, .correct = score.correct, .attempts = score.answer.attempts};
    const Retrieved retrieved = retrieve(asked, audit);
    answer_first(asked, score, audit);
    again_.leave(asked.set, score.answer);
    audit.keyframes = static_cast<int>(truth_.live.size());
    if (!asked.best_in_view.empty())
      audit.best_co_visible = asked.co_visible[asked.best_in_view.front().value];
    if (!asked.nearest.empty())
      std::tie(audit.nearest_m, audit.nearest_deg) =
          apart(asked, truth_.views[asked.nearest.front().value]->world_from_camera);

    const SemanticConfig& settings = frozen_.config.semantics;
    TrialMemo& tried = asked.tried[trial_key(settings)];
    if (!tried.with_every_keyframe) tried.with_every_keyframe = match_every_keyframe(asked);
    audit.matches[static_cast<std::size_t>(MatchStage::kEveryKeyframe)] =
        *tried.with_every_keyframe;
    Trials trials(subject(asked), tried);
    find_ceilings(trials, {asked.nearest, asked.best_in_view}, audit);
    score_retrieval(asked, retrieved, trials, audit);
    return audit;
  }

  Retrieved retrieve(Asked& asked, QueryAudit& audit) {
    Retrieved retrieved{.candidates = again_.candidates(asked.frame), .by_similarity = {}};
    const Query query = with_words(asked.frame, frozen_, StepObservers());
    std::vector<InvertedIndex::Score> scores = frozen_.map.sharing(query.words.vector);
    std::ranges::stable_sort(scores, std::greater(), &InvertedIndex::Score::similarity);
    for (const auto& s : scores) retrieved.by_similarity.push_back(s.keyframe);
    audit.label_mass = query.words.vector.label_mass();
    return retrieved;
  }

  /// Queries the system as the run did, with its decisions traced.
  void answer_first(Asked& asked, const QueryScore& score, QueryAudit& audit) {
    DecisionTrace decisions;
    StepObservers observers;
    observers.decisions = &decisions;
    const auto [pose, stage] = again_.ask(asked.frame, asked.first.draws, observers);
    audit.stage = stage;
    audit.first_answered = pose.has_value();
    audit.first_correct = pose && is_correct(asked, *pose);
    std::optional<SE3> in_run;
    if (score.answer.attempts == 1) in_run = score.answer.world_from_camera;
    if (digest(pose) != digest(in_run))
      throw MachineError(fmt::format("{}: {} {}: the audit's answer differs from the run's",
                                     spec_.name, name(asked.set), score.answer.index));
    audit.matches = audit_of(asked, decisions);
  }

  MatchAudit audit_of(const Asked& asked, const DecisionTrace& decisions) const {
    const VoidPolicy policy =
        frozen_.config.semantics.void_is_a_label ? VoidPolicy::kIsALabel : VoidPolicy::kUnknown;
    return audit_matches(
        decisions, [&](const MatchDecision& d) { return ends_of(asked, d); }, policy);
  }

  StageMatches match_every_keyframe(Asked& asked) const {
    DecisionTrace decisions;
    StepObservers observers;
    observers.decisions = &decisions;
    StepReport not_reported;
    const SlamContext context = context_of(frozen_, observers, not_reported);
    const Query query = with_words(asked.frame, frozen_, StepObservers());
    for (const KeyframeId k : truth_.live)
      match_landmarks(frozen_.map.at(k), query, context, Matcher::kRelocalizationWords);
    return audit_of(asked, decisions)[static_cast<std::size_t>(MatchStage::kWords)];
  }

  std::pair<MatchEnd, MatchEnd> ends_of(const Asked& asked, const MatchDecision& d) const {
    const MatchEnd seen{asked.view.points[d.feature],
                        asked.frame.features.keypoints[d.feature].label};
    if (!d.keyframe.valid())
      return {seen, {truth_.landmarks[d.landmark.value], frozen_.map.at(d.landmark).label}};
    return {seen,
            {truth_.views[d.keyframe.value]->points[d.other_feature],
             frozen_.map.at(d.keyframe).features.keypoints[d.other_feature].label}};
  }

  bool is_correct(const Asked& asked, const SE3& world_from_camera) const {
    QueryAnswer answer;
    answer.world_from_camera = world_from_camera;
    return score(run_, answer, asked.moment, asked.anchor).correct;
  }

  Trials::Subject subject(const Asked& asked) const {
    std::optional<SE3> camera_from_map;
    if (asked.anchor)
      camera_from_map = local_truth(*asked.anchor, asked.view.world_from_camera).inverse();
    return {.frozen = frozen_,
            .frame = asked.frame,
            .draws = asked.first.draws,
            .truth = truth_,
            .view = asked.view,
            .is_correct = [this, &asked](const SE3& pose) { return is_correct(asked, pose); },
            .camera_from_map = camera_from_map};
  }

  void score_retrieval(const Asked& asked, const Retrieved& retrieved, Trials& trials,
                       QueryAudit& audit) const {
    const auto is_relevant = [&](KeyframeId k) { return asked.co_visible[k.value] >= kRelevant; };
    const auto relevant = static_cast<std::size_t>(std::ranges::count_if(truth_.live, is_relevant));
    audit.relevant = static_cast<int>(relevant);
    audit.candidates = static_cast<int>(retrieved.candidates.size());
    audit.relevant_candidates =
        static_cast<int>(std::ranges::count_if(retrieved.candidates, is_relevant));
    Relevance ranked;
    for (const KeyframeId k : retrieved.by_similarity) ranked.push_back(is_relevant(k) ? 1 : 0);
    audit.average_precision = average_precision(ranked, relevant);
    if (relevant > 0) {
      audit.precision_1 = precision_at(1, ranked);
      audit.precision_5 = precision_at(5, ranked);
      audit.precision_10 = precision_at(10, ranked);
    }
    audit.recall_1 = recall_at(1, ranked, relevant);
    audit.recall_5 = recall_at(5, ranked, relevant);
    audit.recall_10 = recall_at(10, ranked, relevant);
    if (!audit.by_any) return;
    const auto solves = [&](KeyframeId k) { return trials.solves(k); };
    const auto rank_of_first = [&](const std::vector<KeyframeId>& list) -> std::optional<int> {
      const auto first = std::ranges::find_if(list, solves);
      if (first == list.end()) return std::nullopt;
      return static_cast<int>(first - list.begin()) + 1;
    };
    audit.solving_candidate = rank_of_first(retrieved.candidates);
    audit.solving_rank = rank_of_first(retrieved.by_similarity);
    if (!audit.solving_rank) return;
    const KeyframeId solver =
        retrieved.by_similarity[static_cast<std::size_t>(*audit.solving_rank) - 1];
    audit.solving_co_visible = asked.co_visible[solver.value];
    std::tie(audit.solving_m, audit.solving_deg) =
        apart(asked, truth_.views[solver.value]->world_from_camera);
  }

  static std::pair<double, double> apart(const Asked& asked, const SE3& other) {
    const SE3& own = asked.view.world_from_camera;
    return {(own.translation() - other.translation()).norm(),
            angle_between_rad(own, other) * 180.0 / std::numbers::pi};
  }

  const RunResult& run_;
  const RunSpec& spec_;
  const World& world_;
  SlamState& frozen_;
  TrueCamera camera_;
  TrueMap truth_;
  QueryReplay again_;
  std::vector<Asked> asked_;
};

}  // namespace

void require_auditable(const RunSpec& spec) {
  if (!spec.system.takes_settings())
    throw InputError(
        fmt::format("{}: '{}' gives no match traces: an audit takes only `semantic`, `plain` and "
                    "their variants",
                    spec.name, spec.system.name));
  if (spec.episodes)
    throw InputError(
        fmt::format("{}: an audit examines queries, but the suite has `episodes`", spec.name));
  if (spec.environment.is_recorded())
    throw InputError(
        fmt::format("{}: '{}' is a recording, whose exact surfaces are unknown: an audit takes "
                    "only simulated scenes",
                    spec.name, spec.environment.name));
}

RunResult run_with_map(const RunSpec& spec, const World& world, RunTools tools, SlamState& frozen) {
  tools.system = [&](const RunSpec& of, const World& in) {
    frozen = make_slam(in.mapping->camera(), of.slam, in.vocabulary);
    return make_builtin_system(frozen, {.points = of.points});
  };
  return run_one(spec, world, tools);
}

RunAudit audit_run(const RunResult& run, const World& world, SlamState& frozen,
                   const std::function<void(double)>& progress) {
  require_auditable(run.spec);
  double audit_s = 0;
  RunAudit audit;
  {
    const ProcessorTimer timer(audit_s);
    audit = RunAuditor(run, world, frozen).audit(progress);
  }
  audit.audit_s = audit_s;
  audit.map_from_cache = run.times.track_ms.empty();
  return audit;
}

}  // namespace mh
