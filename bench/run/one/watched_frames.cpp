// SPDX-License-Identifier: Apache-2.0
#include "bench/run/one/watched_frames.hpp"

#include <utility>

#include <fmt/format.h>

#include "bench/systems/timed.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/io/error.hpp"

namespace mh {

FilesAsKeyed::FilesAsKeyed(const ReadRecord& held) {
  for (const FileObservation& o : held.observations)
    if (is_of_a_state(o)) of_.emplace(o.path, o);
}

void FilesAsKeyed::require(const ReadRecord& now) const {
  for (const FileObservation& o : now.observations) {
    const auto was = of_.find(o.path);
    if (was == of_.end() || !is_of_a_state(o)) continue;
    constexpr auto kRead = FileObservation::Kind::kRead;
    const bool same = o.kind == kRead && was->second.kind == kRead ? o.digest == was->second.digest
                                                                   : o.state == was->second.state;
    if (!same)
      throw InputChanged(fmt::format("{}: was changed while it was in use: start the command again",
                                     o.path.string()));
  }
}

WatchedFrames::WatchedFrames(const Sequence& inner, std::string recording, bool labeled,
                             const FilesAsKeyed& files, double& spent_s)
    : SequenceView(inner),
      recording_(std::move(recording)),
      labeled_(labeled),
      files_(files),
      spent_s_(spent_s) {}

RgbdFrame WatchedFrames::frame(std::size_t i, RandomStream noise) const try {
  const ProcessorTimer timer(spent_s_);
  RgbdFrame frame = checked(i, noise);
  if (!labeled_) frame.semantics = {};
  return frame;
} catch (const InputChanged&) {
  throw;
} catch (const InputError& error) {
  throw InputError(without_place(error.what(), recording_));
}

RgbdFrame WatchedFrames::checked(std::size_t i, RandomStream noise) const {
  const ReadScope reading;
  try {
    RgbdFrame frame = SequenceView::frame(i, noise);
    files_.require(reading.record());
    return frame;
  } catch (const InputError&) {
    files_.require(reading.record());  // throws if the file is unreadable because it was changed
    throw;
  }
}

RgbdFrame FramesMadeOnce::frame(std::size_t i, RandomStream noise) const {
  auto made = made_.find(noise.key());
  if (made == made_.end()) made = made_.emplace(noise.key(), SequenceView::frame(i, noise)).first;
  return made->second;
}

}  // namespace mh
