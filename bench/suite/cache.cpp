// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/cache.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "slam/core/digest.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/read_record.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "MHCACHE2";
constexpr std::size_t kHead = kMagic.size() + 2 * sizeof(std::uint64_t);

/// Digest of an entry's content and name: under a different name an entry counts as damaged.
std::uint64_t digest_of(const fs::path& file, std::string_view content) {
  const std::string name = (file.parent_path().filename() / file.filename()).string();
  return digest_bytes(content.data(), content.size(), digest_bytes(name.data(), name.size()));
}

std::string pack(const fs::path& file, std::string_view content) {
  const std::uint64_t head[2] = {content.size(), digest_of(file, content)};
  std::string packed(kMagic);
  packed.append(reinterpret_cast<const char*>(head), sizeof head);
  return packed.append(content);
}

// The Cache Directory Tagging Specification: backup programs skip such a folder.
constexpr const char* kMarker = "CACHEDIR.TAG";
constexpr std::string_view kMarkerText =
    "Signature: 8a477f597d28d172789f06886806bc55\n"
    "# The cache of modelhouse. It removes entries of its own from here, and nothing else.\n";

/// Whether this is itself a file (is_own_folder: a folder), not a link to one.
bool is_own_file(const fs::path& file) {
  std::error_code error;
  return fs::symlink_status(file, error).type() == fs::file_type::regular;
}
bool is_own_folder(const fs::path& folder) {
  std::error_code error;
  return fs::symlink_status(folder, error).type() == fs::file_type::directory;
}

bool is_key(std::string_view name) {
  return !name.empty() && name.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// A key, or the temporary name that write_atomically() derives from one (".KEY.1234.tmp").
bool is_entry_name(std::string_view name) {
  if (!name.starts_with('.')) return is_key(name);
  return name.find(".tmp") != std::string_view::npos &&
         is_key(name.substr(1, name.find('.', 1) - 1));
}

/// Whether a file starts with an entry's header.
bool has_magic(const fs::path& file) {
  std::string head(kMagic.size(), '\0');
  return is_own_file(file) &&
         std::ifstream(file, std::ios::binary)
             .read(head.data(), static_cast<std::streamsize>(head.size())) &&
         head == kMagic;
}

/// Returns an entry's content; nullopt if the file is missing, truncated, damaged or a different
/// entry.
std::optional<std::string> unpack(const fs::path& file) {
  if (!is_own_file(file)) return std::nullopt;
  const ReadScope no_input(ReadScope::Outer::kIgnores);
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
  if (packed.size() != head[0] || digest_of(file, packed) != head[1]) return std::nullopt;
  return packed;
}

/// Held while an entry is computed; if another process holds it, waits for that process.
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
    : folder_(std::move(folder)),
      max_bytes_(max_bytes),
      unseen_bytes_(std::make_shared<std::atomic<std::uintmax_t>>(max_bytes)) {}

fs::path Cache::default_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache == '/') return fs::path(cache) / "modelhouse";
  const char* home = std::getenv("HOME");
  if (home != nullptr && *home == '/') return fs::path(home) / ".cache" / "modelhouse";
  return {};
}

fs::path Cache::own_folder() const {
  if (folder_.empty()) throw InputError("no folder for a cache");
  const fs::path own = folder_ / kOwnFolder;
  std::error_code error;
  if (!fs::exists(fs::symlink_status(own, error))) {
    make_output_folder(folder_);
    // The folder is complete before it gets its name: another process sees either nothing or all of
    // it.
    std::string fresh = (folder_ / fmt::format(".{}-XXXXXX", kOwnFolder)).string();
    if (mkdtemp(fresh.data()) == nullptr) throw_unwritable(own, errno);
    fs::permissions(fresh, fs::perms::all & ~fs::perms::group_write & ~fs::perms::others_write,
                    error);
    write_atomically(fs::path(fresh) / kMarker, kMarkerText);
    if (rename(fresh.c_str(), own.c_str()) != 0) fs::remove_all(fresh, error);
  }
  if (!is_own_folder(own) || !is_own_file(own / kMarker) || read_file(own / kMarker) != kMarkerText)
    throw InputError(fmt::format("{}: is not a modelhouse cache ({} is not in it): left alone",
                                 own.string(), kMarker));
  return own;
}

std::string Cache::why_unwritable() const {
  constexpr std::size_t kProbe_bytes = 1 << 20;
  try {
    const fs::path probe = own_folder() / fmt::format("probe-{}", getpid());
    write_atomically(probe, std::string(kProbe_bytes, '\0'));
    std::error_code error;
    fs::remove(probe, error);
  } catch (const std::exception& e) {
    return e.what();
  }
  return {};
}

std::string Cache::get(std::string_view kind, std::string_view key,
                       const std::function<std::string()>& make) const {
  assert(is_key(key));
  fs::path own;
  try {
    own = own_folder();
  } catch (const std::exception&) {
    return make();
  }
  std::error_code error;
  for (const fs::path& folder : {own / kind, own / "locks"}) {
    fs::create_directory(folder, error);
    if (!is_own_folder(folder)) return make();
  }
  const fs::path file = own / kind / key;
  // A bounded number of lock files: two entries may share one, which at worst costs a wait.
  const EntryLock lock(own / "locks" / fmt::format("{}-{}", kind, key.substr(0, 2)));
  if (auto content = unpack(file)) {
    fs::last_write_time(file, fs::file_time_type::clock::now(), error);
    return *std::move(content);
  }
  std::string content = make();
  try {
    // A file without an entry's header may belong to someone else, so it is moved aside.
    const fs::path aside = file.string() + ".found";
    const bool nothing = is_own_file(file) && fs::file_size(file, error) == 0;
    if (fs::exists(fs::symlink_status(file, error)) && !has_magic(file) && !nothing) {
      if (fs::exists(fs::symlink_status(aside, error))) return content;
      fs::rename(file, aside);
    }
    write_atomically(file, pack(file, content));
    keep_within_bounds(own, content.size());
  } catch (const std::exception&) {
    // Nothing is cached then; the work continues.
  }
  return content;
}

void Cache::keep_within_bounds(const fs::path& own, std::uintmax_t written_bytes) const {
  // Looking at all entries takes longer than writing a small one.
  constexpr std::uintmax_t kParts = 64;
  *unseen_bytes_ += written_bytes;
  if (*unseen_bytes_ < max_bytes_ / kParts) return;
  *unseen_bytes_ = 0;
  struct Entry {
    fs::file_time_type read;
    fs::path file;
    std::uintmax_t bytes;
  };
  std::vector<Entry> entries;
  std::uintmax_t all = 0;
  std::error_code error;
  for (const auto& kind : fs::directory_iterator(own, error)) {
    if (!is_own_folder(kind.path())) continue;
    for (const auto& entry : fs::directory_iterator(kind.path(), error)) {
      if (!is_entry_name(entry.path().filename().string()) || !has_magic(entry.path())) continue;
      entries.push_back({entry.last_write_time(error), entry.path(), entry.file_size(error)});
      all += entries.back().bytes;
    }
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
