// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace mh {

/// The reduced system that bundle adjustment solves for the poses once points are eliminated:
/// symmetric, positive definite, blocks of 6x6. For few poses, it is dense and solved by Cholesky.
/// For many, it holds only the blocks of coupled poses and is solved by conjugate gradients, so
/// that memory and time grow with the number of couplings and not with the square and the cube of
/// the number of poses.
class PoseSystem {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;
  /// Up to this number of poses, a dense matrix is small (8 MB), and factoring it is fastest.
  static constexpr std::uint32_t kDirectPoses = 160;
  /// Residual, relative to the right-hand side, at which conjugate gradients stop: far below the
  /// error of a Levenberg-Marquardt step.
  static constexpr double kTolerance = 1e-8;

  /// @param coupled  pairs of poses (any order, repetitions allowed) whose blocks will be used.
  PoseSystem(std::uint32_t poses,
             const std::vector<std::pair<std::uint32_t, std::uint32_t>>& coupled);
  PoseSystem() = default;

  std::uint32_t poses() const { return poses_; }
  void set_zero();
  /// Block of the lower triangle; only the lower triangle of a diagonal block is read.
  /// @pre row >= column; the same pose or a coupled pair
  Block& at(std::uint32_t row, std::uint32_t column) { return blocks_[index(row, column)]; }
  /// Solves in place. @returns false if the system is not positive definite.
  bool solve(Eigen::VectorXd& right_side) const;

 private:
  std::size_t index(std::uint32_t row, std::uint32_t column) const {
    return direct() ? std::size_t{row} * (row + 1) / 2 + column : find(row, column);
  }
  bool direct() const { return poses_ <= kDirectPoses; }
  std::size_t find(std::uint32_t row, std::uint32_t column) const;
  bool factorize(Eigen::VectorXd& x) const;
  bool iterate(Eigen::VectorXd& x) const;
  Eigen::VectorXd times(const Eigen::VectorXd& x) const;

  std::uint32_t poses_ = 0;
  std::vector<Block> blocks_;  // row by row
  std::vector<std::size_t>
      start_;  // start of each row's blocks, plus the end; used for many poses only
  std::vector<std::uint32_t> column_;  // of each block, ascending within a row
};

}  // namespace mh
