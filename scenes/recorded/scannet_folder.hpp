// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenes/recorded/open_sequence.hpp"
#include "scenes/recorded/sequence_writer.hpp"
#include "scenes/scannet/recording.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// A ScanNet recording as a sequence: a .sens file, the folder of one, or an extracted folder (see
/// open_recording). Frames are those of the depth camera: each of its pixels takes the color that
/// the color camera saw there, so that depths stay as measured; the color picture is first
/// averaged down to the depth picture's resolution. Labels come from label-filt beside the
/// recording, through the label table. The truth leaves invalid frames out; SLAM is offered them
/// like any other, for their pictures are sound.
/// @param notes  where to append what could not be used, one line each
/// @throws InputError naming file and place.
std::unique_ptr<Sequence> open_scannet(const std::filesystem::path& path,
                                       std::vector<std::string>& notes);

/// ScanNet's layouts. The calibration is their own; a class map takes the label table's place. The
/// scene type is that of NAME.txt beside the frames, NAME being the folder's or the .sens file's.
extern const SequenceReader kScannetReader;

/// Of the 16-bit depth that is written.
inline constexpr double kScannetDepthPerMeter = 1000;

/// A depth in that unit; 0, none, beyond 65.5 m or where it is no number.
std::uint16_t millimeters(float depth_m);

/// What a recording says of a camera that is the device itself.
RecordedLens recorded_lens(const Camera& camera);

/// Writes a recording as ScanNet releases one: NAME.sens, NAME_2d-label-filt.zip (our class ids as
/// raw category ids), NAME_2d-instance-filt.zip and the label table that explains them; NAME is the
/// folder's. One camera stands for both; depth beyond 65.5 m is none. Each file appears when it is
/// whole; what a process that was killed left of them is removed.
/// @param frame_at  called once per index, in order
/// @throws InputError if it cannot be written.
void write_scannet_recording(const std::filesystem::path& folder, const Camera& camera,
                             std::size_t frames,
                             const std::function<ExactFrame(std::size_t index)>& frame_at);

}  // namespace mh
