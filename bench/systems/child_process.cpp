// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include <fmt/format.h>

namespace mh {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestLine = std::size_t{64} << 20;  // a trajectory has some 1e5 bytes
constexpr auto kLook = std::chrono::milliseconds(500);       // between two looks at the memory

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(std::min(seconds, 1e8)));
}

void close_if_open(int& fd) {
  if (fd >= 0) close(fd);
  fd = -1;
}

/// Resident memory (MB) of all processes of a group.
double resident_mb(pid_t group) {
  double pages = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::string text;
    std::getline(std::ifstream(entry.path() / "stat"), text);
    // The second field, a name in brackets, may hold blanks; then: state ppid pgrp ... rss (24th).
    const std::size_t bracket = text.rfind(')');
    if (bracket == std::string::npos) continue;
    std::istringstream fields(text.substr(bracket + 1));
    std::string field;
    for (int number = 3; number <= 24 && fields >> field; ++number) {
      if (number == 5 && field != std::to_string(group)) break;
      if (number == 24) pages += std::strtod(field.c_str(), nullptr);
    }
  }
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

/// A text without the names of folders before their files, so that it is the same for any of them.
std::string without_folders(std::string text, const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    const std::string name = folder.string();
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at)) {
      const std::size_t end = at + name.size();
      const bool whole = end == text.size() || text[end] != '/';
      text.erase(at, name.size() + (whole ? 0 : 1));
      if (whole) text.insert(at, 1, '.');
    }
  }
  return text;
}

std::string last_line(const fs::path& file, const std::vector<fs::path>& folders) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return {};
  constexpr std::streamoff kTail = 4096;
  const std::streamoff size = in.tellg();
  in.seekg(std::max<std::streamoff>(0, size - kTail));
  std::string line, last;
  while (std::getline(in, line))
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  last = without_folders(last, folders);
  constexpr std::size_t kMost = 200;
  if (last.size() > kMost) last = last.substr(0, kMost) + "...";
  for (char& c : last)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return last;
}

/// What the child does between fork and exec: system calls alone, since other threads of the bench
/// may hold locks.
[[noreturn]] void become(const char* folder, const char* command, int in, int out, int err) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a bench that is killed leaves nothing running
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);
  signal(SIGINT, SIG_DFL);
  if (dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0) _exit(126);
  close_range(3, ~0U, 0);
  if (chdir(folder) != 0) {
    constexpr char kWhy[] = "its folder cannot be entered\n";
    if (write(2, kWhy, sizeof kWhy - 1) < 0) _exit(125);
    _exit(126);
  }
  execl("/bin/sh", "sh", "-c", command, static_cast<char*>(nullptr));
  _exit(127);
}

/// What the watcher does: waits until the process that holds the other end of the pipe is gone, and
/// clears up after it. System calls alone, likewise.
[[noreturn]] void watch(int pipe_end, pid_t group, const char* scratch) {
  setpgid(0, 0);
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);
  if (dup2(pipe_end, 0) < 0) _exit(126);
  close_range(1, ~0U, 0);
  char byte = 0;
  while (read(0, &byte, 1) < 0 && errno == EINTR) {
  }
  ::kill(-group, SIGKILL);
  if (*scratch != '\0') execl("/bin/rm", "rm", "-rf", "--", scratch, static_cast<char*>(nullptr));
  _exit(0);
}

}  // namespace

ChildProcess::ChildProcess(const OutsideProgram& program, std::string command, Talk talk,
                           fs::path log, const fs::path& scratch)
    : program_(program), command_(std::move(command)), log_(std::move(log)), scratch_(scratch) {
  const auto machine = [&](std::string_view what) {
    throw MachineError(fmt::format("{}: {}: {}", program_.name, what, std::strerror(errno)));
  };
  const int err = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (err < 0) machine(log_.string());
  int in[2] = {-1, -1}, out[2] = {-1, -1};  // ours, the child's
  if (talk == Talk::kOverPipes) {
    // A socket, not a pipe: writing to a program that is gone must give an error, not SIGPIPE.
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in) != 0) machine("no socket");
    if (pipe2(out, O_CLOEXEC) != 0) machine("no pipe");
  } else {
    in[1] = open("/dev/null", O_RDONLY | O_CLOEXEC);
    out[1] = err;
  }
  pid_ = fork();
  if (pid_ == 0) become(program_.folder.c_str(), command_.c_str(), in[1], out[1], err);
  const int forked = errno;
  close(in[1]);
  close(err);
  if (talk == Talk::kOverPipes) close(out[1]);
  to_child_ = in[0];
  from_child_ = out[0];
  if (pid_ < 0) {
    close_if_open(to_child_);
    close_if_open(from_child_);
    errno = forked;
    machine("no process could be started");
  }
  setpgid(pid_, pid_);  // by whoever comes first; the other fails, harmlessly
  start_watcher();
}

