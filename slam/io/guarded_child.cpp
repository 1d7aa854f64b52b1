// SPDX-License-Identifier: Apache-2.0
#include "slam/io/guarded_child.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>

#include <fmt/format.h>

#include "slam/io/bytes_read.hpp"
#include "slam/io/error.hpp"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1
#endif
#if __has_feature(thread_sanitizer)
#define __SANITIZE_THREAD__ 1
#endif
#endif

namespace mh {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr bool kSanitized = true;  // shadow memory cannot be limited, and sanitizer reports must be
                                   // visible
#else
constexpr bool kSanitized = false;
#endif
#ifdef __SANITIZE_THREAD__
constexpr bool kMayFork = false;  // thread sanitizer does not allow threads in a child
#else
constexpr bool kMayFork = true;
#endif

/// The first byte that a child sends.
enum class Word : char { kDone = 'D', kInput = 'I', kMachine = 'M', kOther = 'E', kMemory = 'N' };

/// What a child leaves in shared memory for its parent, even if it crashes.
struct Note {
  char file[4000];           ///< the file being read, zero-terminated
  std::int64_t processor_s;  ///< current limit of CPU time
  std::uint64_t memory_bytes;
};

/// A note in memory that parent and child share.
class SharedNote {
 public:
  SharedNote() {
    void* page =
        mmap(nullptr, sizeof(Note), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page == MAP_FAILED) throw MachineError("no memory for the reader of a file");
    note_ = static_cast<Note*>(page);
  }
  ~SharedNote() { munmap(note_, sizeof(Note)); }
  SharedNote(const SharedNote&) = delete;
  SharedNote& operator=(const SharedNote&) = delete;

  Note* operator->() const { return note_; }
  void set_file(const std::string& name) {
    const std::size_t size = std::min(name.size(), sizeof note_->file - 1);
    std::memcpy(note_->file, name.data(), size);
    note_->file[size] = '\0';
  }
  std::string file() const { return {note_->file, strnlen(note_->file, sizeof note_->file - 1)}; }

 private:
  Note* note_ = nullptr;
};

thread_local SharedNote* t_note = nullptr;  // set in a child

/// What a child's handlers need.
struct Watch {
  GuardLimits limits;
  SharedNote* note = nullptr;
  int pipe = -1;
  std::uint64_t read_before = 0, mapped_before = 0;

  std::uint64_t read_bytes() const { return g_bytes_read - read_before; }
};
Watch g_watch;

void report_memory_limit() {
  const char word = static_cast<char>(Word::kMemory);
  write_to_parent(g_watch.pipe, &word, 1);
  _exit(0);
}

void limit(__rlimit_resource resource, std::uint64_t value) {
  struct rlimit limits {};
  getrlimit(resource, &limits);
  limits.rlim_cur = std::min<rlim_t>(value, limits.rlim_max);
  setrlimit(resource, &limits);
}

/// Address space of this process, bytes.
std::uint64_t mapped_bytes() {
  unsigned long long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// Third-party readers print messages; they are reported as errors instead.
void silence() {
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere < 0) return;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

/// Called every second of processor time, starting at the first limit.
void on_processor_limit(int) {
  const GuardLimits& limits = g_watch.limits;
  (*g_watch.note)->processor_s =
      limits.processor_s + static_cast<std::int64_t>(static_cast<double>(g_watch.read_bytes()) *
                                                     1e-6 * limits.processor_s_per_mb);
  struct rusage used {};
  getrusage(RUSAGE_SELF, &used);
  if (used.ru_utime.tv_sec + used.ru_stime.tv_sec < (*g_watch.note)->processor_s) return;
  std::signal(SIGXCPU, SIG_DFL);
  kill(getpid(), SIGXCPU);
}

/// Raises the memory limit in proportion to what has been read since; then operator new tries
/// again.
void on_memory_limit() {
  const std::uint64_t granted = (*g_watch.note)->memory_bytes;
  const std::uint64_t allowed =
      g_watch.limits.memory_bytes + g_watch.limits.memory_per_byte * g_watch.read_bytes();
  if (allowed <= granted) report_memory_limit();
  (*g_watch.note)->memory_bytes = allowed;
  limit(RLIMIT_AS, g_watch.mapped_before + allowed);
}

void obey(const GuardLimits& limits) {
  // The parent decides what happens on an interrupt; if it dies, so does the child.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXCPU, on_processor_limit);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.processor_s));
  if (kSanitized) return;
  silence();
  limit(RLIMIT_AS, g_watch.mapped_before + limits.memory_bytes);
  std::set_new_handler(on_memory_limit);
}

struct ChildWork {
  const std::function<std::function<void(PipeWriter&)>()>& work;
  SharedNote& note;
  int pipe;
};

void say(PipeWriter& out, Word word, const char* text) {
  out.bytes(&word, 1);
  const std::uint64_t size = std::strlen(text);
  out.bytes(&size, sizeof size);
  out.bytes(text, size);
}

void* run_child(void* argument) {
  const auto& child = *static_cast<const ChildWork*>(argument);
  t_note = &child.note;
  PipeWriter out(child.pipe);
  try {
    const auto send = child.work();
    constexpr Word kWord = Word::kDone;
    out.bytes(&kWord, 1);
    send(out);
  } catch (const InputError& error) {
    say(out, Word::kInput, error.what());
  } catch (const MachineError& error) {
    say(out, Word::kMachine, error.what());
  } catch (const std::bad_alloc&) {
    report_memory_limit();
  } catch (const std::exception& error) {
    say(out, Word::kOther, error.what());
  } catch (...) {
    say(out, Word::kOther, "unknown error");
  }
  out.flush();
  return nullptr;
}

/// Runs the work on a new thread, since only a new thread can have a larger stack.
void run_on_own_stack(ChildWork child, std::size_t stack_bytes) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, stack_bytes);
  pthread_t thread{};
  if (pthread_create(&thread, &attributes, run_child, &child) == 0)
    pthread_join(thread, nullptr);
  else
    run_child(&child);
}

