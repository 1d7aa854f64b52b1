// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/recordings/tum_folder.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// How to open a recording.
struct RecordingConfig {
  std::filesystem::path calibration;  ///< a file; empty: the one next to the frames, or stored with
                                      ///< them
  std::filesystem::path classes;      ///< class map of its labels; empty: the ids are our classes
  bool labels = true;                 ///< false: ignore labels
  /// Topics of a bag or MCAP file, "color=/a,depth=/b"; empty: found by type.
  std::string topics = {};
  /// Reads every file, images included. Open ReadScopes then receive a single observation, the
  /// digest of all files, and the list of these files (kHeld).
  bool whole = false;
  /// Reads a calibration file, for layouts that keep one. @throws InputError
  std::function<RecordedCamera(const std::filesystem::path&)> read_camera = {};
  /// Whether a calibration file defines a camera. If so, it replaces the one that the recording
  /// stores, in layouts that store one.
  std::function<bool(const std::filesystem::path&)> has_camera = {};
  /// The value of a depth pixel at one meter, if a calibration file states it.
  std::function<std::optional<double>(const std::filesystem::path&)> depth_per_meter = {};
};

/// An opened recording.
struct OpenedRecording {
  std::unique_ptr<Sequence> sequence;
  bool has_labels = false;                   ///< it contains labels, whether used or not
  std::vector<std::filesystem::path> files;  ///< files that frames are read from on demand
  std::vector<std::string> notes;            ///< what could not be used, one line per item
  /// Files with the color images: one per frame, or one for all.
  std::vector<std::filesystem::path> images;
  /// Digests of the contents of `images`, sorted, whatever their names: copies of a recording share
  /// them. Empty unless RecordingConfig::whole.
  std::vector<std::uint64_t> image_digests;
};

/// A recording layout. To add one, see docs/recordings.md.
struct SequenceReader {
  const char* name;   ///< the prefix in LAYOUT:PATH: "tum"
  const char* place;  ///< what follows it: "FOLDER"
  /// Whether a path without a layout prefix looks like this layout. Does not throw.
  bool (*recognizes)(const std::filesystem::path&);
  /// @throws InputError naming file and place.
  OpenedRecording (*open)(const std::filesystem::path&, const RecordingConfig&);
  /// The data set's name for the kind of place ("Bedroom / Hotel"), "" if the recording has none;
  /// null for layouts that never have one.
  std::string (*scene_type)(const std::filesystem::path&);
  bool has_topics = false;  ///< RecordingConfig::topics applies
  /// Whether a recording is always a folder.
  bool is_of_folders() const { return std::string_view(place) == "FOLDER"; }
};

/// Every layout, in the order in which they are tried on a path.
std::span<const SequenceReader* const> sequence_readers();

/// Every accepted form, for messages: "tum:FOLDER, scannet:FOLDER, ...".
std::string sequence_forms();

/// Splits a recording's name into the layout ("" if none is named) and the path.
/// "C:house" names no layout: it is a path.
std::pair<std::string, std::filesystem::path> split_sequence(const std::string& source);
/// The inverse: joins a layout and a path into a name.
std::string join_sequence(const std::string& layout, const std::filesystem::path& path);

/// Removes a recording's path from the start of a message: a result must not depend on where the
/// recording is stored, and the cache also serves copies of the recording that are stored
/// elsewhere.
std::string without_place(const std::string& message, const std::string& source);

/// The layout of a recording: the one in its name, otherwise the one recognized from the files at
/// its path.
/// @throws InputError if it is neither named nor recognized.
const SequenceReader& reader_of(const std::string& source);

/// Opens a recording, "LAYOUT:PATH" or a path whose layout is recognized.
/// @throws InputError naming file and place.
OpenedRecording open_sequence(const std::string& source, const RecordingConfig& config);

/// Returns a message if the ground truth has poses but none near the time of any frame; otherwise
/// "".
std::string truth_of_another_time(const Sequence& frames, const Trajectory& truth);

}  // namespace mh
