// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/shared_exposures.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

// The file: an entry per frame, then records in the order in which they were made. An entry is
// written after its record, so that a process that finds an entry also finds its record.

namespace mh {
namespace {

struct Entry {
  std::uint64_t offset = 0, digest = 0;  // of the record
  std::uint32_t runs = 0;
  std::uint32_t number = 0;  // of the frame, from 1; 0: not written yet
};
static_assert(sizeof(Entry) == 24);

/// Neighboring pixels, in the order of rows, that show the same instance.
struct Run {
  std::uint32_t pixels = 0;
  InstanceId instance = 0;
  ClassId class_id = 0;
  std::uint8_t unused = 0;
};
static_assert(sizeof(Run) == 8);

/// A record: this, the colors, the depths, the runs.
struct Head {
  double gain = 1.0;
  float exposure = 0.0F;
  std::uint32_t unused = 0;
};
static_assert(sizeof(Head) == 16);

using Parts = std::array<iovec, 4>;

/// Where the parts of a record are in memory; written to only if they are not const.
Parts parts_of(const Head& head, const RenderedFrame& seen, const std::vector<Run>& runs) {
  const auto part = [](const auto* data, std::size_t count) {
    return iovec{const_cast<void*>(static_cast<const void*>(data)), count * sizeof *data};
  };
  return {part(&head, 1), part(seen.color.data(), seen.color.size()),
          part(seen.depth_m.data(), seen.depth_m.size()), part(runs.data(), runs.size())};
}

std::size_t size_of(const Parts& parts) {
  std::size_t sum = 0;
  for (const iovec& part : parts) sum += part.iov_len;
  return sum;
}

std::uint64_t digest_of(const Parts& parts, std::size_t frame) {
  std::uint64_t sum = frame;
  for (const iovec& part : parts) sum = XXH3_64bits_withSeed(part.iov_base, part.iov_len, sum);
  return sum;
}

std::vector<Run> runs_of(const RenderedFrame& seen) {
  std::vector<Run> runs;
  const ClassId* classes = seen.classes.data();
  const InstanceId* instances = seen.instances.data();
  for (std::size_t i = 0, n = seen.classes.size(); i < n;) {
    std::size_t end = i + 1;
    while (end < n && classes[end] == classes[i] && instances[end] == instances[i]) ++end;
    runs.push_back({static_cast<std::uint32_t>(end - i), instances[i], classes[i]});
    i = end;
  }
  return runs;
}

/// Expands the runs into an image; false if they do not fill it exactly.
bool expand(std::span<const Run> runs, RenderedFrame& seen) {
  std::size_t at = 0;
  for (const Run& run : runs) {
    if (run.pixels > seen.classes.size() - at) return false;
    std::fill_n(seen.classes.data() + at, run.pixels, run.class_id);
    std::fill_n(seen.instances.data() + at, run.pixels, run.instance);
    at += run.pixels;
  }
  return at == seen.classes.size();
}

std::optional<Entry> entry_at(int file, std::size_t i) {
  Entry entry;
  const auto place = static_cast<off_t>(i * sizeof entry);
  if (pread(file, &entry, sizeof entry, place) != sizeof entry || entry.number != i + 1)
    return std::nullopt;
  return entry;
}

}  // namespace

std::string folder_of(const std::vector<RandomStream>& noises) {
  return fmt::format("{:016x}", noises.front().key());
}

/// The right to make a frame: a lock, released at the latest when the process ends.
class SharedExposures::FrameLock {
 public:
  FrameLock(int file, std::size_t i, bool wait) : file_(file), i_(i) {
    struct flock lock = region(F_WRLCK);
    // On a file system without locks, two processes may make the same frame.
    has_it_ = fcntl(file_, wait ? F_OFD_SETLKW : F_OFD_SETLK, &lock) == 0 ||
              (errno != EAGAIN && errno != EACCES);
  }
  ~FrameLock() {
    if (!has_it_) return;
    struct flock lock = region(F_UNLCK);
    fcntl(file_, F_OFD_SETLK, &lock);
  }
  FrameLock(const FrameLock&) = delete;
  FrameLock& operator=(const FrameLock&) = delete;
  explicit operator bool() const { return has_it_; }

 private:
  struct flock region(short type) const {
    struct flock lock {};
    lock.l_type = type;
    lock.l_whence = SEEK_SET;
    lock.l_start = static_cast<off_t>(i_);
    lock.l_len = 1;
    return lock;
  }
  int file_;
  std::size_t i_;
  bool has_it_;
};

SharedExposures::SharedExposures(SharedImages where, const std::string& name, const Camera& camera,
                                 std::size_t frames)
    : where_(std::move(where)),
      file_(where_.folder / name),
      width_(camera.width_px),
      height_(camera.height_px),
      frames_(frames) {
  std::error_code failed;
  std::filesystem::create_directories(file_.parent_path(), failed);
  file_descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  append_descriptor_ = open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_descriptor_ < 0) return;
  // Makes room for all entries, so that records begin after them, whichever process comes first.
  flock(file_descriptor_, LOCK_EX);
  struct stat status {};
  const auto entries = static_cast<off_t>(frames * sizeof(Entry));
  writable_ = append_descriptor_ >= 0 && fstat(file_descriptor_, &status) == 0 &&
              (status.st_size >= entries || ftruncate(file_descriptor_, entries) == 0);
  flock(file_descriptor_, LOCK_UN);
}

