// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/pose_graph.hpp"

#include <cmath>

#include <ceres/ceres.h>

namespace mh {
namespace {

/// Residual of one edge. Poses are world_from_camera: a point p (m) and a unit quaternion q.
struct EdgeResidual {
  Eigen::Quaterniond measured_rotation;  // a_from_b
  Eigen::Vector3d measured_translation_m;
  double inverse_sigma_m, inverse_sigma_rad;

  template <class T>
  bool operator()(const T* pa, const T* qa, const T* pb, const T* qb, T* residual) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> position_a(pa), position_b(pb);
    const Eigen::Map<const Eigen::Quaternion<T>> rotation_a(qa), rotation_b(qb);
    const Eigen::Quaternion<T> a_from_world = rotation_a.conjugate();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
    r.template head<3>() =
        (a_from_world * (position_b - position_a) - measured_translation_m.template cast<T>()) *
        T(inverse_sigma_m);
    const Eigen::Quaternion<T> difference =
        measured_rotation.template cast<T>().conjugate() * (a_from_world * rotation_b);
    // Twice the vector part is the rotation vector to first order; its sign follows that of w, so
    // that q and -q agree.
    const T sign = difference.w() < T(0) ? T(-1) : T(1);
    r.template tail<3>() = difference.vec() * (T(2) * sign * T(inverse_sigma_rad));
    return true;
  }
};

struct FreePose {
  Eigen::Vector3d position;
  Eigen::Quaterniond rotation;
};

}  // namespace

std::vector<SE3> optimize_pose_graph(const std::vector<SE3>& camera_from_world,
                                     const std::vector<PoseGraphEdge>& edges,
                                     const PoseGraphConfig& config) {
  std::vector<FreePose> poses;
  for (const SE3& pose : camera_from_world) {
    const SE3 world_from_camera = pose.inverse();
    poses.push_back({world_from_camera.translation(), world_from_camera.quaternion()});
  }
  ceres::Problem problem;
  for (FreePose& pose : poses) {
    problem.AddParameterBlock(pose.position.data(), 3);
    problem.AddParameterBlock(pose.rotation.coeffs().data(), 4, new ceres::EigenQuaternionManifold);
  }
  problem.SetParameterBlockConstant(poses.front().position.data());
  problem.SetParameterBlockConstant(poses.front().rotation.coeffs().data());
  for (const PoseGraphEdge& edge : edges) {
    const double strength = std::sqrt(edge.weight);
    auto* residual = new EdgeResidual{edge.a_from_b.quaternion(), edge.a_from_b.translation(),
                                      strength / config.sigma_m, strength / config.sigma_rad};
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<EdgeResidual, 6, 3, 4, 3, 4>(residual),
                             nullptr, poses[edge.a].position.data(),
                             poses[edge.a].rotation.coeffs().data(), poses[edge.b].position.data(),
                             poses[edge.b].rotation.coeffs().data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = config.max_iterations;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  std::vector<SE3> result;
  for (const FreePose& pose : poses) result.push_back(SE3(pose.rotation, pose.position).inverse());
  return result;
}

}  // namespace mh
