// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace mh {

/// Files that no correct program wrote, and the command that has to read them.
struct HostileCase {
  std::string name;
  /// Content by file name; a name ending in | makes a pipe, one ending in + gets 100 GB of zeros
  /// appended.
  std::map<std::string, std::string> files;
  std::string arguments;  ///< {} stands for the folder of the files
  std::string says;       ///< part of the one-line error, or of the warning if the file is accepted
  bool passes = false;    ///< the file is accepted: exit code 0
};

/// Cases for scenes, robots, plans, recordings, vocabularies, maps and results.
std::vector<HostileCase> hostile_scenes();
std::vector<HostileCase> hostile_worlds();
std::vector<HostileCase> hostile_recordings();
std::vector<HostileCase> hostile_settings();
/// Valid files of every kind with randomly changed bytes; the same seed gives the same files.
std::vector<HostileCase> damaged_files(std::uint64_t seed);

// Shared by the functions that make cases.
std::string repeated(const std::string& text, std::size_t count);
template <class T>
std::string raw(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
/// A PNG whose header declares this size and format, with `rows` as its data before compression.
std::string png(std::uint32_t width, std::uint32_t height, int bits, int color_type,
                const std::string& rows);
/// The header of a PLY file with three vertices and one face.
std::string ply_header(const std::string& format, const std::string& vertices = "3",
                       const std::string& faces = "1");
std::string triangle_ply();
std::string gltf(const std::string& nodes, const std::string& scene_nodes = "0",
                 const std::string& more = "");
std::string glb(const std::string& json);
std::string dae(const std::string& nodes, const std::string& libraries = "");
std::string world(const std::string& content);

}  // namespace mh
