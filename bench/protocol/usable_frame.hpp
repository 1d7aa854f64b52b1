// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/error.hpp"
#include "slam/core/fields.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// Frames of a recording that no system was shown: they cannot be read, have another size than the
/// camera's, or stamps that do not increase.
struct SkippedFrames {
  static constexpr std::size_t kReasonsKept = 5;
  std::size_t count = 0;
  std::vector<std::string> reasons;  ///< of the first few, one line each
  void add(std::string reason);
  friend bool operator==(const SkippedFrames&, const SkippedFrames&) = default;
};

template <Either<SkippedFrames> S, class Visit>
void fields(S& skipped, Visit& v) {
  auto& [count, reasons] = skipped;
  v("frames", count);
  v("reasons", reasons);
}

/// A frame that no system can be shown.
struct UnusableFrame : InputError {
  using InputError::InputError;
};

/// When not one of so many frames at the start can be used, nothing is to be hoped for.
inline constexpr std::size_t kHopeless = 10;

/// Frame i. @throws UnusableFrame if it cannot be read or has another size than the camera's.
RgbdFrame usable_frame(const Sequence& sequence, std::size_t i, RandomStream noise);

/// Which frames have a stamp to be shown with: the most whose stamps increase, the earlier of equal
/// ones. So a clock that jumps for one frame costs that frame.
std::vector<bool> increasing_stamps(const Sequence& sequence);

/// Why frame i, which increasing_stamps() leaves out, is left out.
std::string stamp_fault(const Sequence& sequence, std::size_t i);

/// The frames of a sequence that can be shown; of the others it remembers why not.
class UsableFrames {
 public:
  explicit UsableFrames(const Sequence& sequence)
      : sequence_(sequence), has_stamp_(increasing_stamps(sequence)) {}

  /// Frame i; nullopt if it cannot be shown.
  /// @throws InputError when none of the first kHopeless that were asked for can be.
  std::optional<RgbdFrame> frame(std::size_t i, RandomStream noise);
  /// To be called at the end. @throws InputError if frames were asked for and none could be shown.
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
/// @throws InputError of the first if none can.
void require_usable_frames(const Sequence& sequence);

}  // namespace mh
