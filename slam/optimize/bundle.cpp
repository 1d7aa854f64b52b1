// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/bundle.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/LU>

#include "slam/optimize/pose_system.hpp"
#include "slam/optimize/reprojection.hpp"

namespace mh {
namespace {

using Matrix63d = Eigen::Matrix<double, 6, 3>;

/// Marquardt damping, relative to the diagonal. Even the least damping bounds the inverse of the
/// block of a point without parallax.
constexpr double kInitialDamping = 1e-4;
constexpr double kLeastDamping = 1e-8;
constexpr double kGreatestDamping = 1e12;

struct State {
  std::vector<SE3> camera_from_world;
  std::vector<Eigen::Vector3d> points_in_world;
};

/// The reduced camera system and what is needed to recover the points from its solution. Everything
/// is allocated once, before the first iteration.
struct Workspace {
  std::vector<std::uint32_t> first_observation;  ///< of each point, plus the end
  std::vector<std::uint8_t> active;              ///< observations active in this phase
  std::vector<std::uint8_t> adjusted;            ///< points that are optimized

  std::vector<Matrix63d> pose_point;           ///< per observation: W = J_pose^T J_point
  std::vector<std::uint8_t> coupled;           ///< per observation: whether W is in use
  std::vector<Eigen::Matrix3d> point_inverse;  ///< per point: V^-1, damped
  std::vector<Eigen::Vector3d> point_gradient;
  PoseSystem reduced;             ///< U - W V^-1 W^T
  Eigen::VectorXd pose_diagonal;  ///< diagonal of U, for the damping
  Eigen::VectorXd right_side;
  Eigen::VectorXd pose_step;
};

ImageMeasurement measurement(const BundleObservation& o) {
  return {.u_px = o.u_px, .v_px = o.v_px, .disparity_px = o.disparity_px, .sigma_px = o.sigma_px};
}

double gate(const BundleObservation& o, const BundleConfig& config) {
  return o.disparity_px >= 0 ? config.chi2_stereo : config.chi2_mono;
}

/// Squared whitened residual, kBehindChi2 for a point behind the camera.
double chi2_of(const BundleObservation& o, const State& state, const Camera& camera) {
  const Eigen::Vector3d p = state.camera_from_world[o.pose] * state.points_in_world[o.point];
  if (p.z() < kMinimumDepth_m) return kBehindChi2;
  return reprojection_residual(p, measurement(o), camera).squaredNorm();
}

/// Beyond this chi-square (6 degrees of freedom, 1 %), a motion counts less and less.
constexpr double kMotionChi2 = 16.8;

/// Whitened residual of a motion.
Vector6d motion_residual(const BundleMotion& m, const State& state) {
  Vector6d r =
      (state.camera_from_world[m.b] * state.camera_from_world[m.a].inverse() * m.b_from_a.inverse())
          .log();
  r.head<3>() /= m.sigma_m;
  r.tail<3>() /= m.sigma_rad;
  return r;
}

/// Pairs of free poses that see a point together or share a motion; empty if the system is dense
/// anyway.
std::vector<std::pair<std::uint32_t, std::uint32_t>> couplings(
    const BundleProblem& problem, const std::vector<std::uint32_t>& first_observation) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  if (problem.free_poses <= PoseSystem::kDirectPoses) return pairs;
  for (std::size_t point = 0; point + 1 < first_observation.size(); ++point)
    for (std::uint32_t a = first_observation[point]; a < first_observation[point + 1]; ++a)
      for (std::uint32_t b = first_observation[point]; b < a; ++b) {
        const std::uint32_t pose_a = problem.observations[a].pose;
        const std::uint32_t pose_b = problem.observations[b].pose;
        if (pose_a < problem.free_poses && pose_b < problem.free_poses)
          pairs.emplace_back(pose_a, pose_b);
      }
  for (const BundleMotion& m : problem.motions)
    if (m.a < problem.free_poses && m.b < problem.free_poses) pairs.emplace_back(m.a, m.b);
  return pairs;
}

Workspace make_workspace(const BundleProblem& problem) {
  const std::size_t points = problem.points_in_world.size();
  const std::size_t observations = problem.observations.size();
  const auto unknowns = static_cast<Eigen::Index>(6 * problem.free_poses);
  Workspace w;
  w.first_observation.assign(points + 1, 0);
  for (std::size_t i = 0; i < observations; ++i) {
    const BundleObservation& o = problem.observations[i];
    assert(o.pose < problem.camera_from_world.size() && o.point < points);
    assert(i == 0 || problem.observations[i - 1].point <= o.point);
    ++w.first_observation[o.point + 1];
  }
  for (std::size_t i = 0; i < points; ++i) w.first_observation[i + 1] += w.first_observation[i];
  w.active.assign(observations, 1);
  w.adjusted.assign(points, 0);
  w.pose_point.resize(observations);
  w.coupled.assign(observations, 0);
  w.point_inverse.resize(points);
  w.point_gradient.resize(points);
  w.reduced = PoseSystem(problem.free_poses, couplings(problem, w.first_observation));
  w.pose_diagonal.resize(unknowns);
  w.right_side.resize(unknowns);
  w.pose_step.resize(unknowns);
  return w;
}

/// Fixes every point that its active observations do not determine (fewer than two, and no depth),
/// and drops those observations: once the point is marginalized, they would contribute nothing to a
/// pose.
void choose_points(const BundleProblem& problem, Workspace& w) {
  for (std::size_t point = 0; point < problem.points_in_world.size(); ++point) {
    const std::uint32_t begin = w.first_observation[point];
    const std::uint32_t end = w.first_observation[point + 1];
    int count = 0;
    bool depth = false;
    for (std::uint32_t i = begin; i < end; ++i) {
      count += w.active[i];
      depth |= w.active[i] && problem.observations[i].disparity_px >= 0;
    }
    w.adjusted[point] = depth || count >= 2;
    if (!w.adjusted[point]) std::fill(w.active.begin() + begin, w.active.begin() + end, 0);
  }
}

/// One of the two phases of adjust(): with Huber's rho, or without it.
struct Phase {
  const BundleProblem& problem;
  const Camera& camera;
  const BundleConfig& config;
  bool robust;
};

/// Sum of rho over the active observations.
double cost_of(const Phase& phase, const Workspace& w, const State& state) {
  const auto& [problem, camera, config, robust] = phase;
  double cost = 0;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (!w.active[i]) continue;
    const BundleObservation& o = problem.observations[i];
    const double chi2 = chi2_of(o, state, camera);
    cost += robust ? huber_loss(chi2, gate(o, config)) : chi2;
  }
  for (const BundleMotion& m : problem.motions)
    cost += huber_loss(motion_residual(m, state).squaredNorm(), kMotionChi2);
  return cost;
}

