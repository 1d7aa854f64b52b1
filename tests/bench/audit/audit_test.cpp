// SPDX-License-Identifier: Apache-2.0
// Whole runs in a room whose exact images are known in closed form.
#include "bench/audit/audit.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <tuple>

#include <gtest/gtest.h>

#include "bench/audit/summary.hpp"
#include "bench/audit/write.hpp"
#include "bench/suite/json_fields.hpp"
#include "slam/files/map_file.hpp"
#include "slam/io/error.hpp"
#include "tests/bench/audit/box_room_run.hpp"

namespace mh::testing_support {
namespace {

/// Digests of the map, of all images that a run showed to the system, and of its matches and poses.
std::vector<std::uint64_t> bits_of(const RunResult& run) {
  std::vector<std::uint64_t> bits{run.map_digest};
  for (const MappedFrame& call : run.mapping.calls)
    bits.insert(bits.end(), {call.image_digest, call.matching_digest, call.pose_digest});
  for_each_query(run, [&](const QueryScore& q) {
    bits.insert(bits.end(),
                {q.answer.image_digest, q.answer.matching_digest, q.answer.pose_digest});
  });
  return bits;
}

TEST(AuditRun, ChangesNoBitOfTheRunNorOfItsMap) {
  const World in = world();
  const RunSpec of = spec({SemanticConfig{}, SemanticConfig::neutral()});
  const RunResult plain = run_one(of, in, quick());
  SlamState frozen;
  const RunResult run = run_with_map(of, in, quick(), frozen);
  const std::string map = encode_slam(frozen);
  audit_run(run, in, frozen);
  EXPECT_EQ(bits_of(run), bits_of(plain));
  EXPECT_GT(bits_of(run).size(), 100U);
  EXPECT_EQ(encode_slam(frozen), map);
}

TEST(AuditRun, FindsEachQuerySolvableThatIsAnsweredRightly) {
  const World in = world();
  const Audited a = audited(spec(), in);
  ASSERT_EQ(a.audit.points.size(), 1U);
  const PointAudit& point = a.audit.points[0];
  EXPECT_EQ(point.held_out.size(), 8U);
  EXPECT_EQ(point.second_tour.size(), 6U);
  double farthest_deg = 0;
  for (const QuerySet set : kQuerySets)
    for (const QueryAudit& q : queries(point, set)) {
      EXPECT_TRUE(q.first_correct) << name(set) << " " << q.frame;
      EXPECT_TRUE(q.correct);
      EXPECT_EQ(q.cause, FirstCause::kNone);
      EXPECT_TRUE(q.by_any && q.without_false && q.with_true_pose);
      EXPECT_TRUE(q.solving_candidate.has_value())
          << "the winning candidate alone does not answer as it did among the others";
      EXPECT_GT(q.best_co_visible, 0.7);
      EXPECT_LT(*q.nearest_m, 0.3);
      EXPECT_GE(q.relevant, 1);
      EXPECT_GT(*q.average_precision, 0.5);
      // Precision and recall at k count the same hits: those among the first k.
      for (const auto& [k, precision, recall] :
           {std::tuple(1, q.precision_1, q.recall_1), std::tuple(5, q.precision_5, q.recall_5),
            std::tuple(10, q.precision_10, q.recall_10)})
        EXPECT_NEAR(k * *precision, q.relevant * *recall, 1e-9) << k;
      EXPECT_GE(*q.solving_candidate, 1);
      EXPECT_GE(*q.solving_rank, 1);
      EXPECT_LE(*q.solving_rank, q.keyframes);
      EXPECT_GE(*q.solving_m, *q.nearest_m - 0.6) << "1 rad counts as 1 m for the nearest";
      EXPECT_LT(*q.solving_m, 1) << "the camera stays within a meter of the room's middle";
      farthest_deg = std::max(farthest_deg, *q.solving_deg);
      const StageMatches& words = q.matches[static_cast<std::size_t>(MatchStage::kWords)];
      EXPECT_GE(words.with_xi.kept_right(), 15);
      EXPECT_GT(*words.with_xi.precision(), 0.8) << "the room is sharp and all its patches differ";
      const StageMatches& all = q.matches[static_cast<std::size_t>(MatchStage::kEveryKeyframe)];
      EXPECT_GE(all.with_xi.kept_right(), words.with_xi.kept_right());
      EXPECT_GE(all.with_xi.kept_wrong(), words.with_xi.kept_wrong());
    }
}

TEST(AuditRun, WithoutAnythingInCommonNothingIsInSight) {
  const World in = world(tour(10, 70, {100, 0, 0}), std::make_shared<BoxRoomRenderer>(100, true));
  const Audited a = audited(spec(), in);
  for (const QueryAudit& q : a.audit.points[0].second_tour) {
    EXPECT_EQ(q.cause, FirstCause::kNothingInSight);
    EXPECT_EQ(q.best_co_visible, 0.0);
    EXPECT_EQ(q.relevant, 0);
    EXPECT_FALSE(q.average_precision.has_value());
    EXPECT_FALSE(q.by_any || q.without_false || q.with_true_pose);
    EXPECT_NEAR(*q.nearest_m, 100, 3);
  }
}

// The same walls are in sight, but gray: no feature can be matched to them.
TEST(AuditRun, WithoutTextureThereAreFewMatches) {
  const World in = world(tour(10, 70), std::make_shared<BoxRoomRenderer>(0, true));
  const Audited a = audited(spec(), in);
  for (const QueryAudit& q : a.audit.points[0].second_tour) {
    EXPECT_EQ(q.cause, FirstCause::kFewMatches);
    EXPECT_GT(q.best_co_visible, 0.7);
    EXPECT_FALSE(q.first_answered || q.by_any);
  }
}

TEST(AuditRun, XiOneChangesNoMatch) {
  SemanticConfig neutral = SemanticConfig::neutral();
  const Audited a = audited(spec({neutral}), world());
  for (const QueryAudit& q : a.audit.points[0].held_out)
    for (const StageMatches& m : q.matches) {
      EXPECT_EQ(m.with_xi.right, m.without_xi.right);
      EXPECT_EQ(m.with_xi.wrong, m.without_xi.wrong);
      EXPECT_EQ(m.xi.right_lost() + m.xi.right_gained + m.xi.wrong_removed + m.xi.wrong_gained, 0);
    }
}

TEST(AuditRun, OfManyPointsIsThatOfEachAlone) {
  const SemanticConfig paper{}, heavy{.gamma = 5, .xi = 3};
  const World in = world();
  // All settings share one map, which is made with the first of them.
  const Audited both = audited(spec({paper, heavy, paper}), in);
  const Audited alone = audited(spec({paper}), in);
  EXPECT_EQ(json_of(both.audit.points[0]), json_of(alone.audit.points[0]));
  EXPECT_EQ(json_of(both.audit.points[2]), json_of(alone.audit.points[0]));
  EXPECT_NE(json_of(both.audit.points[1]), json_of(alone.audit.points[0]));
}

// With neighbor scores as released, answers depend on the order of the queries and on each attempt.
TEST(AuditRun, FollowsTheRunUnderReleasedScores) {
  RunSpec of = spec({SemanticConfig{}, SemanticConfig::neutral()});
  SlamConfig settings = *of.slam;
  settings.relocalize.neighbor_scores = NeighborScores::kAsReleased;
  of.slam = settings;
  EXPECT_NO_THROW(audited(of, world()));  // MachineError if an answer differs from the run's
}

TEST(AuditRun, AnswersThatAreNotTheRunsAreRefused) {
  const World in = world();
  SlamState frozen;
  RunResult run = run_with_map(spec(), in, quick(), frozen);
  run.points[0].held_out[2].answer.world_from_camera = SE3();
  EXPECT_THROW(audit_run(run, in, frozen), MachineError);
}

TEST(AuditRun, IsReadBackAsItWasWritten) {
  const Audited a = audited(spec(), world());
  RunAudit read;
  read_json(nlohmann::ordered_json::parse(json_of(a.audit).dump()), read);
  EXPECT_EQ(json_of(read), json_of(a.audit));
}

std::string why_refused(const RunSpec& of) {
  try {
    require_auditable(of);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RequireAuditable, RefusesOutsideSystemsAndRecordings) {
  EXPECT_EQ(why_refused(spec()), "");
  RunSpec outside = spec();
  outside.system = {SystemKind::kOutside, "theirs", OutsideProgram()};
  EXPECT_NE(why_refused(outside).find("'theirs' gives no match traces"), std::string::npos);
  RunSpec recorded = spec();
  recorded.environment.sequence = "tum:desk";
  EXPECT_NE(why_refused(recorded).find("'room' is a recording"), std::string::npos);
}

std::vector<const QueryAudit*> pointers_to(const std::vector<QueryAudit>& queries) {
  std::vector<const QueryAudit*> pointers;
  for (const QueryAudit& q : queries) pointers.push_back(&q);
  return pointers;
}

QueryAudit made_up(FirstCause cause, bool solvable) {
  QueryAudit q;
  q.first_correct = q.correct = cause == FirstCause::kNone;
  q.cause = cause;
  q.by_any = q.without_false = q.with_true_pose = solvable;
  q.candidates = 2;
  q.relevant_candidates = 1;
  if (solvable) q.solving_candidate = cause == FirstCause::kNone ? 1 : 3;
  return q;
}

TEST(AuditSummary, CausesAndSuccessAddUpToAllQueries) {
  using enum FirstCause;
  std::vector<QueryAudit> all;
  for (const FirstCause cause : {kNone, kNone, kNone, kWrongCandidates, kNothingInSight,
                                 kFewMatches, kFalseAnswer, kFewInliers})
    all.push_back(made_up(cause, cause == kNone || cause == kWrongCandidates));
  const AuditSummary s = summarize(pointers_to(all));
  EXPECT_EQ(s.queries, 8U);
  EXPECT_DOUBLE_EQ(s.first_correct + s.wrong_candidates + s.nothing_in_sight + s.few_matches +
                       s.false_answer + s.few_inliers,
                   1.0);
  EXPECT_DOUBLE_EQ(s.by_any, 0.5);
  EXPECT_DOUBLE_EQ(*s.first_correct_of_solvable, 0.75);
  EXPECT_DOUBLE_EQ(*s.first_candidate_solves, 0.75);
  EXPECT_DOUBLE_EQ(*s.relevant_candidates, 0.5);
  EXPECT_FALSE(s.average_precision.has_value());
}

/// Six queries: some keyframe solves the first, second, third and last; the fifth has nothing in
/// sight.
std::vector<QueryAudit> six_queries() {
  std::vector<QueryAudit> all(6);
  all[0] = {.candidates = 3,
            .relevant_candidates = 2,
            .solving_candidate = 1,
            .average_precision = 0.9,
            .precision_1 = 1,
            .precision_5 = 0.8,
            .precision_10 = 0.4,
            .recall_1 = 0.1,
            .recall_5 = 0.5,
            .recall_10 = 0.6,
            .solving_rank = 1,
            .solving_m = 0.2,
            .solving_deg = 10};
  all[1] = {.candidates = 2,
            .average_precision = 0.5,
            .precision_1 = 0,
            .precision_5 = 0.4,
            .precision_10 = 0.3,
            .recall_1 = 0,
            .recall_5 = 0.3,
            .recall_10 = 0.5,
            .solving_rank = 4,
            .solving_m = 1.0,
            .solving_deg = 40};
  all[2] = {.candidates = 4,
            .relevant_candidates = 1,
            .solving_candidate = 1,
            .average_precision = 0.3,
            .precision_1 = 0,
            .precision_5 = 0.2,
            .precision_10 = 0.1,
            .recall_1 = 0,
            .recall_5 = 0.1,
            .recall_10 = 0.2,
            .solving_rank = 2,
            .solving_m = 0.4,
            .solving_deg = 20};
  all[3] = {.average_precision = 0.1,
            .precision_1 = 0,
            .precision_5 = 0.2,
            .precision_10 = 0.2,
            .recall_1 = 0,
            .recall_5 = 0.2,
            .recall_10 = 0.3};
  all[4] = {.candidates = 1};
  all[5] = {.candidates = 2,
            .relevant_candidates = 2,
            .solving_candidate = 3,
            .average_precision = 0.7,
            .precision_1 = 1,
            .precision_5 = 0.6,
            .precision_10 = 0.5,
            .recall_1 = 0.2,
            .recall_5 = 0.65,
            .recall_10 = 0.8,
            .solving_rank = 9,
            .solving_m = 3.0,
            .solving_deg = 90};
  const double co_visible[] = {0.9, 0.7, 0.5, 0.3, 0.05, 0.55};
  const double label_mass[] = {0.3, 0.1, 0.2, 0.0, 0.4, 0.8};
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].best_co_visible = co_visible[i];
    all[i].label_mass = label_mass[i];
    all[i].by_any = all[i].solving_rank.has_value();
  }
  all[0].first_correct = true;
  return all;
}

TEST(AuditSummary, OfRetrievalIsOverTheQueriesThatHaveTheValue) {
  const std::vector<QueryAudit> all = six_queries();
  const AuditSummary s = summarize(pointers_to(all));
  EXPECT_DOUBLE_EQ(s.candidates, 2.0);
  EXPECT_DOUBLE_EQ(*s.relevant_candidates, 5.0 / 12);
  // Means over the four queries that some keyframe solves.
  EXPECT_DOUBLE_EQ(*s.first_correct_of_solvable, 0.25);
  EXPECT_DOUBLE_EQ(*s.candidate_solves, 0.75);
  EXPECT_DOUBLE_EQ(*s.first_candidate_solves, 0.5);
  EXPECT_DOUBLE_EQ(*s.most_similar_solves, 0.25);
  // Means over the five queries that have these figures.
  EXPECT_DOUBLE_EQ(*s.average_precision, 0.5);
  EXPECT_DOUBLE_EQ(*s.precision_1, 0.4);
  EXPECT_DOUBLE_EQ(*s.precision_5, 0.44);
  EXPECT_DOUBLE_EQ(*s.precision_10, 0.3);
  EXPECT_DOUBLE_EQ(*s.recall_1, 0.06);
  EXPECT_DOUBLE_EQ(*s.recall_5, 0.35);
  EXPECT_DOUBLE_EQ(*s.recall_10, 0.48);
  EXPECT_DOUBLE_EQ(s.best_co_visible, 0.5);
  EXPECT_DOUBLE_EQ(s.label_mass, 0.3);
}

TEST(AuditSummary, AMedianIsTheMiddleOrTheMeanOfTheMiddleTwo) {
  std::vector<QueryAudit> all = six_queries();  // ranks 1, 4, 2, 9
  const AuditSummary even = summarize(pointers_to(all));
  EXPECT_DOUBLE_EQ(*even.solving_rank, 3);
  EXPECT_DOUBLE_EQ(*even.solving_m, 0.7);
  EXPECT_DOUBLE_EQ(*even.solving_deg, 30);
  all.pop_back();
  const AuditSummary odd = summarize(pointers_to(all));
  EXPECT_DOUBLE_EQ(*odd.solving_rank, 2);
  EXPECT_DOUBLE_EQ(*odd.solving_m, 0.4);
  EXPECT_DOUBLE_EQ(*odd.solving_deg, 20);
  all.erase(all.begin(), all.begin() + 3);
  EXPECT_FALSE(summarize(pointers_to(all)).solving_m.has_value());
}

/// 21 queries: 1 correct, 2 with wrong candidates, 3 with nothing in sight and so on.
std::vector<QueryAudit> twenty_one_queries() {
  using enum FirstCause;
  std::vector<QueryAudit> all;
  int count = 0;
  for (const FirstCause cause :
       {kNone, kWrongCandidates, kNothingInSight, kFewMatches, kFalseAnswer, kFewInliers}) {
    ++count;
    for (int i = 0; i < count; ++i) all.push_back(made_up(cause, false));
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].correct = i < 7;
    all[i].by_nearest = i < 8;
    all[i].by_any = i < 9;
    all[i].without_false = i < 10;
    all[i].with_true_pose = i < 11;
  }
  return all;
}

