// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace mh {

/// Files that no sound program wrote, and the command that is given them.
struct HostileCase {
  std::string name;
  /// Content by name; a name ending in | is a pipe, one in + has 100 GB of nothing behind it.
  std::map<std::string, std::string> files;
  std::string arguments;  ///< {} stands for the folder of the files
  std::string says;     ///< part of the one line that refuses it, or of the warning that passes it
  bool passes = false;  ///< it can be lived with: exit code 0
};

/// Cases of scenes, robots, plans, recordings, vocabularies, maps and results.
std::vector<HostileCase> hostile_scenes();
std::vector<HostileCase> hostile_worlds();
std::vector<HostileCase> hostile_recordings();
std::vector<HostileCase> hostile_settings();
/// Sound files of every kind with bytes changed by chance; the same for the same seed.
std::vector<HostileCase> damaged_files(std::uint64_t seed);

// What the makers share.
std::string repeated(const std::string& text, std::size_t count);
template <class T>
std::string raw(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
/// A PNG whose header announces such images, with these bytes as its data before compression.
std::string png(std::uint32_t width, std::uint32_t height, int bits, int color_type,
                const std::string& rows);
/// The header of a PLY of three vertices and one face.
std::string ply_header(const std::string& format, const std::string& vertices = "3",
                       const std::string& faces = "1");
std::string triangle_ply();
std::string gltf(const std::string& nodes, const std::string& scene_nodes = "0",
                 const std::string& more = "");
std::string glb(const std::string& json);
std::string dae(const std::string& nodes, const std::string& libraries = "");
std::string world(const std::string& content);

}  // namespace mh