void ChildProcess::start_watcher() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) == 0) {
    watcher_ = fork();
    if (watcher_ == 0) watch(ends[0], pid_, scratch_.c_str());
    close(ends[0]);
    to_watcher_ = ends[1];
  }
  if (watcher_ > 0) return;
  const int error = errno;
  close_if_open(to_watcher_);
  kill_group();
  throw MachineError(
      fmt::format("{}: no process could be started: {}", program_.name, std::strerror(error)));
}

ChildProcess::~ChildProcess() {
  close_if_open(to_child_);
  close_if_open(from_child_);
  kill_group();
}

bool ChildProcess::try_reap(int options) {
  if (!reaped_ && pid_ > 0) {
    pid_t got = 0;
    do got = waitpid(pid_, &status_, options);
    while (got < 0 && errno == EINTR);
    reaped_ = got == pid_;
  }
  return reaped_;
}

void ChildProcess::kill_group() {
  if (pid_ <= 0) return;
  kill(-pid_, SIGKILL);  // also what a command that has ended left behind
  // The watcher goes before the number of the group may come round again.
  if (watcher_ > 0) {
    kill(watcher_, SIGKILL);
    while (waitpid(watcher_, nullptr, 0) < 0 && errno == EINTR) {
    }
    watcher_ = -1;
  }
  close_if_open(to_watcher_);
  try_reap(0);
  pid_ = -1;
}

void ChildProcess::fail(std::string_view what) {
  kill_group();
  const std::vector<fs::path> folders = {scratch_, log_.parent_path()};
  const std::string said = last_line(log_, folders);
  throw OutsideError(fmt::format("outside program '{}' ({}) {}{}", program_.name, program_.command,
                                 without_folders(std::string(what), folders),
                                 said.empty() ? "" : "; it last wrote: " + said));
}

void ChildProcess::check_memory(std::string_view doing) {
  if (program_.memory_limit_mb <= 0 || Clock::now() < next_look_) return;
  next_look_ = Clock::now() + kLook;
  const double mb = resident_mb(pid_);
  if (mb > program_.memory_limit_mb)
    fail(fmt::format("used {:.0f} MB of memory during {}, its limit is {:g} MB", mb, doing,
                     program_.memory_limit_mb));
}

std::string ChildProcess::ending() {
  const auto deadline = after(2.0);
  while (!try_reap(WNOHANG)) {
    if (Clock::now() > deadline) return "closed its pipe";
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (WIFEXITED(status_)) return fmt::format("exited with code {}", WEXITSTATUS(status_));
  return fmt::format("was killed by signal {}", WTERMSIG(status_));
}

void ChildProcess::send(std::string_view line, std::string_view doing) {
  std::string text(line);
  text += '\n';
  for (std::size_t sent = 0; sent < text.size();) {
    // A program answers before it is asked again, so that the socket's buffer never fills.
    const ssize_t n =
        ::send(to_child_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n >= 0)
      sent += static_cast<std::size_t>(n);
    else if (errno == EAGAIN)
      fail(fmt::format("does not read its standard input, before {}", doing));
    else if (errno != EINTR)
      fail(fmt::format("{} before {}", ending(), doing));
  }
}

std::string ChildProcess::read_line(double limit_s, std::string_view doing) {
  const auto deadline = after(limit_s);
  for (;;) {
    if (const std::size_t end = unread_.find('\n'); end != std::string::npos) {
      std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      return line;
    }
    if (unread_.size() > kLongestLine)
      fail(fmt::format("answered {} with a line of more than {} MB", doing, kLongestLine >> 20));
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() < 0) fail(fmt::format("did not answer {} within {:g} s", doing, limit_s));
    check_memory(doing);
    pollfd wait{from_child_, POLLIN, 0};
    const int ready = poll(&wait, 1, static_cast<int>(std::min(left, kLook).count()) + 1);
    if (ready <= 0) continue;
    char buffer[1 << 16];
    const ssize_t n = read(from_child_, buffer, sizeof buffer);
    if (n > 0)
      unread_.append(buffer, static_cast<std::size_t>(n));
    else if (n == 0 || errno != EINTR)
      fail(fmt::format("{} during {}", ending(), doing));
  }
}

void ChildProcess::wait_for_success(double limit_s) {
  const auto deadline = after(limit_s);
  while (!try_reap(WNOHANG)) {
    if (Clock::now() > deadline)
      fail(fmt::format("was still running after {:g} s, its limit", limit_s));
    check_memory("its run");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) fail(ending());
  kill_group();
}

void ChildProcess::finish(double limit_s) {
  close_if_open(to_child_);
  const auto deadline = after(limit_s);
  while (!try_reap(WNOHANG) && Clock::now() <= deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (reaped_ && (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0))
    fail(ending() + " after its input was closed");
  kill_group();
}

}  // namespace mh
