// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "slam/core/temporary_folder.hpp"

namespace mh {

/// The folder that an outside program is told of: for its dataset and for what it writes. It is new
/// for each run and lies in none that holds results, so that the program meets neither the truth
/// nor what an earlier run left. In the end it is moved into the run's folder, as `outside`.
///
/// What an earlier run had left there goes first: the files that it held when it was moved, as far
/// as nobody has changed them. Where something else lies there, that stays, and the new one becomes
/// `outside.2`, and so on.
class ProgramFolder {
 public:
  /// @param run  exists; the program is never told of it
  explicit ProgramFolder(const std::filesystem::path& run);
  /// Moves it as well, if it can.
  ~ProgramFolder();
  ProgramFolder(const ProgramFolder&) = delete;
  ProgramFolder& operator=(const ProgramFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void move_to_run();

  static constexpr const char* kList = ".modelhouse-files";

 private:
  const std::filesystem::path run_;
  const TemporaryFolder work_;
  const std::filesystem::path path_;
};

}  // namespace mh
