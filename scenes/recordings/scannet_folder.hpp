// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/sequence_writer.hpp"
#include "scenes/scannet/recording.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// A ScanNet recording as a sequence: a .sens file, a folder that contains one, or an extracted
/// folder (see open_recording). Frames are those of the depth camera: each of its pixels takes the
/// color that the color camera saw there, so that depths stay as measured; the color image is first
/// downsampled by averaging to the resolution of the depth image. Labels come from label-filt next
/// to the recording, through the label table. The ground truth omits invalid frames; SLAM receives
/// their images like any others, since they are intact.
/// @param notes  where to append what could not be used, one line per item
/// @throws InputError naming file and place.
std::unique_ptr<Sequence> open_scannet(const std::filesystem::path& path,
                                       std::vector<std::string>& notes);

/// ScanNet's layouts. The calibration is the recording's own; a class map replaces the label table.
/// The scene type is that of NAME.txt next to the frames, where NAME is the folder's or the .sens
/// file's.
extern const SequenceReader kScannetReader;

/// Units per meter of the 16-bit depth that is written.
inline constexpr double kScannetDepthPerMeter = 1000;

/// A depth in these units; 0 (none) beyond 65.5 m or if it is not a number.
std::uint16_t millimeters(float depth_m);

/// The recording's entry for a camera whose frame is that of the device.
RecordedLens recorded_lens(const Camera& camera);

/// Writes a recording as ScanNet releases one: NAME.sens, NAME_2d-label-filt.zip (our class ids as
/// raw category ids), NAME_2d-instance-filt.zip and the label table that defines these ids; NAME is
/// the folder's. The same camera serves as color and as depth camera; depth beyond 65.5 m is
/// dropped. Each file appears when it is complete; leftovers of a killed process are removed.
/// @param frame_at  called once per index, in order
/// @throws InputError if it cannot be written.
void write_scannet_recording(const std::filesystem::path& folder, const Camera& camera,
                             std::size_t frames,
                             const std::function<ExactFrame(std::size_t index)>& frame_at);

}  // namespace mh
