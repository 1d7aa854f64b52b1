// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace mh {

/// A cache of results that are expensive to compute and small to store, addressed by a digest of
/// their inputs. An entry is written to a temporary file and renamed, verified by a digest when it
/// is read, and rebuilt if it is damaged. Several processes may share one folder: a process that
/// requests an entry while another one is building it waits for that one.
///
/// Owns only what it wrote: everything is in its own subfolder of the given folder, which contains
/// a marker file. Files there whose name or header is not an entry's are left alone, and links are
/// not followed.
class Cache {
 public:
  /// @param folder     created if missing, may contain other files; empty: nothing is cached
  /// @param max_bytes  beyond this, the least recently read entries are removed
  explicit Cache(std::filesystem::path folder = {}, std::uintmax_t max_bytes = kDefaultBytes);

  /// Returns the entry of that kind and key. A cache that cannot be written (full disk, no
  /// permission) costs time but never fails the work: the entry is computed and returned.
  /// @param kind  valid as a folder name: "light"
  /// @param key   hexadecimal digest of everything that determines the entry, code included
  std::string get(std::string_view kind, std::string_view key,
                  const std::function<std::string()>& make) const;

  const std::filesystem::path& folder() const { return folder_; }
  /// $XDG_CACHE_HOME/modelhouse, else ~/.cache/modelhouse; empty where neither is known.
  static std::filesystem::path default_folder();
  /// Why nothing can be cached: the folder cannot be written, the disk is full, or the subfolder's
  /// name is taken by something else. Empty if entries can be cached.
  std::string why_unwritable() const;

  static constexpr std::uintmax_t kDefaultBytes = std::uintmax_t{4} << 30;
  static constexpr const char* kOwnFolder = "modelhouse-cache";

 private:
  /// Returns the cache's own subfolder; creates it if missing. @throws InputError if it cannot be
  /// created, or if a folder of that name is not the cache's.
  std::filesystem::path own_folder() const;
  /// Removes the least recently read entries beyond max_bytes. Looks at the entries only after a
  /// fraction of max_bytes has been written since the last look.
  void keep_within_bounds(const std::filesystem::path& own, std::uintmax_t written_bytes) const;

  std::filesystem::path folder_;
  std::uintmax_t max_bytes_;
  // Bytes written since the last look; shared by copies of this object.
  std::shared_ptr<std::atomic<std::uintmax_t>> unseen_bytes_;
};

}  // namespace mh
