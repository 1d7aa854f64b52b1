// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/pose_system.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Cholesky>

namespace mh {
namespace {

/// Eigen multiplies large matrices in blocks that it fits to the processor's caches, and the blocks
/// determine the order of its sums. Setting the same block sizes everywhere (those of a small
/// server) gives the same bits everywhere.
[[maybe_unused]] const bool kBlocksAreTheSameEverywhere = [] {
  Eigen::setCpuCacheSizes(32 << 10, 512 << 10, 16 << 20);
  return true;
}();

Eigen::Index first_of(std::uint32_t pose) {
  return 6 * static_cast<Eigen::Index>(pose);
}

}  // namespace

PoseSystem::PoseSystem(std::uint32_t poses,
                       const std::vector<std::pair<std::uint32_t, std::uint32_t>>& coupled)
    : poses_(poses) {
  if (direct()) {
    blocks_.resize(std::size_t{poses} * (poses + 1) / 2);
    return;
  }
  std::vector<std::vector<bool>> used(poses);
  for (std::uint32_t row = 0; row < poses; ++row) {
    used[row].resize(row + 1, false);
    used[row][row] = true;
  }
  for (const auto& [a, b] : coupled) used[std::max(a, b)][std::min(a, b)] = true;
  for (std::uint32_t row = 0; row < poses; ++row) {
    start_.push_back(column_.size());
    for (std::uint32_t column = 0; column <= row; ++column)
      if (used[row][column]) column_.push_back(column);
  }
  start_.push_back(column_.size());
  blocks_.resize(column_.size());
}

void PoseSystem::set_zero() {
  for (Block& block : blocks_) block.setZero();
}

std::size_t PoseSystem::find(std::uint32_t row, std::uint32_t column) const {
  const auto begin = column_.begin() + static_cast<std::ptrdiff_t>(start_[row]);
  const auto end = column_.begin() + static_cast<std::ptrdiff_t>(start_[row + 1]);
  const auto at = std::lower_bound(begin, end, column);
  assert(at != end && *at == column);
  return static_cast<std::size_t>(at - column_.begin());
}

bool PoseSystem::solve(Eigen::VectorXd& right_side) const {
  return direct() ? factorize(right_side) : iterate(right_side);
}

bool PoseSystem::factorize(Eigen::VectorXd& x) const {
  Eigen::MatrixXd matrix(first_of(poses_), first_of(poses_));
  for (std::uint32_t row = 0; row < poses_; ++row)
    for (std::uint32_t column = 0; column <= row; ++column)
      matrix.block<6, 6>(first_of(row), first_of(column)) = blocks_[index(row, column)];
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(matrix);
  if (factor.info() != Eigen::Success) return false;
  factor.solveInPlace(x);
  return true;
}

Eigen::VectorXd PoseSystem::times(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (std::uint32_t row = 0; row < poses_; ++row)
    for (std::size_t i = start_[row]; i < start_[row + 1]; ++i) {
      const std::uint32_t column = column_[i];
      if (column == row) {
        y.segment<6>(first_of(row)) +=
            blocks_[i].selfadjointView<Eigen::Lower>() * x.segment<6>(first_of(row));
        continue;
      }
      y.segment<6>(first_of(row)).noalias() += blocks_[i] * x.segment<6>(first_of(column));
      y.segment<6>(first_of(column)).noalias() +=
          blocks_[i].transpose() * x.segment<6>(first_of(row));
    }
  return y;
}

/// Conjugate gradients, preconditioned by the diagonal blocks (Nocedal and Wright, algorithm 5.3).
bool PoseSystem::iterate(Eigen::VectorXd& x) const {
  std::vector<Eigen::LLT<Block>> diagonal(poses_);
  for (std::uint32_t pose = 0; pose < poses_; ++pose) {
    diagonal[pose].compute(blocks_[start_[pose + 1] - 1]);
    if (diagonal[pose].info() != Eigen::Success) return false;
  }
  const auto precondition = [&](const Eigen::VectorXd& r) {
    Eigen::VectorXd z = r;
    for (std::uint32_t pose = 0; pose < poses_; ++pose) {
      Eigen::Matrix<double, 6, 1> part = z.segment<6>(first_of(pose));
      diagonal[pose].solveInPlace(part);
      z.segment<6>(first_of(pose)) = part;
    }
    return z;
  };
  Eigen::VectorXd residual = x;
  x.setZero();
  Eigen::VectorXd z = precondition(residual);
  Eigen::VectorXd direction = z;
  double energy = residual.dot(z);
  const double enough = kTolerance * kTolerance * energy;
  // Conjugate gradients are exact after as many steps as there are unknowns. A system that needs a
  // tenth of that is hopelessly ill-conditioned; the step found so far is still a descent
  // direction.
  const int limit = 100 + static_cast<int>(poses_) / 2;
  for (int i = 0; i < limit && energy > enough; ++i) {
    const Eigen::VectorXd image = times(direction);
    const double curvature = direction.dot(image);
    if (!(curvature > 0)) return false;
    const double length = energy / curvature;
    x += length * direction;
    residual -= length * image;
    z = precondition(residual);
    const double next = residual.dot(z);
    direction = z + next / energy * direction;
    energy = next;
  }
  return true;
}

}  // namespace mh