/// Adds a motion to the blocks of its free poses. With left perturbations, the residual changes by
/// the perturbation of b minus the adjoint of b_from_a times that of a; the derivative of log is
/// taken as the identity.
void linearize_motion(const BundleMotion& m, const BundleProblem& problem, Workspace& w,
                      const State& state) {
  const Vector6d r = motion_residual(m, state);
  const double weight = huber_weight(r.squaredNorm(), kMotionChi2);
  Vector6d inverse_sigma;
  inverse_sigma << Eigen::Vector3d::Constant(1 / m.sigma_m),
      Eigen::Vector3d::Constant(1 / m.sigma_rad);
  const Matrix6d of_b = inverse_sigma.asDiagonal();
  Matrix6d adjoint = Matrix6d::Zero();
  const Eigen::Matrix3d rotation = m.b_from_a.rotation();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = rotation;
  adjoint.topRightCorner<3, 3>() = cross_columns(m.b_from_a.translation(), rotation);
  const Matrix6d of_a = -of_b * adjoint;
  const auto add = [&](std::uint32_t pose, const Matrix6d& jacobian) {
    if (pose >= problem.free_poses) return;
    const Matrix6d own = weight * jacobian.transpose() * jacobian;
    w.reduced.at(pose, pose) += own;
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(pose);
    w.pose_diagonal.segment<6>(at) += own.diagonal();
    w.right_side.segment<6>(at) -= weight * jacobian.transpose() * r;
  };
  add(m.a, of_a);
  add(m.b, of_b);
  if (m.a >= problem.free_poses || m.b >= problem.free_poses) return;
  if (m.a > m.b)
    w.reduced.at(m.a, m.b) += weight * of_a.transpose() * of_b;
  else
    w.reduced.at(m.b, m.a) += weight * of_b.transpose() * of_a;
}

