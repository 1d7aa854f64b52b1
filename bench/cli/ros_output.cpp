// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/ros_output.hpp"

#include <system_error>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMcap = "mcap";
constexpr const char* kBag = "rosbag";

}  // namespace

void RosOption::add_to(CLI::App& command) {
  command
      .add_option("--chunk-compression", compression,
                  "Compression of mcap and rosbag: none, lz4 or (only mcap) zstd; does not change "
                  "any message")
      ->check(one_of_words({"none", "lz4", "zstd"}));
}

void RosOption::check(const std::string& format) const {
  if (compression != "none" && !is_ros_format(format))
    throw InputError(
        fmt::format("--chunk-compression {}: is for the formats mcap and rosbag", compression));
  if (compression == "zstd" && format == kBag)
    throw InputError("--chunk-compression zstd: a ROS 1 bag has none or lz4");
}

std::unique_ptr<MessageWriter> RosOption::open(const std::string& format,
                                               const fs::path& folder) const {
  const ChunkCompression how = compression == "lz4"    ? ChunkCompression::kLz4
                               : compression == "zstd" ? ChunkCompression::kZstd
                                                       : ChunkCompression::kNone;
  const fs::path file = ros_file(format, folder);
  return format == kMcap ? write_mcap(file, how) : write_bag(file, how);
}

bool is_ros_format(const std::string& format) {
  return format == kMcap || format == kBag;
}

std::string name_of_folder(const fs::path& folder) {
  std::error_code error;  // an empty name is refused when the folder is made
  const fs::path full = fs::absolute(folder, error).lexically_normal();
  return (full.has_filename() ? full : full.parent_path()).filename().string();
}

fs::path ros_file(const std::string& format, const fs::path& folder) {
  return folder / (name_of_folder(folder) + (format == kMcap ? ".mcap" : ".bag"));
}

}  // namespace mh::cli