/// The child as seen by its parent; killed by the destructor.
class Child {
 public:
  Child(pid_t pid, int pipe) : pid_(pid), pipe_(pipe) {}
  ~Child() {
    close(pipe_);
    if (pid_ < 0) return;
    kill(pid_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int pipe() const { return pipe_; }
  /// @returns its status from waitpid; nullopt if something else has already collected it
  std::optional<int> wait() {
    int status = 0;
    pid_t got = 0;
    do got = waitpid(pid_, &status, 0);
    while (got < 0 && errno == EINTR);
    pid_ = -1;
    return got < 0 ? std::nullopt : std::optional(status);
  }

 private:
  pid_t pid_;
  int pipe_;
};

std::string why_it_ended(std::optional<int> status, const SharedNote& note) {
  if (!status || !WIFSIGNALED(*status)) return "its reader ended without a message";
  const int number = WTERMSIG(*status);
  if (number == SIGXCPU)
    return fmt::format("its reader took more than {} s of processor time", note->processor_s);
  if (number == SIGKILL) return "its reader was killed, as the system does when memory runs out";
  return fmt::format("its reader crashed on it (signal {}: {})", number, strsignal(number));
}

std::string read_text(PipeReader& in) {
  std::uint64_t size = 0;
  in.bytes(&size, sizeof size);
  std::string text(std::min<std::uint64_t>(size, 1U << 20), '\0');
  in.bytes(text.data(), text.size());
  return text;
}

void hear(PipeReader& in, const SharedNote& note, const std::function<void(PipeReader&)>& receive) {
  Word word{};
  in.bytes(&word, 1);
  switch (word) {
    case Word::kDone:
      return receive(in);
    case Word::kInput:
      throw InputError(read_text(in));
    case Word::kMachine:
      throw MachineError(read_text(in));
    case Word::kOther:
      throw InputError(
          fmt::format("{}: cannot be read: its reader gave up: {}", note.file(), read_text(in)));
    case Word::kMemory:
      throw InputError(fmt::format("{}: cannot be read: its reader needs more than {:.3g} GB",
                                   note.file(), static_cast<double>(note->memory_bytes) / 1e9));
  }
  throw EndedTooSoon();
}

}  // namespace

void in_child(const std::filesystem::path& file, const GuardLimits& limits,
              const std::function<std::function<void(PipeWriter&)>()>& work,
              const std::function<void(PipeReader&)>& receive) {
  SharedNote note;
  note.set_file(file.string());
  note->processor_s = limits.processor_s;
  note->memory_bytes = limits.memory_bytes;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw MachineError(fmt::format("{}: no pipe: {}", file.string(), std::strerror(errno)));
  fcntl(ends[1], F_SETPIPE_SZ, 1 << 20);  // for fewer context switches; harmless if refused
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    close(ends[0]);
    g_watch = {limits, &note, ends[1], g_bytes_read, mapped_bytes() + limits.stack_bytes};
    obey(limits);
    run_on_own_stack({work, note, ends[1]}, limits.stack_bytes);
    _exit(0);  // avoids flushing and cleaning up the parent's state a second time
  }
  const int forked = errno;
  close(ends[1]);
  if (pid < 0) {
    close(ends[0]);
    throw MachineError(fmt::format("{}: no process could be started to read it: {}", file.string(),
                                   std::strerror(forked)));
  }
  Child child(pid, ends[0]);
  const auto refuse = [&](const std::string& why) {
    return InputError(fmt::format("{}: cannot be read: {}", note.file(), why));
  };
  PipeReader in(child.pipe(), limits.wall_s);
  try {
    hear(in, note, receive);
  } catch (const EndedTooSoon&) {
    throw refuse(why_it_ended(child.wait(), note));
  } catch (const TookTooLong&) {
    throw refuse(fmt::format("its reader took more than {} s", limits.wall_s));
  }
}

bool reads_here() {
  return t_note != nullptr || !kMayFork;
}

ReadingInChild::ReadingInChild(const std::filesystem::path& file) {
  if (t_note == nullptr) return;
  outer_ = t_note->file();
  t_note->set_file(file.string());
}

ReadingInChild::~ReadingInChild() {
  if (t_note != nullptr) t_note->set_file(outer_);
}

}  // namespace mh
