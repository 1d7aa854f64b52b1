// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/pose_graph.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace mh {
namespace {

/// n cameras around a circle of 3 m radius, looking outward.
std::vector<SE3> circle(int n) {
  std::vector<SE3> poses;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    poses.push_back(SE3(so3_exp({0, 0, a}), {3 * std::cos(a) - 3, 3 * std::sin(a), 0}).inverse());
  }
  return poses;
}

PoseGraphEdge edge(const std::vector<SE3>& poses, std::uint32_t a, std::uint32_t b,
                   const SE3& error = SE3()) {
  return {a, b, poses[a] * poses[b].inverse() * error};
}

double worst_error_m(const std::vector<SE3>& a, const std::vector<SE3>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    worst = std::max(worst, (a[i].inverse().translation() - b[i].inverse().translation()).norm());
  return worst;
}

TEST(PoseGraph, ConsistentEdgesGiveTheTruthBack) {
  const std::vector<SE3> truth = circle(30);
  std::vector<PoseGraphEdge> edges;
  for (std::uint32_t i = 0; i < 30; ++i) edges.push_back(edge(truth, i, (i + 1) % 30));
  std::vector<SE3> start = truth;
  const Vector6d off = (Vector6d() << 0.1, -0.05, 0.02, 0.03, 0.02, -0.05).finished();
  for (std::size_t i = 1; i < start.size(); ++i) start[i] = SE3::exp(off) * start[i];
  EXPECT_LT(worst_error_m(optimize_pose_graph(start, edges), truth), 1e-4);
}

TEST(PoseGraph, ALoopTakesTheDriftOutOfAChain) {
  const std::vector<SE3> truth = circle(60);
  // Odometry that turns 0.2 degrees too far per edge: 12 degrees over the circle.
  const SE3 bias(so3_exp({0, 0, 0.0035}), Eigen::Vector3d::Zero());
  std::vector<PoseGraphEdge> edges;
  std::vector<SE3> drifted{truth[0]};
  for (std::uint32_t i = 1; i < 60; ++i) {
    edges.push_back(edge(truth, i - 1, i, bias));
    drifted.push_back(edges.back().a_from_b.inverse() * drifted.back());
  }
  const double before_m = worst_error_m(drifted, truth);
  edges.push_back(edge(truth, 59, 0));
  const std::vector<SE3> closed = optimize_pose_graph(drifted, edges);
  const double end_before_m =
      (drifted[59].inverse().translation() - truth[59].inverse().translation()).norm();
  const double end_after_m =
      (closed[59].inverse().translation() - truth[59].inverse().translation()).norm();
  EXPECT_GT(end_before_m, 0.3);
  EXPECT_LT(end_after_m, end_before_m / 5);
  EXPECT_LT(worst_error_m(closed, truth), before_m / 2);
  EXPECT_LT(worst_error_m({closed[0]}, {truth[0]}), 1e-12) << "the first pose is held";
}

TEST(PoseGraph, DriftIsTakenFromWhereLittleHoldsThePosesTogether) {
  const std::vector<SE3> truth = circle(40);
  // All odometry edges are correct except one, which is supported by one landmark instead of two
  // hundred.
  const SE3 slip(so3_exp({0, 0, 0.05}), Eigen::Vector3d(0.05, 0.02, 0));
  std::vector<PoseGraphEdge> edges;
  std::vector<SE3> drifted{truth[0]};
  for (std::uint32_t i = 1; i < 40; ++i) {
    edges.push_back(edge(truth, i - 1, i, i == 20 ? slip : SE3()));
    edges.back().weight = i == 20 ? 1 : 200;
    drifted.push_back(edges.back().a_from_b.inverse() * drifted.back());
  }
  edges.push_back(edge(truth, 39, 0));
  edges.back().weight = 200;
  const double weighted_m = worst_error_m(optimize_pose_graph(drifted, edges), truth);
  for (PoseGraphEdge& e : edges) e.weight = 1;
  const double even_m = worst_error_m(optimize_pose_graph(drifted, edges), truth);
  EXPECT_GT(even_m, 0.03);
  EXPECT_LT(weighted_m, even_m / 3);
}

}  // namespace
}  // namespace mh
