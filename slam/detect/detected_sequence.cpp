// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/detected_sequence.hpp"

#include <utility>

#include <fmt/format.h>
#include <xxhash.h>

namespace mh {

Detected detect_kept(const Detector& detector, const RgbdFrame& frame, std::size_t index,
                     const KeepDetections& keep) {
  const auto detect = [&] { return detector.detect(frame.color, index, frame.stamp_ns); };
  if (keep == nullptr || detector.digest() == 0) return detect();
  const int size[2] = {frame.color.width(), frame.color.height()};
  const std::uint64_t seed = XXH3_64bits_withSeed(size, sizeof size, detector.digest());
  const XXH128_hash_t image =
      XXH3_128bits_withSeed(frame.color.data(), frame.color.size() * sizeof(Rgb8), seed);
  return decode_detected(keep(fmt::format("{:016x}{:016x}", image.high64, image.low64),
                              [&] { return encode(detect()); }));
}

DetectedSequence::DetectedSequence(std::shared_ptr<const Sequence> inner,
                                   std::shared_ptr<const Detector> detector, BoxFill fill,
                                   KeepDetections keep)
    : inner_(std::move(inner)),
      detector_(std::move(detector)),
      fill_(fill),
      keep_(std::move(keep)) {}

RgbdFrame DetectedSequence::frame(std::size_t i, RandomStream noise) const {
  RgbdFrame frame = inner_->frame(i, noise);
  frame.semantics = labels_of(detect_kept(*detector_, frame, i, keep_), frame.depth_m,
                              frame.color.width(), frame.color.height(), fill_);
  return frame;
}

}  // namespace mh
