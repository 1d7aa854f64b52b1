// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "sim/sensors/shutter.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// Where processes that need the same images share them.
struct SharedImages {
  std::filesystem::path folder;   ///< created if missing; empty: every process makes its own images
  std::uint64_t limit_bytes = 0;  ///< limit for all files in it and its subfolders
  /// Images with one of these noises are shared there, too.
  std::vector<RandomStream> noises = {};
};

/// Name of the subfolder for images with these noises.
/// @pre at least one noise
std::string folder_of(const std::vector<RandomStream>& noises);

/// The exposures of one path, made once for all processes that need them: the first one to need an
/// exposure makes it and writes it into a file, the others read it. An exposure that is missing or
/// damaged there is made again: the file saves time and never changes a bit.
///
/// Nothing is written beyond the limit, nor once the disk has less than kLeaveFree_bytes left. If
/// another process is making the exposure that this one needs, this one makes an exposure that both
/// will need next or, if there is none, waits.
class SharedExposures {
 public:
  using Make = std::function<Shutter::Exposed(std::size_t)>;

  /// @param name    names the file, which may be in subfolders; identifies scene, camera, path,
  ///                sensors and, if the exposures include it, noise
  /// @param camera  camera of the exposures
  /// @param frames  number of frames of the path
  SharedExposures(SharedImages where, const std::string& name, const Camera& camera,
                  std::size_t frames);
  ~SharedExposures();
  SharedExposures(const SharedExposures&) = delete;
  SharedExposures& operator=(const SharedExposures&) = delete;

  /// Returns make(i), or the same bits as another process left them.
  /// @param make  a pure function; may be called for other frames, too
  Shutter::Exposed get(std::size_t i, const Make& make);

  static constexpr std::uint64_t kLeaveFree_bytes = std::uint64_t{2} << 30;

 private:
  class FrameLock;
  std::optional<Shutter::Exposed> read(std::size_t i) const;
  bool is_there(std::size_t i) const;
  bool has_room() const;
  void write(std::size_t i, const Shutter::Exposed& exposed);
  bool make_ahead(std::size_t i, std::size_t step, const Make& make);

  SharedImages where_;
  std::filesystem::path file_;
  int width_, height_;
  std::size_t frames_;
  int file_descriptor_ = -1;    // reads anywhere, writes entries
  int append_descriptor_ = -1;  // writes records
  std::mutex writing_;
  std::atomic<bool> writable_ = false;
  std::atomic<std::size_t> last_ = 0;  // the frame of the last call
};

}  // namespace mh
