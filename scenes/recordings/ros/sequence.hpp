// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenes/recordings/messages/message_file.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/io/held_bytes.hpp"

namespace mh {

/// ROS 1 bags and MCAP files: a file, or a folder with one file or with the parts of one recording.
/// Topics are found by type and encoding, or named by the user (RecordingConfig::topics);
/// calibration comes from CameraInfo unless a file is specified. Color images are paired with the
/// nearest depth image in time, as in TUM's layout.
extern const SequenceReader kBagReader, kMcapReader;

/// open_bag() or open_mcap().
using OpenMessages = std::unique_ptr<MessageFile> (*)(HeldBytes, const std::string&,
                                                      const MessageFile::Visit&);

/// The content of a bag or MCAP file, and the name by which messages to the user refer to it.
struct MessageBytes {
  std::string name;
  HeldBytes content;
};

/// Opens bag or MCAP files that are the parts of one recording.
/// @param name  names the recording in messages
/// @throws InputError naming file and topic.
OpenedRecording open_messages(OpenMessages open, const std::vector<MessageBytes>& parts,
                              const std::string& name, const RecordingConfig& config);

}  // namespace mh
