// SPDX-License-Identifier: Apache-2.0
#include "bench/run/one/ask_queries.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "bench/protocol/query.hpp"
#include "bench/protocol/score.hpp"
#include "bench/protocol/streams.hpp"
#include "bench/protocol/usable_frame.hpp"

namespace mh {
namespace {

/// The recording that a set's queries are frames of; empty if they are simulated.
std::string recording_of(const Environment& environment, QuerySet set) {
  return set == QuerySet::kSecondTour ? environment.queries.value_or("") : environment.sequence;
}

/// The frames of a set of queries.
std::vector<std::size_t> asked_frames(QuerySet set, const Sequence& sequence,
                                      const ProtocolConfig& config) {
  if (set != QuerySet::kGraded) return test_frames(sequence.size(), config);
  std::vector<std::size_t> all(sequence.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// One set of queries.
class QueryRound {
 public:
  QueryRound(const RunSpec& spec, QuerySet set, const World& world, const FilesAsKeyed& files,
             RunResult& run)
      : spec_(spec),
        set_(set),
        world_(world),
        frames_(*sequence_of(world, set), recording_of(spec.environment, set), shows_labels(spec),
                files, run.frames_s),
        has_stamp_(increasing_stamps(frames_)),
        run_(run),
        stream_(query_stream(spec, set)) {}
  QuerySet set() const { return set_; }

  /// Makes each query under the points first .. end - 1; `scores[p]` receives the answers under
  /// point p.
  void put(System& frozen, std::size_t first, std::size_t end,
           const std::vector<std::vector<QueryScore>*>& scores,
           const std::function<void()>& done) const {
    for (const std::size_t index : asked_frames(set_, frames_, spec_.protocol)) {
      if (!has_stamp_[index]) {
        if (first == 0) run_.mapping.skipped.add(stamp_fault(frames_, index));
        continue;
      }
      const Trajectory* truth = run_.truth.empty() ? nullptr : frames_.truth();
      const QueryMoment moment = moment_of(frames_.stamp_ns(index), truth);
      // If the ground truth is known, skip frames without a true pose: no answer to them could be
      // judged.
      if (truth != nullptr && !moment.true_world_from_camera) continue;
      const auto in_map = is_in_any_map(moment);
      const bool once = end - first == 1;  // one point only: no work to share
      const FramesMadeOnce shared(frames_);
      const Sequence& frames = once ? static_cast<const Sequence&>(frames_) : shared;
      const std::unique_ptr<QueryMemo> memo = once ? nullptr : frozen.make_memo();
      std::map<std::uint32_t, std::optional<Anchor>> anchors;  // by map
      for (std::size_t p = first; p < end; ++p) {
        if (!once) frozen.use_point(p);
        try {
          const QueryAnswer answer =
              query(frozen, index, frames, spec_.protocol, stream_, memo.get());
          scores[p]->push_back(judged(answer, moment, anchors));
          scores[p]->back().in_map = in_map;
          if (set_ == QuerySet::kGraded)
            scores[p]->back().grade = world_.simulated->graded.list[index].grade;
        } catch (const UnusableFrame& error) {
          if (p == 0) run_.mapping.skipped.add(error.what());
        }
        done();
      }
    }
  }

 private:
  /// @param anchors  the query's anchors, by map, so that each is computed only once
  QueryScore judged(const QueryAnswer& answer, const QueryMoment& moment,
                    std::map<std::uint32_t, std::optional<Anchor>>& anchors) const {
    std::optional<Anchor> anchor;
    if (answer.world_from_camera) {
      const auto [known, is_new] = anchors.try_emplace(answer.map);
      if (is_new)
        known->second = find_anchor(mapped_beside(run_, answer), run_.truth, moment,
                                    nearest_by(set_), spec_.protocol);
      anchor = known->second;
    }
    return score(run_, answer, moment, anchor);
  }

  std::optional<bool> is_in_any_map(const QueryMoment& moment) const {
    const auto in_largest = is_in_map(run_.estimate, run_.truth, moment);
    return in_largest == false ? is_in_map(run_.elsewhere, run_.truth, moment) : in_largest;
  }

  const RunSpec& spec_;
  QuerySet set_;
  const World& world_;
  WatchedFrames frames_;
  std::vector<bool> has_stamp_;
  RunResult& run_;
  RandomStream stream_;
};

/// Returns the end of the group of points, starting at `first`, that describe keyframes identically
/// (equation 1), so that switching between them costs nothing.
std::size_t end_of_alike(const std::vector<SemanticConfig>& points, std::size_t first) {
  std::size_t end = first + 1;
  while (end < points.size() && points[end].gamma == points[first].gamma &&
         points[end].label_mass == points[first].label_mass &&
         points[end].void_is_a_label == points[first].void_is_a_label)
    ++end;
  return end;
}

std::vector<std::vector<QueryScore>*> lists(RunResult& run, QuerySet set) {
  std::vector<std::vector<QueryScore>*> all;
  for (PointResult& point : run.points) all.push_back(&of_query_set(point, set));
  return all;
}

}  // namespace

/// Whether the system is shown the labels that the frames have.
bool shows_labels(const RunSpec& spec) {
  return !spec.episodes || spec.labels != Labels();
}

std::size_t count_queries(const RunSpec& spec, const World& world) {
  std::size_t queries = 0;
  for (const QuerySet set : kQuerySets)
    if (const Sequence* sequence = sequence_of(world, set))
      queries += asked_frames(set, *sequence, spec.protocol).size();
  return queries;
}

void ask_queries(const RunSpec& spec, const World& world, System& frozen, const FilesAsKeyed& files,
                 RunResult& run, const std::function<void()>& done) {
  run.points.resize(spec.points.size());
  std::vector<QueryRound> rounds;
  for (const QuerySet set : kQuerySets)
    if (sequence_of(world, set) != nullptr) rounds.emplace_back(spec, set, world, files, run);
  for (std::size_t p = 0; p < spec.points.size(); p = end_of_alike(spec.points, p)) {
    const std::size_t end = end_of_alike(spec.points, p);
    frozen.use_point(p);
    for (const QueryRound& round : rounds) round.put(frozen, p, end, lists(run, round.set()), done);
  }
}

}  // namespace mh