TEST(AuditSummary, SharesAreOfAllQueries) {
  const std::vector<QueryAudit> all = twenty_one_queries();
  const AuditSummary s = summarize(pointers_to(all));
  EXPECT_EQ(s.queries, 21U);
  const double shares[] = {s.first_correct, s.wrong_candidates, s.nothing_in_sight, s.few_matches,
                           s.false_answer,  s.few_inliers,      s.correct,          s.by_nearest,
                           s.by_any,        s.without_false,    s.with_true_pose};
  for (int i = 0; i < 11; ++i) EXPECT_DOUBLE_EQ(shares[i], (i + 1) / 21.0) << i;
  EXPECT_DOUBLE_EQ(*s.first_correct_of_solvable, 1.0 / 9);
  EXPECT_FALSE(summarize(std::span<const QueryAudit* const>()).relevant_candidates.has_value());
}

/// The words of the first row below the headings of the table with this title.
std::vector<std::string> row_below(const std::string& text, const std::string& title) {
  std::istringstream in(text.substr(text.find(title)));
  std::string line;
  for (int i = 0; i < 3; ++i) std::getline(in, line);
  std::istringstream words(line);
  return {std::istream_iterator<std::string>(words), {}};
}

TEST(AuditText, EachCellStandsUnderItsHeading) {
  Suite suite;
  const auto text_of = [&](const std::vector<QueryAudit>& held_out) {
    const std::vector<AuditedRun> runs{{spec(), "key", {.points = {{held_out, {}}}}}};
    return audit_text(suite, runs);
  };
  using Words = std::vector<std::string>;
  const std::string causes = text_of(twenty_one_queries());
  EXPECT_EQ(row_below(causes, "answers, and the first cause"),
            (Words{"semantic", "exact", "held", "out", "21", "33.3", "4.8", "9.5", "14.3", "19.0",
                   "23.8", "28.6"}))
      << causes;
  EXPECT_EQ(row_below(causes, "ceilings (%)"), (Words{"semantic", "exact", "held", "out", "4.8",
                                                      "38.1", "42.9", "47.6", "52.4", "11.1"}))
      << causes;
  const std::string retrieval = text_of(six_queries());
  EXPECT_EQ(row_below(retrieval, "retrieval:"),
            (Words{"semantic", "exact", "held", "out", "0.500", "0.400", "0.440", "0.300", "0.350",
                   "0.480", "2.00", "41.7", "50.0", "75.0", "3", "0.70", "30", "30.0"}))
      << retrieval;
}

