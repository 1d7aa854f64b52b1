// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "scenes/recordings/messages/message_writer.hpp"

namespace mh::cli {

/// Options of commands that write ROS messages: which file to write, and how to compress its
/// chunks.
struct RosOption {
  std::string compression = "none";

  void add_to(CLI::App& command);
  /// @throws InputError if the format does not support the compression.
  void check(const std::string& format) const;
  /// @param format  "mcap" or "rosbag"
  std::unique_ptr<MessageWriter> open(const std::string& format,
                                      const std::filesystem::path& folder) const;
};

/// Whether a format is a file of ROS messages.
bool is_ros_format(const std::string& format);

/// The last part of a folder's path, which names the files in it.
std::string name_of_folder(const std::filesystem::path& folder);

/// FOLDER/NAME.mcap or .bag.
std::filesystem::path ros_file(const std::string& format, const std::filesystem::path& folder);

}  // namespace mh::cli
