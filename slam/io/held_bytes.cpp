// SPDX-License-Identifier: Apache-2.0
#include "slam/io/held_bytes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/read_record.hpp"

namespace mh {
namespace {

/// Opens without blocking: a pipe without a writer is refused, not waited for.
class FileDescriptor {
 public:
  explicit FileDescriptor(const std::filesystem::path& file)
      : value_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() {
    if (value_ >= 0) close(value_);
  }
  int value() const { return value_; }

 private:
  int value_;
};

const char* reason_of(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return "no such file";
    case EACCES:
      return "no permission";
    default:
      return "the system refuses";
  }
}

}  // namespace

HeldBytes hold(std::string bytes) {
  const auto owner = std::make_shared<const std::string>(std::move(bytes));
  return {owner, *owner};
}

HeldBytes map_file(const std::filesystem::path& file, MapPages pages) {
  const auto refusal = [&](const char* reason) {
    report_absent(file);
    return InputError(fmt::format("{}: cannot be read: {}", file.string(), reason));
  };
  const FileState before = ReadScope::is_open() ? state_of(file) : FileState{};
  const FileDescriptor descriptor(file);
  struct stat status {};
  if (descriptor.value() < 0 || fstat(descriptor.value(), &status) != 0)
    throw refusal(reason_of(errno));
  if (S_ISDIR(status.st_mode)) throw refusal("it is a folder");
  if (!S_ISREG(status.st_mode)) throw refusal("it is not a file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (pages == MapPages::kAtOnce) require_readable_at_once(file, size);
  if (size == 0) {  // nothing to map
    report_read(file, {}, before);
    return {};
  }
  void* const start = mmap(nullptr, size, PROT_READ,
                           pages == MapPages::kAtOnce ? MAP_PRIVATE | MAP_POPULATE : MAP_PRIVATE,
                           descriptor.value(), 0);
  if (start == MAP_FAILED) throw refusal(reason_of(errno));
  HeldBytes held{std::shared_ptr<const void>(
                     start, [size](const void* p) { munmap(const_cast<void*>(p), size); }),
                 {static_cast<const char*>(start), size}};
  report_read(file, held.view, before);
  return held;
}

}  // namespace mh
