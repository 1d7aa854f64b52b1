// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

namespace mh {

/// A folder that we may remove: a real folder (not a link) with our marker file, which stays locked
/// while in use.
class OwnedFolder {
 public:
  OwnedFolder() = default;
  OwnedFolder(OwnedFolder&&) noexcept;
  OwnedFolder& operator=(OwnedFolder&&) = delete;
  /// Releases the lock, but does not remove the folder.
  ~OwnedFolder();

  /// Creates the folder, whose parent must exist; nullopt if the name is already taken.
  /// @throws as throw_unwritable()
  static std::optional<OwnedFolder> make(const std::filesystem::path& folder);
  /// Takes over a folder of ours that is not in use; nullopt if there is none with this path.
  static std::optional<OwnedFolder> take(const std::filesystem::path& folder);

  const std::filesystem::path& path() const { return path_; }
  /// Removes the folder with its contents. Links are not followed.
  void remove();

  static constexpr const char* kMarker = ".modelhouse-work";

 private:
  std::filesystem::path path_;
  int marker_ = -1;  ///< open and locked
};

/// Keeps other processes out of a folder that this one works in, until it is destroyed or the
/// process ends. Nothing is written there. On a file system without locks, no process is kept out.
class FolderHold {
 public:
  /// Holds nothing yet. @pre the folder exists when it is taken or joined
  explicit FolderHold(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~FolderHold();
  FolderHold(const FolderHold&) = delete;
  FolderHold& operator=(const FolderHold&) = delete;

  /// Keeps all others out. @throws InputError if another process holds the folder.
  void take();
  /// Keeps all processes out except those that do the same work.
  /// @param begin    records the work in the folder; called if no other process holds it
  /// @param is_same  whether the recorded work is this one; called if others hold it
  /// @throws InputError if others do different work there.
  void join(const std::function<void()>& begin, const std::function<bool()>& is_same);

 private:
  bool lock(int how);  ///< like flock(); false if another process holds it

  std::filesystem::path folder_;
  int descriptor_ = -1;
};

/// Removes the temporary folders that killed processes of this host left in a parent folder.
void remove_abandoned_folders(const std::filesystem::path& parent);

/// A hidden folder that is removed at the end of its scope; one left behind by a killed process is
/// removed when the same host next creates one in the same parent.
class TemporaryFolder {
 public:
  /// @throws as make_output_folder()
  explicit TemporaryFolder(const std::filesystem::path& parent);
  ~TemporaryFolder() { folder_.remove(); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  OwnedFolder folder_;
};

}  // namespace mh
