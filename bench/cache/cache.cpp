// SPDX-License-Identifier: Apache-2.0
#include "bench/cache/cache.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "bench/protocol/digest.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "MHCACHE1";
constexpr std::size_t kHead = kMagic.size() + 2 * sizeof(std::uint64_t);

std::string pack(std::string_view content) {
  const std::uint64_t head[2] = {content.size(), digest_bytes(content.data(), content.size())};
  std::string packed(kMagic);
  packed.append(reinterpret_cast<const char*>(head), sizeof head);
  return packed.append(content);
}

/// nullopt where the file is missing, cut short or damaged.
std::optional<std::string> unpack(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  std::string packed;
  try {
    packed = read_file(file);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  std::uint64_t head[2] = {};
  if (packed.size() < kHead || !packed.starts_with(kMagic)) return std::nullopt;
  std::memcpy(head, packed.data() + kMagic.size(), sizeof head);
  packed.erase(0, kHead);
  if (packed.size() != head[0] || digest_bytes(packed.data(), packed.size()) != head[1])
    return std::nullopt;
  return packed;
}

/// Held while an entry is made; waits for another process that holds it.
class EntryLock {
 public:
  explicit EntryLock(const fs::path& file)
      : descriptor_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    if (descriptor_ >= 0) flock(descriptor_, LOCK_EX);
  }
  ~EntryLock() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  EntryLock(const EntryLock&) = delete;
  EntryLock& operator=(const EntryLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace

Cache::Cache(fs::path folder, std::uintmax_t max_bytes)
    : folder_(std::move(folder)), max_bytes_(max_bytes) {}

fs::path Cache::default_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache == '/') return fs::path(cache) / "modelhouse";
  const char* home = std::getenv("HOME");
  if (home != nullptr && *home == '/') return fs::path(home) / ".cache" / "modelhouse";
  return {};
}

std::string Cache::why_unwritable() const {
  constexpr std::size_t kProbe_bytes = 1 << 20;
  std::error_code error;
  fs::create_directories(folder_, error);
  const fs::path probe = folder_ / fmt::format("probe-{}", getpid());
  try {
    write_atomically(probe, std::string(kProbe_bytes, '\0'));
  } catch (const std::exception& e) {
    return e.what();
  }
  fs::remove(probe, error);
  return {};
}

std::string Cache::get(std::string_view kind, std::string_view key,
                       const std::function<std::string()>& make) const {
  std::error_code error;
  if (folder_.empty()) return make();
  const fs::path file = folder_ / kind / key;
  fs::create_directories(file.parent_path(), error);
  fs::create_directories(folder_ / "locks", error);
  // A bounded number of lock files: two entries may share one, which costs a wait at worst.
  const EntryLock lock(folder_ / "locks" / fmt::format("{}-{}", kind, key.substr(0, 2)));
  if (auto content = unpack(file)) {
    fs::last_write_time(file, fs::file_time_type::clock::now(), error);
    return *std::move(content);
  }
  std::string content = make();
  try {
    write_atomically(file, pack(content));
    keep_within_bounds();
  } catch (const std::exception&) {
    // Nothing is kept then; the work goes on.
  }
  return content;
}

void Cache::keep_within_bounds() const {
  struct Entry {
    fs::file_time_type read;
    fs::path file;
    std::uintmax_t bytes;
  };
  std::vector<Entry> entries;
  std::uintmax_t all = 0;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder_, error)) {
    if (!entry.is_regular_file(error) || entry.path().parent_path().filename() == "locks") continue;
    entries.push_back({entry.last_write_time(error), entry.path(), entry.file_size(error)});
    all += entries.back().bytes;
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.read != b.read ? a.read < b.read : a.file < b.file;
  });
  for (const Entry& entry : entries) {
    if (all <= max_bytes_) return;
    if (fs::remove(entry.file, error)) all -= entry.bytes;
  }
}

}  // namespace mh
