// SPDX-License-Identifier: Apache-2.0
#include "scenes/guarded_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"

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
constexpr bool kSanitized = true;  // shadow memory knows no limit, and what it reports must be seen
#else
constexpr bool kSanitized = false;
#endif
#ifdef __SANITIZE_THREAD__
constexpr bool kMayFork = false;  // it allows a child no threads
#else
constexpr bool kMayFork = true;
#endif

/// The first byte that a child sends.
enum class Word : char { kDone = 'D', kInput = 'I', kMachine = 'M', kOther = 'E', kMemory = 'N' };

struct EndedTooSoon {};
struct TookTooLong {};

std::int64_t now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
}

void write_all(int descriptor, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(descriptor, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) _exit(1);  // the parent is gone
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

/// Memory that parent and child share: the name of the file that is being read.
class SharedName {
 public:
  SharedName() {
    void* page = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page == MAP_FAILED) throw MachineError("no memory for the reader of a file");
    text_ = static_cast<char*>(page);
  }
  ~SharedName() { munmap(text_, kSize); }
  SharedName(const SharedName&) = delete;
  SharedName& operator=(const SharedName&) = delete;

  void set(const std::string& name) {
    const std::size_t size = std::min(name.size(), kSize - 1);
    std::memcpy(text_, name.data(), size);
    text_[size] = '\0';
  }
  std::string get() const { return {text_, strnlen(text_, kSize - 1)}; }

 private:
  static constexpr std::size_t kSize = 4096;
  char* text_ = nullptr;
};

thread_local SharedName* t_name = nullptr;  // set in a child
int g_child_pipe = -1;                      // likewise; for the handler below

void tell_of_memory() {
  const char word = static_cast<char>(Word::kMemory);
  write_all(g_child_pipe, &word, 1);
  _exit(0);
}

void limit(__rlimit_resource resource, std::uint64_t value) {
  struct rlimit limits {};
  getrlimit(resource, &limits);
  limits.rlim_cur = std::min<rlim_t>(value, limits.rlim_max);
  setrlimit(resource, &limits);
}

/// What this process has mapped, bytes.
std::uint64_t mapped_bytes() {
  unsigned long long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// Foreign readers print; what they have to say comes as an error.
void silence() {
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere < 0) return;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

void obey(const GuardLimits& limits) {
  // The parent decides when it is interrupted; if it dies, so does the child.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXCPU, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.processor_s));
  if (kSanitized) return;
  silence();
  limit(RLIMIT_AS, mapped_bytes() + limits.stack_bytes + limits.memory_bytes);
  std::set_new_handler(tell_of_memory);
}

struct ChildWork {
  const std::function<std::function<void(PipeWriter&)>()>& work;
  SharedName& name;
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
  t_name = &child.name;
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
    tell_of_memory();
  } catch (const std::exception& error) {
    say(out, Word::kOther, error.what());
  } catch (...) {
    say(out, Word::kOther, "it does not say why");
  }
  out.flush();
  return nullptr;
}

/// Runs on a thread, since only a new one can be given a larger stack.
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

/// The child as its parent sees it; goes with it.
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
  /// @returns its status as waitpid tells it; nullopt if somebody else has taken it
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

std::string why_it_ended(std::optional<int> status, const GuardLimits& limits) {
  if (!status || !WIFSIGNALED(*status)) return "its reader ended without a word";
  const int number = WTERMSIG(*status);
  if (number == SIGXCPU)
    return fmt::format("its reader took more than {} s of processor time", limits.processor_s);
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

void hear(PipeReader& in, const SharedName& name, const GuardLimits& limits,
          const std::function<void(PipeReader&)>& receive) {
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
          fmt::format("{}: cannot be read: its reader gave up: {}", name.get(), read_text(in)));
    case Word::kMemory:
      throw InputError(fmt::format("{}: cannot be read: its reader needs more than {:.3g} GB",
                                   name.get(), static_cast<double>(limits.memory_bytes) / 1e9));
  }
  throw EndedTooSoon();
}

}  // namespace

void PipeWriter::bytes(const void* data, std::size_t size) {
  constexpr std::size_t kLarge = 1U << 14;
  if (size >= kLarge) {
    flush();
    write_all(descriptor_, static_cast<const char*>(data), size);
    return;
  }
  waiting_.append(static_cast<const char*>(data), size);
  if (waiting_.size() >= kLarge) flush();
}

void PipeWriter::flush() {
  write_all(descriptor_, waiting_.data(), waiting_.size());
  waiting_.clear();
}

PipeReader::PipeReader(int descriptor, int wall_s)
    : descriptor_(descriptor), deadline_ms_(now_ms() + 1000 * std::int64_t{wall_s}) {}

std::size_t PipeReader::some(char* to, std::size_t size) {
  for (;;) {
    const std::int64_t left_ms = deadline_ms_ - now_ms();
    if (left_ms <= 0) throw TookTooLong();
    pollfd ready{.fd = descriptor_, .events = POLLIN, .revents = 0};
    if (poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(left_ms, 60'000))) <= 0) continue;
    const ssize_t got = read(descriptor_, to, size);
    if (got > 0) return static_cast<std::size_t>(got);
    if (got == 0 || errno != EINTR) throw EndedTooSoon();
  }
}

void PipeReader::bytes(void* data, std::size_t size) {
  constexpr std::size_t kBuffer = 1U << 14;
  auto* to = static_cast<char*>(data);
  while (size > 0) {
    if (at_ == waiting_.size() && size >= kBuffer) {  // past the buffer
      const std::size_t got = some(to, size);
      to += got;
      size -= got;
      continue;
    }
    if (at_ == waiting_.size()) {
      waiting_.resize(kBuffer);
      waiting_.resize(some(waiting_.data(), waiting_.size()));
      at_ = 0;
    }
    const std::size_t taken = std::min(size, waiting_.size() - at_);
    std::memcpy(to, waiting_.data() + at_, taken);
    at_ += taken;
    to += taken;
    size -= taken;
  }
}

void in_child(const std::filesystem::path& file, const GuardLimits& limits,
              const std::function<std::function<void(PipeWriter&)>()>& work,
              const std::function<void(PipeReader&)>& receive) {
  SharedName name;
  name.set(file.string());
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw MachineError(fmt::format("{}: no pipe: {}", file.string(), std::strerror(errno)));
  fcntl(ends[1], F_SETPIPE_SZ, 1 << 20);  // fewer turns; refused, it works as well
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    close(ends[0]);
    g_child_pipe = ends[1];
    obey(limits);
    run_on_own_stack({work, name, ends[1]}, limits.stack_bytes);
    _exit(0);  // nothing of the parent's is flushed or cleared up twice
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
    return InputError(fmt::format("{}: cannot be read: {}", name.get(), why));
  };
  PipeReader in(child.pipe(), limits.wall_s);
  try {
    hear(in, name, limits, receive);
  } catch (const EndedTooSoon&) {
    throw refuse(why_it_ended(child.wait(), limits));
  } catch (const TookTooLong&) {
    throw refuse(fmt::format("its reader took more than {} s", limits.wall_s));
  }
}

bool reads_here() {
  return t_name != nullptr || !kMayFork;
}

ReadingInChild::ReadingInChild(const std::filesystem::path& file) {
  if (t_name == nullptr) return;
  outer_ = t_name->get();
  t_name->set(file.string());
}

ReadingInChild::~ReadingInChild() {
  if (t_name != nullptr) t_name->set(outer_);
}

}  // namespace mh
