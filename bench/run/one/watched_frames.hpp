// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "slam/core/sequence.hpp"
#include "slam/io/read_record.hpp"

namespace mh {

/// Forwards another sequence's frames, so that subclasses can observe them.
class SequenceView : public Sequence {
 public:
  explicit SequenceView(const Sequence& inner) : inner_(inner) {}
  const Camera& camera() const override { return inner_.camera(); }
  std::size_t size() const override { return inner_.size(); }
  Stamp stamp_ns(std::size_t i) const override { return inner_.stamp_ns(i); }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    return inner_.frame(i, noise);
  }
  const Trajectory* truth() const override { return inner_.truth(); }
  std::span<const ImuReading> imu() const override { return inner_.imu(); }

 private:
  const Sequence& inner_;
};

/// The state of a world's files when its key was made.
class FilesAsKeyed {
 public:
  explicit FilesAsKeyed(const ReadRecord& held);
  /// @throws InputChanged if any file that was just read differs from that state, even if it has
  /// been restored since
  void require(const ReadRecord& now) const;

 private:
  std::map<std::filesystem::path, FileObservation> of_;
};

/// The frames as a run sees them: their files match its key, and the CPU time spent making them is
/// counted.
class WatchedFrames : public SequenceView {
 public:
  /// @param recording  the recording that they come from; empty if they are simulated
  /// @param labeled  whether they are shown with labels
  /// @param spent_s  grows by the CPU time spent on making frames
  WatchedFrames(const Sequence& inner, std::string recording, bool labeled,
                const FilesAsKeyed& files, double& spent_s);
  RgbdFrame frame(std::size_t i, RandomStream noise) const override;

 private:
  RgbdFrame checked(std::size_t i, RandomStream noise) const;

  const std::string recording_;
  const bool labeled_;
  const FilesAsKeyed& files_;
  double& spent_s_;
};

/// Frames of one query, made once for all parameter points.
class FramesMadeOnce : public SequenceView {
 public:
  using SequenceView::SequenceView;
  RgbdFrame frame(std::size_t i, RandomStream noise) const override;

 private:
  mutable std::map<std::uint64_t, RgbdFrame> made_;
};

}  // namespace mh
