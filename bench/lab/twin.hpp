// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/lab/image_statistics.hpp"
#include "slam/config/features.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/sequence.hpp"
#include "slam/features/features.hpp"

namespace mh {

/// The frames of a recording with known true poses, transformed to the scene's frame so that a twin
/// can be rendered. Frames without a pose are left out.
class PosedFrames : public Sequence {
 public:
  /// @param scene_from_recording  transform from the frame of the recording's truth to the scene's
  /// @throws InputError if fewer than two poses are known
  PosedFrames(std::unique_ptr<Sequence> all, const SE3& scene_from_recording,
              std::size_t at_most = SIZE_MAX);

  const Camera& camera() const override { return all_->camera(); }
  std::size_t size() const override { return index_.size(); }
  Stamp stamp_ns(std::size_t i) const override { return poses_[i].stamp_ns; }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    return all_->frame(index_[i], noise);
  }
  const Trajectory* truth() const override { return &poses_; }
  std::size_t left_out() const { return left_out_; }

 private:
  std::unique_ptr<Sequence> all_;
  std::vector<std::size_t> index_;
  Trajectory poses_;
  std::size_t left_out_ = 0;
};

/// What becomes of an image's keypoints in another image that was taken from the same pose.
struct KeypointAgreement {
  std::size_t keypoints = 0;  ///< keypoints of the first image
  /// With a keypoint of the other image in the same place: within 3 px and one octave.
  std::size_t repeated = 0;
  /// Whose most similar keypoint within 20 px and 50 bits is in the same place.
  std::size_t matched = 0;
  /// Whose most similar keypoint within 20 px and 50 bits is not in the same place.
  std::size_t mismatched = 0;
};
KeypointAgreement agreement(const Features& first, const Features& other);

/// A recorded frame beside the rendering from its pose.
struct TwinFrame {
  Stamp stamp_ns = 0;
  ImageStatistics recorded{}, rendered{};                     ///< from measure_image()
  double recorded_depth_share = 0, rendered_depth_share = 0;  ///< share of pixels with a return
  /// Median over the pixels where both images have a return; absent if there is no such pixel.
  std::optional<double> depth_difference_m;  ///< |rendered - recorded|
  KeypointAgreement across;                  ///< recorded keypoints in the rendering
  KeypointAgreement noise;  ///< rendered keypoints in a rendering with other draws of the noise
};

/// Compares frames of a recording with those of its twin, at a fixed interval.
/// @param twin  sequence of the same length and stamps
/// @param progress  receives the share that is done; may be empty
/// @returns the frames that both can deliver
std::vector<TwinFrame> compare_twins(const Sequence& recorded, const Sequence& twin,
                                     const FeatureConfig& features, std::size_t every,
                                     const std::function<void(double)>& progress = {});

/// A quantity over all compared frames: its median in the recording and in the twin.
struct TwinRow {
  std::string key, name;
  double recorded = 0, rendered = 0;
};
/// Medians of every quantity, in a fixed order. Shares of keypoints are over the keypoints of all
/// frames.
std::vector<TwinRow> summarize(const std::vector<TwinFrame>& frames);

}  // namespace mh