SharedExposures::~SharedExposures() {
  if (file_descriptor_ >= 0) close(file_descriptor_);
  if (append_descriptor_ >= 0) close(append_descriptor_);
}

Shutter::Exposed SharedExposures::get(std::size_t i, const Make& make) {
  const std::size_t last = last_.exchange(i), step = i > last ? i - last : 1;
  for (;;) {
    if (auto exposed = read(i)) return std::move(*exposed);
    if (!has_room()) return make(i);
    {
      const FrameLock lock(file_descriptor_, i, false);
      if (lock) {
        if (auto exposed = read(i)) return std::move(*exposed);
        Shutter::Exposed exposed = make(i);
        write(i, exposed);
        return exposed;
      }
    }
    if (!make_ahead(i, step, make)) const FrameLock until_it_is_made(file_descriptor_, i, true);
  }
}

/// Makes the next frame that no process has made or is making; false if there is no such frame
/// within kAhead steps.
bool SharedExposures::make_ahead(std::size_t i, std::size_t step, const Make& make) {
  constexpr std::size_t kAhead = 16;  // steps
  for (std::size_t k = 1, next = i + step; k <= kAhead && next < frames_; ++k, next += step) {
    if (is_there(next)) continue;
    const FrameLock lock(file_descriptor_, next, false);
    if (!lock || is_there(next)) continue;
    write(next, make(next));
    return true;
  }
  return false;
}

bool SharedExposures::is_there(std::size_t i) const {
  return entry_at(file_descriptor_, i).has_value();
}

std::optional<Shutter::Exposed> SharedExposures::read(std::size_t i) const {
  const std::optional<Entry> entry = entry_at(file_descriptor_, i);
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  if (!entry || entry->runs > pixels) return std::nullopt;
  Head head;
  Shutter::Exposed exposed;
  exposed.seen = {.color = {width_, height_, Unfilled{}},
                  .depth_m = {width_, height_, Unfilled{}},
                  .classes = {width_, height_, Unfilled{}},
                  .instances = {width_, height_, Unfilled{}}};
  std::vector<Run> runs(entry->runs);
  const Parts parts = parts_of(head, exposed.seen, runs);
  if (preadv(file_descriptor_, parts.data(), static_cast<int>(parts.size()),
             static_cast<off_t>(entry->offset)) != static_cast<ssize_t>(size_of(parts)) ||
      digest_of(parts, i) != entry->digest || !expand(runs, exposed.seen))
    return std::nullopt;
  exposed.seen.exposure = head.exposure;
  exposed.gain = head.gain;
  return exposed;
}

bool SharedExposures::has_room() const {
  if (!writable_) return false;
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  std::uint64_t bytes = pixels * (sizeof(Rgb8) + sizeof(float));
  std::error_code failed;
  const auto disk = std::filesystem::space(where_.folder, failed);
  if (failed || disk.available < bytes + kLeaveFree_bytes) return false;
  // Files may be removed meanwhile: what cannot be read takes no space.
  for (std::filesystem::recursive_directory_iterator entry(where_.folder, failed), end;
       !failed && entry != end; entry.increment(failed)) {
    std::error_code gone;
    const std::uintmax_t size = entry->is_regular_file(gone) ? entry->file_size(gone) : 0;
    bytes += gone ? 0 : size;
  }
  return !failed && bytes <= where_.limit_bytes;
}

void SharedExposures::write(std::size_t i, const Shutter::Exposed& exposed) {
  const std::vector<Run> runs = runs_of(exposed.seen);
  const Head head{.gain = exposed.gain, .exposure = exposed.seen.exposure};
  const Parts parts = parts_of(head, exposed.seen, runs);
  const std::size_t size = size_of(parts);
  const std::lock_guard only_one(writing_);
  if (!writable_) return;
  const auto written = writev(append_descriptor_, parts.data(), static_cast<int>(parts.size()));
  const off_t end = lseek(append_descriptor_, 0, SEEK_CUR);
  const Entry entry{.offset = static_cast<std::uint64_t>(end) - size,
                    .digest = digest_of(parts, i),
                    .runs = static_cast<std::uint32_t>(runs.size()),
                    .number = static_cast<std::uint32_t>(i + 1)};
  if (written == static_cast<ssize_t>(size) && end >= 0 &&
      pwrite(file_descriptor_, &entry, sizeof entry, static_cast<off_t>(i * sizeof entry)) ==
          sizeof entry)
    return;
  // The disk is probably full: the space is freed once no process reads the file.
  writable_ = false;
  unlink(file_.c_str());
}

}  // namespace mh
