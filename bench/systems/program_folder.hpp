// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "slam/io/temporary_folder.hpp"

namespace mh {

/// How deep folders in a program's folder may nest: the cost of a path grows with the number of its
/// parts.
inline constexpr int kDeepestFolder = 100;

/// The folder given to an outside program, for its dataset and its output. It is new for each run
/// and below TMPDIR (/var/tmp if that is not set), not below a folder with results, so that the
/// program finds neither the ground truth nor the remains of an earlier run. At the end it is moved
/// into the run's folder, as `outside`.
///
/// Before that, the remains of an earlier run are removed from `outside`: the files that it
/// contained when it was moved, unless they have changed since. If `outside` contains anything
/// else, it is kept, and the new folder becomes `outside.2`, and so on.
class ProgramFolder {
 public:
  /// @param run  the run's folder, which exists; the program never learns its path
  explicit ProgramFolder(const std::filesystem::path& run);
  /// Also moves the folder, if possible.
  ~ProgramFolder();
  ProgramFolder(const ProgramFolder&) = delete;
  ProgramFolder& operator=(const ProgramFolder&) = delete;

  /// Where such folders are made: not below a folder that holds results, and with room for images.
  static std::filesystem::path place();

  const std::filesystem::path& path() const { return path_; }
  void move_to_run();

  static constexpr const char* kList = ".modelhouse-files";

 private:
  const std::filesystem::path run_;
  const TemporaryFolder work_;
  const std::filesystem::path path_;
  const std::string identity_;  ///< of the folder, which the program could replace
};

}  // namespace mh
