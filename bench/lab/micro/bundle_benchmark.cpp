// SPDX-License-Identifier: Apache-2.0
// Our bundle adjustment against Ceres (DENSE_SCHUR, one thread, analytic Jacobians) on the same
// problem: 10 keyframes, 1500 points, 6000 observations with depth, Huber loss, 5 iterations. Also
// compares optimization of the pose of a single frame.
#include <benchmark/benchmark.h>
#include <ceres/ceres.h>

#include "slam/optimize/bundle.hpp"
#include "slam/optimize/pose.hpp"
#include "slam/optimize/reprojection.hpp"
#include "tests/slam/optimize/bundle_problem.hpp"
#include "tests/slam/optimize/synthetic.hpp"

namespace mh {
namespace {

constexpr int kIterations = 5;
const Camera kCamera{};

BundleProblem problem() {
  testing::BundleShape shape;
  shape.disturbance_m = 0.02;
  return testing::make_bundle(shape, kCamera, RandomStream(1)).problem;
}

BundleConfig config() {
  return {.iterations = kIterations, .refine_iterations = 0, .relative_decrease = 1e-6};
}

/// A pose as (quaternion x y z w, translation), perturbed from the left. The cost functions return
/// their Jacobians in the tangent space with an additional zero column, so PlusJacobian is [I; 0].
class LeftPerturbation : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* sum) const override {
    const SE3 pose = SE3::exp(Eigen::Map<const Vector6d>(delta)) * load(x);
    store(pose, sum);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double*, const double*, double*) const override { return false; }
  bool MinusJacobian(const double*, double*) const override { return false; }

  static SE3 load(const double* x) {
    return {Eigen::Quaterniond(x), Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(x + 4))};
  }
  static void store(const SE3& pose, double* x) {
    Eigen::Map<Eigen::Vector4d>{x} = pose.quaternion().coeffs();
    Eigen::Map<Eigen::Vector3d>{x + 4} = pose.translation();
  }
};

class ReprojectionCost : public ceres::SizedCostFunction<3, 7, 3> {
 public:
  explicit ReprojectionCost(const ImageMeasurement& measured) : measured_(measured) {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const SE3 pose = LeftPerturbation::load(parameters[0]);
    const Eigen::Vector3d p =
        pose * Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(parameters[1]));
    Eigen::Map<Eigen::Vector3d> residual(residuals);
    residual = reprojection_residual(p, measured_, kCamera);
    if (!jacobians) return true;
    const Eigen::Matrix3d by_point = reprojection_jacobian(p, measured_, kCamera);
    if (jacobians[0]) {
      Eigen::Map<Eigen::Matrix<double, 3, 7, Eigen::RowMajor>> j(jacobians[0]);
      j << by_point * perturbation_jacobian(p), Eigen::Vector3d::Zero();
    }
    if (jacobians[1]) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> j(jacobians[1]);
      j = by_point * pose.rotation();
    }
    return true;
  }

 private:
  ImageMeasurement measured_;
};

void ours(benchmark::State& state) {
  const BundleProblem start = problem();
  double cost = 0;
  for (auto _ : state) {
    BundleResult result = adjust(start, kCamera, config());
    benchmark::DoNotOptimize(result.points_in_world.data());
    cost = result.final_cost;
  }
  state.counters["inlier_cost"] = cost;
}
BENCHMARK(ours)->Unit(benchmark::kMillisecond);

void ceres_dense_schur(benchmark::State& state) {
  const BundleProblem start = problem();
  double cost = 0;
  for (auto _ : state) {
    std::vector<double> poses(7 * start.camera_from_world.size());
    for (std::size_t i = 0; i < start.camera_from_world.size(); ++i)
      LeftPerturbation::store(start.camera_from_world[i], &poses[7 * i]);
    std::vector<Eigen::Vector3d> points = start.points_in_world;
    ceres::Problem ceres_problem;
    for (std::size_t i = 0; i < start.camera_from_world.size(); ++i) {
      ceres_problem.AddParameterBlock(&poses[7 * i], 7, new LeftPerturbation);
      if (i >= start.free_poses) ceres_problem.SetParameterBlockConstant(&poses[7 * i]);
    }
    for (const BundleObservation& o : start.observations)
      ceres_problem.AddResidualBlock(
          new ReprojectionCost({o.u_px, o.v_px, o.disparity_px, o.sigma_px}),
          new ceres::HuberLoss(std::sqrt(config().chi2_stereo)), &poses[7 * o.pose],
          points[o.point].data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.max_num_iterations = kIterations;
    options.function_tolerance = 1e-6;
    options.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &ceres_problem, &summary);
    BundleProblem end = start;
    for (std::size_t i = 0; i < end.camera_from_world.size(); ++i)
      end.camera_from_world[i] = LeftPerturbation::load(&poses[7 * i]);
    end.points_in_world = points;
    cost = 0;
    for (const BundleObservation& o : end.observations) {
      const Eigen::Vector3d p = end.camera_from_world[o.pose] * end.points_in_world[o.point];
      const double chi2 =
          reprojection_residual(p, {o.u_px, o.v_px, o.disparity_px, o.sigma_px}, kCamera)
              .squaredNorm();
      if (chi2 <= config().chi2_stereo) cost += chi2;
    }
    benchmark::DoNotOptimize(points.data());
  }
  state.counters["inlier_cost"] = cost;
}
BENCHMARK(ceres_dense_schur)->Unit(benchmark::kMillisecond);

void pose_of_300_matches(benchmark::State& state) {
  const SE3 truth = testing::true_pose();
  auto observations = testing::observe(300, truth, kCamera, RandomStream(1));
  testing::add_noise(observations, kCamera, RandomStream(2));
  testing::make_outliers(observations, 30, kCamera, RandomStream(3));
  const SE3 guess = SE3::exp(testing::tangent(0.02, -0.01, 0.02, 0.01, 0.01, -0.01)) * truth;
  for (auto _ : state) {
    auto estimate = estimate_pose(observations, guess, kCamera);
    benchmark::DoNotOptimize(estimate);
  }
}
BENCHMARK(pose_of_300_matches)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mh

BENCHMARK_MAIN();
