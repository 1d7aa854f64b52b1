// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/loop_audit.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

// A camera that moves 0.1 m and turns 0.02 rad with each frame.
Trajectory truth() {
  Trajectory poses;
  for (int i = 0; i < 50; ++i)
    poses.push_back({i * Stamp{1000},
                     SE3(Eigen::AngleAxisd(0.02 * i, Eigen::Vector3d::UnitY()).toRotationMatrix(),
                         Eigen::Vector3d(0.1 * i, 0.0, 0.3))});
  return poses;
}

LoopClosure exact_loop(int newest, int old) {
  const Trajectory poses = truth();
  const auto at = [&](int i) { return poses[static_cast<std::size_t>(i)].world_from_camera; };
  return {newest * Stamp{1000}, old * Stamp{1000}, at(old).inverse() * at(newest)};
}

SE3 moved(double by_m) {
  return {Eigen::Matrix3d::Identity(), {0, by_m, 0}};
}

SE3 turned(double by_rad) {
  return {Eigen::AngleAxisd(by_rad, Eigen::Vector3d::UnitX()).toRotationMatrix(),
          Eigen::Vector3d::Zero()};
}

TEST(AuditLoops, TakesTheTrueRelativePoseForRight) {
  const std::vector<LoopClosure> loops = {exact_loop(40, 3), exact_loop(49, 10)};
  const LoopAudit audit = audit_loops(loops, truth(), {});
  EXPECT_EQ(audit.closed, 2);
  EXPECT_EQ(audit.false_positive, 0);
  EXPECT_NEAR(audit.worst_m, 0.0, 1e-12);
  EXPECT_NEAR(audit.worst_rad, 0.0, 1e-6);
  EXPECT_EQ(audit_loops({}, truth(), {}), LoopAudit{});
}

TEST(AuditLoops, IsWrongBeyondWhatACorrectAnswerMayBeOff) {
  const ProtocolConfig config;  // 0.25 m, 10 deg
  const auto off_by = [&](const SE3& error) {
    LoopClosure loop = exact_loop(40, 3);
    loop.old_from_new = loop.old_from_new * error;
    return audit_loops(std::span(&loop, 1), truth(), config);
  };
  EXPECT_EQ(off_by(moved(0.24)).false_positive, 0);
  EXPECT_NEAR(off_by(moved(0.24)).worst_m, 0.24, 1e-9);
  EXPECT_EQ(off_by(moved(0.26)).false_positive, 1);
  EXPECT_EQ(off_by(turned(0.17)).false_positive, 0);
  EXPECT_NEAR(off_by(turned(0.17)).worst_rad, 0.17, 1e-6);
  EXPECT_EQ(off_by(turned(0.18)).false_positive, 1);
}

TEST(AuditLoops, OfAMomentThatTheTruthDoesNotKnowIsNotJudged) {
  LoopClosure loop = exact_loop(40, 3);
  loop.old_stamp_ns = -1;
  const LoopAudit audit = audit_loops(std::span(&loop, 1), truth(), {});
  EXPECT_EQ(audit.closed, 1);
  EXPECT_EQ(audit.unknown, 1);
  EXPECT_EQ(audit.false_positive, 0);
}

}  // namespace
}  // namespace mh