/// Adds one point's observations to the pose blocks and to their gradient; fills W for each
/// observation.
/// @returns the point's own block.
Eigen::Matrix3d linearize_point(const Phase& phase, Workspace& w, const State& state,
                                std::uint32_t point) {
  const auto& [problem, camera, config, robust] = phase;
  Eigen::Matrix3d point_information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  for (std::uint32_t i = w.first_observation[point]; i < w.first_observation[point + 1]; ++i) {
    w.coupled[i] = 0;
    if (!w.active[i]) continue;
    const BundleObservation& o = problem.observations[i];
    const SE3& pose = state.camera_from_world[o.pose];
    const Eigen::Vector3d p = pose * state.points_in_world[point];
    if (p.z() < kMinimumDepth_m) continue;
    const ImageMeasurement measured = measurement(o);
    const Eigen::Vector3d r = reprojection_residual(p, measured, camera);
    const double weight = robust ? huber_weight(r.squaredNorm(), gate(o, config)) : 1.0;
    const CameraFrameTerm term = camera_frame_term(p, r, weight, measured, camera);
    const Eigen::Matrix3d mixed = term.information * pose.rotation();
    point_information.noalias() += pose.rotation().transpose() * mixed;
    gradient.noalias() += pose.rotation().transpose() * term.gradient;
    if (o.pose >= problem.free_poses) continue;

    w.coupled[i] = 1;
    w.pose_point[i].topRows<3>() = mixed;
    w.pose_point[i].bottomRows<3>() = cross_columns(p, mixed);
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(o.pose);
    const Eigen::Matrix3d turned = cross_columns(p, term.information);
    const Eigen::Matrix3d turned_twice = cross_columns(p, turned.transpose());
    PoseSystem::Block& own = w.reduced.at(o.pose, o.pose);
    own.topLeftCorner<3, 3>() += term.information;
    own.bottomLeftCorner<3, 3>() += turned;
    own.bottomRightCorner<3, 3>() += turned_twice;
    w.pose_diagonal.segment<3>(at) += term.information.diagonal();
    w.pose_diagonal.segment<3>(at + 3) += turned_twice.diagonal();
    w.right_side.segment<3>(at) -= term.gradient;
    w.right_side.segment<3>(at + 3) -= p.cross(term.gradient);
  }
  w.point_gradient[point] = gradient;
  return point_information;
}

/// Eliminates one point from the system: reduced -= W V^-1 W^T, right side += W V^-1 g.
void eliminate_point(const BundleProblem& problem, Workspace& w, std::uint32_t point) {
  const Eigen::Matrix3d& inverse = w.point_inverse[point];
  const std::uint32_t end = w.first_observation[point + 1];
  for (std::uint32_t a = w.first_observation[point]; a < end; ++a) {
    if (!w.coupled[a]) continue;
    const Matrix63d weighted = w.pose_point[a] * inverse;
    const std::uint32_t pose_a = problem.observations[a].pose;
    const Eigen::Index row = 6 * static_cast<Eigen::Index>(pose_a);
    w.right_side.segment<6>(row) += weighted * w.point_gradient[point];
    for (std::uint32_t b = a; b < end; ++b) {
      if (!w.coupled[b]) continue;
      const std::uint32_t pose_b = problem.observations[b].pose;
      if (pose_a >= pose_b)
        w.reduced.at(pose_a, pose_b).noalias() -= weighted * w.pose_point[b].transpose();
      // The mirrored block. If one pose sees the point twice, both are added.
      if (pose_a < pose_b || (pose_a == pose_b && a != b))
        w.reduced.at(pose_b, pose_a).noalias() -= w.pose_point[b] * weighted.transpose();
    }
  }
}

/// Linearizes at the state and builds the system reduced to the poses.
void build_reduced_system(const Phase& phase, Workspace& w, const State& state, double damping) {
  const BundleProblem& problem = phase.problem;
  w.reduced.set_zero();
  w.pose_diagonal.setZero();
  w.right_side.setZero();
  for (std::uint32_t point = 0; point < problem.points_in_world.size(); ++point) {
    if (!w.adjusted[point]) continue;
    Eigen::Matrix3d information = linearize_point(phase, w, state, point);
    const double trace = information.trace();
    if (!(trace > 0)) {  // the point is now behind every camera that observes it
      w.point_inverse[point].setZero();
      continue;
    }
    // The floor keeps the inverse finite if a direction in space gets no information at all.
    information.diagonal() *= 1.0 + damping;
    information.diagonal().array() += kLeastDamping * trace;
    w.point_inverse[point] = information.inverse();
    eliminate_point(problem, w, point);
  }
  for (const BundleMotion& m : problem.motions) linearize_motion(m, problem, w, state);
  for (std::uint32_t pose = 0; pose < problem.free_poses; ++pose) {
    const Vector6d diagonal = w.pose_diagonal.segment<6>(6 * static_cast<Eigen::Index>(pose));
    PoseSystem::Block& own = w.reduced.at(pose, pose);
    own.diagonal() += damping * diagonal;
    // A pose without information stays fixed.
    for (Eigen::Index k = 0; k < 6; ++k)
      if (!(diagonal[k] > 0)) own(k, k) = 1.0;
  }
}