TEST(AuditFiles, HaveOneRowPerQueryAndEveryFigure) {
  const RunSpec of = spec({SemanticConfig{}, SemanticConfig::neutral()});
  Suite suite;
  suite.name = "made up";
  const std::vector<AuditedRun> runs{{of,
                                      "key",
                                      {.points = {{{made_up(FirstCause::kNone, true)}, {}},
                                                  {{made_up(FirstCause::kFewMatches, false)}, {}}},
                                       .audit_s = 2,
                                       .run_s = 8}}};
  const std::string csv = audit_csv(runs);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 3);
  const auto columns = [&](std::size_t begin) {
    return std::ranges::count(csv.substr(begin, csv.find('\n', begin) - begin), ',');
  };
  EXPECT_EQ(columns(0), columns(csv.find('\n') + 1));
  EXPECT_TRUE(csv.starts_with("run,environment,category,level,system,labels,trial,")) << csv;
  EXPECT_NE(csv.find("few_matches"), std::string::npos);

  const auto json = audit_json(suite, runs);
  EXPECT_EQ(json["rows"].size(), 1U) << "without a sweep the points of a run are one row";
  EXPECT_EQ(json["rows"][0]["queries"], 2);
  EXPECT_EQ(json["rows"][0]["few_matches"], 0.5);
  EXPECT_EQ(json["environments"][0]["environment"], "room");
  const auto figures = audit_json(
      suite, std::vector<AuditedRun>{{of, "key", {.points = {{six_queries(), {}}}}}})["rows"][0];
  EXPECT_EQ(figures["most_similar_solves"], 0.25);
  EXPECT_NEAR(figures["recall_1"], 0.06, 1e-12);
  EXPECT_NEAR(figures["recall_5"], 0.35, 1e-12);
  EXPECT_EQ(figures["solving_rank"], 3);
  EXPECT_EQ(figures["solving_deg"], 30);
  EXPECT_EQ(figures["best_co_visible"], 0.5);
  const std::string text = audit_text(suite, runs);
  EXPECT_NE(text.find("1.00 s of CPU time per query (2 queries), 25 % of what the run took"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace mh::testing_support
