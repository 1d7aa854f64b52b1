// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace mh {

/// A folder that is ours to remove: a true folder (no link) that holds our marker, which is locked
/// while somebody works in it.
class OwnedFolder {
 public:
  OwnedFolder() = default;
  OwnedFolder(OwnedFolder&&) noexcept;
  OwnedFolder& operator=(OwnedFolder&&) = delete;
  /// Lets go of it; it stays.
  ~OwnedFolder();

  /// Makes the folder, which must not be there; its parent must. nullopt if anything of its name
  /// is.
  /// @throws as throw_unwritable()
  static std::optional<OwnedFolder> make(const std::filesystem::path& folder);
  /// Takes one that nobody holds; nullopt if there is none of that name that is ours.
  static std::optional<OwnedFolder> take(const std::filesystem::path& folder);

  const std::filesystem::path& path() const { return path_; }
  /// With all that is in it. No link is followed.
  void remove();

  static constexpr const char* kMarker = ".modelhouse-work";

 private:
  std::filesystem::path path_;
  int marker_ = -1;  ///< open and locked
};

/// A hidden folder that goes when it is left; one that a killed process left goes with the next in
/// the same parent, by the same host.
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
