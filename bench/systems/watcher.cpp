// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/watcher.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/systems/hiding.hpp"
#include "slam/io/error.hpp"
#include "slam/io/remove_tree.hpp"

namespace mh {
namespace {

// ---- in the forked processes: only system calls, since other threads of the bench may hold locks

/// Fields 4 and 24 of /proc/PID/stat: parent and resident pages. Field 2, a name in parentheses,
/// may contain spaces and parentheses.
struct ProcessFacts {
  pid_t parent = -1;
  long resident_pages = 0;
};

std::optional<ProcessFacts> facts_of(const char* process) {
  char name[32] = "/proc/";
  std::strncat(name, process, 12);
  std::strncat(name, "/stat", 6);
  const int file = open(name, O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  char text[1024];
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  if (size <= 0) return std::nullopt;
  text[size] = '\0';
  const char* at = std::strrchr(text, ')');
  if (at == nullptr) return std::nullopt;
  ProcessFacts facts;
  for (int field = 2; *at != '\0' && field <= 24; ++at) {
    if (*at != ' ') continue;
    ++field;
    if (field == 4) facts.parent = static_cast<pid_t>(std::strtol(at, nullptr, 10));
    if (field == 24) facts.resident_pages = std::strtol(at, nullptr, 10);
  }
  return facts;
}

/// Calls work(name, number) for each process.
template <class Work>
void for_each_process(const Work& work) {
  const int proc = open("/proc", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (proc < 0) return;
  alignas(dirent64) char buffer[8192];
  for (ssize_t size = 0; (size = getdents64(proc, buffer, sizeof buffer)) > 0;)
    for (ssize_t at = 0; at < size;) {
      const auto* entry = reinterpret_cast<const dirent64*>(buffer + at);
      if (const long number = std::strtol(entry->d_name, nullptr, 10); number > 0)
        work(entry->d_name, static_cast<pid_t>(number));
      at += entry->d_reclen;
    }
  close(proc);
}

[[noreturn]] void become(const WatchedCommand& c, int said, pid_t watcher) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a killed watcher leaves no command behind
  if (getppid() != watcher) _exit(126);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);
  signal(SIGINT, SIG_DFL);
  signal(SIGXFSZ, SIG_DFL);
  if (c.file_limit_bytes > 0) {
    const rlimit most{c.file_limit_bytes, c.file_limit_bytes};
    setrlimit(RLIMIT_FSIZE, &most);
  }
  if (dup2(c.in, 0) < 0 || dup2(c.out < 0 ? said : c.out, 1) < 0 || dup2(said, 2) < 0) _exit(126);
  close_range(3, ~0U, 0);
  if (c.hiding != nullptr) c.hiding->apply();
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // again: a new user namespace may clear it
  if (chdir(c.folder) != 0) {
    constexpr char kWhy[] = "its folder cannot be entered\n";
    if (write(2, kWhy, sizeof kWhy - 1) < 0) _exit(125);
    _exit(126);
  }
  execl("/bin/sh", "sh", "-c", c.command, static_cast<char*>(nullptr));
  _exit(127);
}

class Watch {
 public:
  Watch(const WatchedCommand& command, int life, int news)
      : command_(command), life_(life), news_(news) {}

  [[noreturn]] void run() {
    setpgid(0, 0);
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    sigset_t all, child;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, nullptr);
    sigemptyset(&child);
    sigaddset(&child, SIGCHLD);
    int said[2] = {-1, -1};
    signals_ = signalfd(-1, &child, SFD_CLOEXEC | SFD_NONBLOCK);
    if (signals_ < 0 || pipe2(said, O_CLOEXEC) != 0) give_up(errno);
    fcntl(said[0], F_SETFL, O_NONBLOCK);
    const pid_t watcher = getpid();
    child_ = _Fork();
    if (child_ == 0) become(command_, said[1], watcher);
    if (child_ < 0) give_up(errno);
    said_ = said[0];
    keep_open({life_, news_, signals_, said_, command_.log});
    while (true) {
      pollfd wait[] = {
          {life_, POLLIN, 0}, {signals_, POLLIN, 0}, {said_ended_ ? -1 : said_, POLLIN, 0}};
      if (poll(wait, 3, -1) < 0 && errno != EINTR) break;
      if (wait[0].revents != 0) break;
      if (wait[2].revents != 0) copy_what_was_said();
      if (too_much_) report(WatchedEnd::kTooMuchSaid, 0);
      if (wait[1].revents == 0) continue;
      signalfd_siginfo info;
      while (read(signals_, &info, sizeof info) > 0) {
      }
      reap();
      if (!ended_ || reported_) continue;
      end_all();
      copy_what_was_said();
      report(too_much_ ? WatchedEnd::kTooMuchSaid : WatchedEnd::kEnded, status_);
    }
    char byte = 0;
    const bool abandoned = read(life_, &byte, 1) <= 0;
    end_all();
    if (abandoned && *command_.scratch != '\0') remove_tree(command_.scratch);
    _exit(0);
  }

 private:
  [[noreturn]] void give_up(int error) {
    report(WatchedEnd::kNotStarted, error);
    _exit(1);
  }

