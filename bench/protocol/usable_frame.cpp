// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/usable_frame.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "slam/core/trajectory_io.hpp"
#include "slam/io/read_record.hpp"

namespace mh {

void SkippedFrames::add(std::string reason) {
  ++count;
  if (reasons.size() < kReasonsKept) reasons.push_back(std::move(reason));
}

RgbdFrame usable_frame(const Sequence& sequence, std::size_t i, RandomStream noise) {
  RgbdFrame frame = [&] {
    try {
      return sequence.frame(i, noise);
    } catch (const InputChanged&) {
      throw;  // ends the run
    } catch (const InputError& error) {
      throw UnusableFrame(error.what());
    }
  }();
  const Camera& camera = sequence.camera();
  const auto fits = [&](const auto& image) {
    return image.width() == camera.width_px && image.height() == camera.height_px;
  };
  if (!fits(frame.color) || !fits(frame.depth_m))
    throw UnusableFrame(fmt::format("frame {}: is {} x {}, the camera has {} x {}", i,
                                    frame.color.width(), frame.color.height(), camera.width_px,
                                    camera.height_px));
  return frame;
}

std::vector<bool> increasing_stamps(const Sequence& sequence) {
  // Longest increasing subsequence: of all increasing subsequences of length n + 1 so far,
  // `ends[n]` is the last frame of the one that ends with the smallest stamp; `before[i]` is the
  // predecessor of frame i.
  constexpr std::size_t kNone = SIZE_MAX;
  std::vector<std::size_t> ends, before(sequence.size(), kNone);
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const auto place = std::ranges::lower_bound(
        ends, sequence.stamp_ns(i), {}, [&](std::size_t end) { return sequence.stamp_ns(end); });
    if (place != ends.begin()) before[i] = *std::prev(place);
    if (place == ends.end())
      ends.push_back(i);
    else if (sequence.stamp_ns(*place) > sequence.stamp_ns(i))
      *place = i;
  }
  std::vector<bool> increasing(sequence.size(), false);
  for (std::size_t i = ends.empty() ? kNone : ends.back(); i != kNone; i = before[i])
    increasing[i] = true;
  return increasing;
}

std::string stamp_fault(const Sequence& sequence, std::size_t i) {
  return fmt::format("frame {}: its stamp, {} s, is out of order with its neighbors'", i,
                     format_stamp(sequence.stamp_ns(i)));
}

std::optional<RgbdFrame> UsableFrames::frame(std::size_t i, RandomStream noise) {
  if (!has_stamp_[i]) {  // a bad stamp is no evidence that the frames cannot be read
    skipped_.add(stamp_fault(sequence_, i));
    return std::nullopt;
  }
  try {
    RgbdFrame shown = usable_frame(sequence_, i, noise);
    any_shown_ = true;
    return shown;
  } catch (const UnusableFrame& error) {
    skip(error.what());
    return std::nullopt;
  }
}

void UsableFrames::require_any() const {
  if (!any_shown_ && skipped_.count > 0) throw InputError(skipped_.reasons.front());
}

void UsableFrames::skip(const std::string& reason) {
  skipped_.add(reason);
  if (skipped_.count == kHopeless) require_any();
}

void require_usable_frames(const Sequence& sequence) {
  std::string first_fault = "the recording has no frame";
  for (std::size_t i = 0; i < std::min(kHopeless, sequence.size()); ++i) {
    try {
      usable_frame(sequence, i, RandomStream());
      return;
    } catch (const UnusableFrame& error) {
      if (i == 0) first_fault = error.what();
    }
  }
  throw InputError(first_fault);
}

}  // namespace mh
