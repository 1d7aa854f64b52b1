// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/rgbd_frame.hpp"
#include "slam/detect/class_names.hpp"
#include "slam/detect/detected.hpp"
#include "slam/detect/settings.hpp"

namespace mh {

/// Finds objects in color images: a network, or a file of boxes that another program found. May be
/// called by several threads; one works at a time.
class Detector {
 public:
  virtual ~Detector() = default;
  /// Equal images give equal bits.
  /// @param index, stamp_ns  of the frame in its sequence, by which boxes in files are looked up
  virtual Detected detect(const Grid2d<Rgb8>& color, std::size_t index, Stamp stamp_ns) const = 0;
  virtual const ClassNames& names() const = 0;
  /// One line for the user: "yolox, 80 classes, input 416 x 416".
  virtual std::string description() const = 0;
  /// Checks that a box file's frames belong to this sequence, and that at least one class is one of
  /// ours.
  /// @returns a note on frames or classes that are not used, or "". @throws InputError if no frame
  /// belongs to it
  virtual std::string check_frames(std::span<const Stamp> /*stamps_ns*/) const { return ""; }
  /// Digest of everything, except the image, that determines what detect() returns; 0 if detections
  /// are not cached.
  virtual std::uint64_t digest() const = 0;
};

/// Opens a network or a file of boxes. A network is first imported and run once in a child process,
/// because OpenCV's importers can crash or exhaust the memory. Sets OpenCV to one thread, as the
/// program does: results then do not depend on the machine's load, and a forked child waits for no
/// thread.
/// @throws InputError naming the file and what is wrong with it.
std::unique_ptr<Detector> open_detector(const DetectorSpec& spec);

/// Implementations of open_detector().
std::unique_ptr<Detector> open_network(const DetectorSpec& spec);
std::unique_ptr<Detector> open_boxes(const DetectorSpec& spec);

}  // namespace mh
