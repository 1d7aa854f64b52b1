// SPDX-License-Identifier: Apache-2.0
#include "slam/io/held_bytes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string>
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
      return "the system denies access";
  }
}

}  // namespace

namespace {

// Read by a signal handler: nodes are never freed, and a file that is unmapped has size 0.
struct Mapped {
  const char* begin;
  std::atomic<std::size_t> size;
  std::string file;
  Mapped* next;
};
std::atomic<Mapped*> g_mapped = nullptr;
std::string g_error_mark;
int g_exit_code = 0;

Mapped* note_mapped(const void* begin, std::size_t size, const std::filesystem::path& file) {
  auto* const node =
      new Mapped{static_cast<const char*>(begin), size, file.string(), g_mapped.load()};
  while (!g_mapped.compare_exchange_weak(node->next, node)) {
  }
  return node;
}

void write_all(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void at_lost_page(int signal, siginfo_t* info, void*) {
  const auto* const at = static_cast<const char*>(info->si_addr);
  for (const Mapped* node = g_mapped.load(); node != nullptr; node = node->next)
    if (at >= node->begin && at < node->begin + node->size.load()) {
      write_all(g_error_mark);
      write_all(node->file);
      write_all(": was changed while it was in use: start the command again\n");
      _exit(g_exit_code);
    }
  std::signal(signal, SIG_DFL);  // not ours: the signal is raised again
}

}  // namespace

void end_at_lost_pages(std::string_view error_mark, int code) {
  g_error_mark = error_mark;
  g_exit_code = code;
  struct sigaction action {};
  action.sa_sigaction = at_lost_page;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

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
  Mapped* const noted = note_mapped(start, size, file);
  HeldBytes held{std::shared_ptr<const void>(start,
                                             [size, noted](const void* p) {
                                               noted->size = 0;
                                               munmap(const_cast<void*>(p), size);
                                             }),
                 {static_cast<const char*>(start), size}};
  report_read(file, held.view, before);
  return held;
}

}  // namespace mh