  static void keep_open(std::array<int, 5> files) {
    std::sort(files.begin(), files.end());
    unsigned next = 0;
    for (const int file : files) {
      if (static_cast<unsigned>(file) > next) close_range(next, static_cast<unsigned>(file) - 1, 0);
      next = static_cast<unsigned>(file) + 1;
    }
    close_range(next, ~0U, 0);
  }

  /// Reports the end, but only once.
  void report(WatchedEnd::Kind kind, int value) {
    const WatchedEnd end{kind, value};
    if (!reported_ && write(news_, &end, sizeof end) < 0) return;  // no reader is left
    reported_ = true;
  }

  /// Reaps what has ended; returns whether any process is left.
  bool reap() {
    int status = 0;
    pid_t process = 0;
    while ((process = waitpid(-1, &status, WNOHANG)) > 0)
      if (process == child_) {
        ended_ = true;
        status_ = status;
      }
    return process == 0;
  }

  /// Children of a killed process are reparented to this process, which kills them in turn.
  void end_all() {
    constexpr int kMost = 2000;  // rounds of at least 1 ms; other users' processes cannot be killed
    const pid_t self = getpid();
    if (!ended_) kill(-child_, SIGKILL);
    for (int tries = 0; tries < kMost && reap(); ++tries) {
      for_each_process([&](const char* name, pid_t process) {
        if (const auto facts = facts_of(name); facts && facts->parent == self)
          kill(process, SIGKILL);
      });
      poll(nullptr, 0, 1);
    }
  }

  void copy_what_was_said() {
    char buffer[1 << 16];
    ssize_t size = 0;
    while ((size = read(said_, buffer, sizeof buffer)) > 0) {
      if (too_much_) continue;
      const auto room = command_.log_limit_bytes - written_;
      const auto fits = std::min<std::uint64_t>(room, static_cast<std::uint64_t>(size));
      if (write(command_.log, buffer, fits) < 0) continue;  // a full disk is reported elsewhere
      written_ += fits;
      if (fits == static_cast<std::uint64_t>(size)) continue;
      constexpr char kWhy[] = "\nmodelhouse: the program wrote too much and was stopped\n";
      if (write(command_.log, kWhy, sizeof kWhy - 1) < 0) continue;
      too_much_ = true;
      end_all();
    }
    said_ended_ = said_ended_ || size == 0;
  }

  const WatchedCommand& command_;
  const int life_, news_;
  int signals_ = -1, said_ = -1;
  pid_t child_ = -1;
  int status_ = 0;
  std::uint64_t written_ = 0;
  bool ended_ = false, reported_ = false, too_much_ = false, said_ended_ = false;
};

}  // namespace

// ---- in the parent process --------------------------------------------------------------------

Watcher::Watcher(const WatchedCommand& command) {
  int life[2] = {-1, -1}, news[2] = {-1, -1};
  // A socket: writing to a watcher that was killed must return an error, not raise SIGPIPE.
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, life) == 0 && pipe2(news, O_CLOEXEC) == 0)
    process_ = fork();
  if (process_ == 0) {
    close(life[1]);
    Watch(command, life[0], news[1]).run();
  }
  const int error = errno;
  for (const int end : {life[0], news[1]})
    if (end >= 0) close(end);
  life_ = life[1];
  news_ = news[0];
  if (process_ > 0) return;
  for (const int end : {life_, news_})
    if (end >= 0) close(end);
  throw MachineError(fmt::format("no process could be started: {}", std::strerror(error)));
}

Watcher::~Watcher() {
  end_all();
  close(news_);
}

void Watcher::end_all() {
  if (process_ <= 0) return;
  end(0);
  send(life_, "q", 1, MSG_NOSIGNAL);
  close(life_);
  // The command may have stopped the watcher, and may do so again until it is killed.
  constexpr int kPatience = 10000;  // rounds of 1 ms
  for (int tries = 0; waitpid(process_, nullptr, tries < kPatience ? WNOHANG : 0) == 0; ++tries) {
    kill(process_, tries + 1 < kPatience ? SIGCONT : SIGKILL);
    poll(nullptr, 0, 1);
  }
  process_ = -1;
}

std::optional<WatchedEnd> Watcher::end(int wait_ms) {
  if (end_) return end_;
  pollfd wait{news_, POLLIN, 0};
  if (poll(&wait, 1, wait_ms) <= 0) return std::nullopt;
  WatchedEnd end;
  const ssize_t size = read(news_, &end, sizeof end);
  end_ = size == static_cast<ssize_t>(sizeof end) ? end : WatchedEnd{};
  return end_;
}

double Watcher::resident_mb() const {
  std::map<pid_t, ProcessFacts> all;
  for_each_process([&](const char* name, pid_t process) {
    if (const auto facts = facts_of(name)) all[process] = *facts;
  });
  const auto is_below = [&](pid_t process) {
    for (std::size_t steps = 0; steps < all.size(); ++steps) {
      const auto found = all.find(process);
      if (found == all.end()) return false;
      process = found->second.parent;
      if (process == process_) return true;
    }
    return false;
  };
  double pages = 0;
  for (const auto& [process, facts] : all)
    if (is_below(process)) pages += static_cast<double>(facts.resident_pages);
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

}  // namespace mh