/// Solves for the poses, then back-substitutes the points. @returns false if the system is not
/// positive definite.
bool take_step(const BundleProblem& problem, Workspace& w, const State& from, State& to) {
  w.pose_step = w.right_side;
  if (!w.reduced.solve(w.pose_step) || !w.pose_step.allFinite()) return false;
  for (std::uint32_t pose = 0; pose < problem.free_poses; ++pose) {
    const Vector6d step = w.pose_step.segment<6>(6 * static_cast<Eigen::Index>(pose));
    to.camera_from_world[pose] = SE3::exp(step) * from.camera_from_world[pose];
  }
  for (std::uint32_t point = 0; point < problem.points_in_world.size(); ++point) {
    if (!w.adjusted[point]) continue;
    Eigen::Vector3d right = -w.point_gradient[point];
    for (std::uint32_t i = w.first_observation[point]; i < w.first_observation[point + 1]; ++i) {
      if (!w.coupled[i]) continue;
      const Eigen::Index at = 6 * static_cast<Eigen::Index>(problem.observations[i].pose);
      right.noalias() -= w.pose_point[i].transpose() * w.pose_step.segment<6>(at);
    }
    to.points_in_world[point] = from.points_in_world[point] + w.point_inverse[point] * right;
  }
  return true;
}

/// One phase of Levenberg-Marquardt over the active observations. @returns the number of trial
/// steps.
int minimize(const Phase& phase, Workspace& w, State& state, State& trial, int iterations) {
  choose_points(phase.problem, w);
  double cost = cost_of(phase, w, state);
  const double perfect = kPerfectChi2 * static_cast<double>(phase.problem.observations.size());
  double damping = kInitialDamping;
  int made = 0;
  while (made < iterations && cost > perfect && damping < kGreatestDamping) {
    ++made;
    build_reduced_system(phase, w, state, damping);
    const bool solved = take_step(phase.problem, w, state, trial);
    const double trial_cost = solved ? cost_of(phase, w, trial) : HUGE_VAL;
    if (!(trial_cost <= cost)) {
      damping *= 10.0;
      continue;
    }
    const bool settled = cost - trial_cost <= phase.config.relative_decrease * cost;
    std::swap(state, trial);
    cost = trial_cost;
    damping = std::max(0.1 * damping, kLeastDamping);
    if (settled) break;
  }
  return made;
}

}  // namespace

BundleResult adjust(const BundleProblem& problem, const Camera& camera,
                    const BundleConfig& config) {
  assert(problem.free_poses <= problem.camera_from_world.size());
  const std::size_t count = problem.observations.size();
  Workspace w = make_workspace(problem);
  State state{problem.camera_from_world, problem.points_in_world};
  State trial = state;
  BundleResult result;

  for (std::size_t i = 0; i < count; ++i) {
    const BundleObservation& o = problem.observations[i];
    const double chi2 = chi2_of(o, state, camera);
    result.initial_cost += huber_loss(chi2, gate(o, config));
    w.active[i] = chi2 != kBehindChi2;
  }
  result.iterations = minimize({problem, camera, config, true}, w, state, trial, config.iterations);

  if (config.refine_iterations > 0) {
    for (std::size_t i = 0; i < count; ++i) {
      const BundleObservation& o = problem.observations[i];
      w.active[i] = chi2_of(o, state, camera) <= gate(o, config);
    }
    trial = state;
    result.iterations +=
        minimize({problem, camera, config, false}, w, state, trial, config.refine_iterations);
  }

  for (std::uint32_t pose = 0; pose < problem.free_poses; ++pose)
    state.camera_from_world[pose] = state.camera_from_world[pose].normalized();
  result.outlier.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const BundleObservation& o = problem.observations[i];
    const double chi2 = chi2_of(o, state, camera);
    result.outlier[i] = !(chi2 <= gate(o, config));
    if (!result.outlier[i]) result.final_cost += chi2;
  }
  result.camera_from_world = std::move(state.camera_from_world);
  result.points_in_world = std::move(state.points_in_world);
  return result;
}

}  // namespace mh
