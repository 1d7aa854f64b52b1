// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "scenes/instance_id.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/labels.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Compression of PNG files, 0 (none) to 9; default: 1. For costs and savings see
/// docs/measurements/rendering.md.
using PngCompression = std::optional<int>;
/// The compression as settings for write_image().
std::vector<int> png_settings(PngCompression compression);

/// A frame to record, with ground truth.
struct ExactFrame {
  RgbdFrame seen;
  Grid2d<ClassId> classes;  ///< of the same instant as `seen`, like the instances
  Grid2d<InstanceId> instances;
  SE3 world_from_camera;
};

/// Writes a sequence of frames with their ground truth into a folder. Each file is written
/// atomically. Safe to call from several threads at once; the bytes do not depend on the order.
class SequenceWriter {
 public:
  virtual ~SequenceWriter() = default;
  /// @param index  of the frame in the sequence, from 0
  virtual void add(std::size_t index, const ExactFrame& frame) = 0;
  /// Counts a frame as added without writing its images, if they all exist from an earlier run.
  /// @returns whether they do
  virtual bool resume(std::size_t index, Stamp stamp_ns, const SE3& world_from_camera) = 0;
  /// Writes the files that exist once per sequence: a folder without them is incomplete.
  virtual void finish() = 0;
};

/// Creates a writer by name: "tum" (see TumWriter) or "scannet-frames", the layout that ScanNet's
/// SensReader extracts: color/N.jpg, depth/N.png (16 bit, 1000 per meter), pose/N.txt (camera to
/// world), intrinsic/, and, as in ScanNet's 2D annotation, label-filt/N.png (16 bit, class ids) and
/// instance-filt/N.png (16 bit); scannetv2-labels.combined.tsv maps each id to its class and its
/// NYU40 class.
/// @throws InputError on any other name.
std::unique_ptr<SequenceWriter> make_sequence_writer(std::string_view format,
                                                     const std::filesystem::path& folder,
                                                     const Camera& camera,
                                                     PngCompression png_compression = {});

}  // namespace mh
