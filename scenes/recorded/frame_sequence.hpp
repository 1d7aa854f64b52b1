// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "scenes/recorded/tum_folder.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Frames in the order in which they were taken, wherever they come from: a recorded folder, a
/// scene driven through. Equal indices give equal bits. The stamps of a faulty recording may go
/// back.
class FrameSequence {
 public:
  virtual ~FrameSequence() = default;

  virtual const Camera& camera() const = 0;
  virtual std::size_t size() const = 0;
  virtual Stamp stamp_ns(std::size_t index) const = 0;
  /// @throws InputError if this frame cannot be had; others may.
  virtual RgbdFrame frame(std::size_t index) const = 0;
  /// Where the cameras really were, where that is known.
  virtual std::optional<Trajectory> truth() const = 0;
};

/// A folder in TUM's layout, seen by that camera.
/// @param notes  gets what was left out, a line each; may be null
/// @throws InputError naming file and line.
std::unique_ptr<FrameSequence> open_tum_folder(const std::filesystem::path& folder,
                                               const RecordedCamera& camera,
                                               std::vector<std::string>* notes = nullptr);

/// Frames that lie in memory.
std::unique_ptr<FrameSequence> frames_in_memory(const Camera& camera,
                                                std::vector<RgbdFrame> frames);

}  // namespace mh
