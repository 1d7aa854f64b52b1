// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/sequence.hpp"
#include "slam/io/error.hpp"
#include "slam/io/fields.hpp"

namespace mh {

/// Frames of a recording that were not shown to any system: they cannot be read, do not have the
/// camera's image size, or have stamps that do not increase.
struct SkippedFrames {
  static constexpr std::size_t kReasonsKept = 5;
  std::size_t count = 0;
  std::vector<std::string> reasons;  ///< a line for each of the first few
  void add(std::string reason);
  friend bool operator==(const SkippedFrames&, const SkippedFrames&) = default;
};

template <MaybeConst<SkippedFrames> S, class Visit>
void fields(S& skipped, Visit& v) {
  auto& [count, reasons] = skipped;
  v("frames", count);
  v("reasons", reasons);
}

/// Thrown for a frame that cannot be shown to any system.
struct UnusableFrame : InputError {
  using InputError::InputError;
};

/// If none of this many frames at the start is usable, the recording is rejected.
inline constexpr std::size_t kHopeless = 10;

/// Returns frame i. @throws UnusableFrame if it cannot be read or does not have the camera's image
/// size.
RgbdFrame usable_frame(const Sequence& sequence, std::size_t i, RandomStream noise);

/// Marks a largest set of frames whose stamps strictly increase; of frames with equal stamps, only
/// the first can be in it. A clock that jumps for one frame costs only that frame.
std::vector<bool> increasing_stamps(const Sequence& sequence);

/// Why increasing_stamps() leaves out frame i.
std::string stamp_fault(const Sequence& sequence, std::size_t i);

/// The frames of a sequence that can be shown; records why the other frames cannot.
class UsableFrames {
 public:
  explicit UsableFrames(const Sequence& sequence)
      : sequence_(sequence), has_stamp_(increasing_stamps(sequence)) {}

  /// Returns frame i; nullopt if it cannot be shown.
  /// @throws InputError if none of the first kHopeless requested frames can be shown.
  std::optional<RgbdFrame> frame(std::size_t i, RandomStream noise);
  /// Call this after the last frame. @throws InputError if frames were requested and none could be
  /// shown.
  void require_any() const;
  const SkippedFrames& skipped() const { return skipped_; }

 private:
  void skip(const std::string& reason);

  const Sequence& sequence_;
  std::vector<bool> has_stamp_;
  bool any_shown_ = false;
  SkippedFrames skipped_;
};

/// Reads the first kHopeless frames of a recording until one can be used.
/// @throws the first frame's InputError if none can be used.
void require_usable_frames(const Sequence& sequence);

}  // namespace mh
