// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace mh {

/// What is dear to make and small to keep, addressed by what it was made from. An entry is written
/// to a temporary and renamed, checked by a digest when it is read and made anew where it is
/// damaged. Several processes may use one folder: who asks for an entry that another is making
/// waits for it.
///
/// Owns only what it wrote: all of it lies in a folder of its own within the one that is named,
/// under a marker; what there has no name or no beginning of an entry is left alone, and no link
/// is followed.
class Cache {
 public:
  /// @param folder     made where it is missing, may hold other things; empty: nothing is kept
  /// @param max_bytes  what was not read for the longest time is removed beyond this
  explicit Cache(std::filesystem::path folder = {}, std::uintmax_t max_bytes = kDefaultBytes);

  /// The entry of that kind and key. A cache that cannot be written (a full disk, no permission)
  /// costs time, never the work: the entry is made and handed out.
  /// @param kind  fit for a folder: "light"
  /// @param key   hexadecimal digest of everything that decides the entry, code included
  std::string get(std::string_view kind, std::string_view key,
                  const std::function<std::string()>& make) const;

  const std::filesystem::path& folder() const { return folder_; }
  /// $XDG_CACHE_HOME/modelhouse, else ~/.cache/modelhouse; empty where neither is known.
  static std::filesystem::path default_folder();
  /// Why nothing can be kept: a folder that cannot be written, a full disk, one of its own's name
  /// that is somebody else's. Empty if it can.
  std::string why_unwritable() const;

  static constexpr std::uintmax_t kDefaultBytes = std::uintmax_t{4} << 30;
  static constexpr const char* kOwnFolder = "modelhouse-cache";

 private:
  /// Makes it where it is missing. @throws InputError if it cannot be, or is not the cache's.
  std::filesystem::path own_folder() const;
  void keep_within_bounds(const std::filesystem::path& own) const;

  std::filesystem::path folder_;
  std::uintmax_t max_bytes_;
};

}  // namespace mh
