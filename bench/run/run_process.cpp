// SPDX-License-Identifier: Apache-2.0
#include "bench/run/run_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/last_line.hpp"
#include "slam/io/printable.hpp"

extern char** environ;

namespace mh {
namespace {

/// This process' environment, set so that glibc requests 2 MB pages where possible: a run touches
/// some 300 MB once, mostly textures; with small pages, their page faults take a fifth of its time.
/// The user's own setting is kept.
std::vector<char*> with_large_pages() {
  static std::string tunables = "GLIBC_TUNABLES=glibc.malloc.hugetlb=1";
  std::vector<char*> all;
  bool is_set = false;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    all.push_back(*entry);
    is_set = is_set || std::string_view(*entry).starts_with("GLIBC_TUNABLES=");
  }
  if (!is_set) all.push_back(tunables.data());
  all.push_back(nullptr);
  return all;
}

/// The last nonblank line.
std::string last_line(const std::filesystem::path& file) {
  const int opened = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (opened < 0) return {};
  std::string line = last_line_of(opened);
  close(opened);
  return line;
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

}  // namespace

std::string unreported_end(const ProcessEnd& end, const std::string& status) {
  const std::string where = status.empty() ? "" : ", last seen at '" + status + "'";
  const std::string last = end.message.empty() ? "" : ": " + end.message;
  if (end.signal != 0)
    return fmt::format("ended by signal {} ({}){}{}", end.signal, strsignal(end.signal), where,
                       last);
  if (end.good) return "ended without a result" + where;
  return fmt::format("exited with code {}{}{}", end.code, where, last);
}

RunProcess::RunProcess(const std::filesystem::path& executable,
                       const std::vector<std::string>& arguments, std::filesystem::path log)
    : log_(std::move(log)), start_(std::chrono::steady_clock::now()) {
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0)
    throw MachineError(fmt::format("no process can be started: {}", std::strerror(errno)));

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, pipe_ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log_.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  // The run gets its own process group, so that Ctrl-C reaches only this process, which then ends
  // the runs in order.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);

  std::vector<std::string> texts = {executable.string()};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& text : texts) argv.push_back(text.data());
  argv.push_back(nullptr);
  std::vector<char*> environment = with_large_pages();
  const int error = posix_spawn(&process_, executable.c_str(), &files, &attributes, argv.data(),
                                environment.data());
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  close(pipe_ends[1]);
  output_ = pipe_ends[0];
  fcntl(output_, F_SETFL, O_NONBLOCK);
  if (error != 0) {
    process_ = -1;
    close(output_);
    throw MachineError(
        fmt::format("{}: cannot be started: {}", executable.string(), std::strerror(error)));
  }
}

RunProcess::~RunProcess() {
  kill();
  if (process_ > 0) waitpid(process_, nullptr, 0);
  close(output_);
}

void RunProcess::kill() {
  if (process_ > 0) ::kill(process_, SIGKILL);
}

void RunProcess::read_shares() {
  char buffer[4096];
  constexpr int kMost = 256;  // reads at most: endless printing must not block us
  for (int piece = 0; piece < kMost; ++piece) {
    const ssize_t got = read(output_, buffer, sizeof buffer);
    if (got <= 0) break;
    unread_.append(buffer, static_cast<std::size_t>(got));
    // A library in that process may print here, too, without newlines.
    constexpr std::size_t kLongestLine = 1 << 16;
    if (unread_.size() > kLongestLine && unread_.find('\n') == std::string::npos) unread_.clear();
  }
  for (auto end = unread_.find('\n'); end != std::string::npos; end = unread_.find('\n')) {
    const std::string line = unread_.substr(0, end);
    unread_.erase(0, end + 1);
    char* rest = nullptr;
    const double share = std::strtod(line.c_str(), &rest);
    if (!line.empty() && *rest == '\0') {
      if (share_ == 0) first_share_ = std::chrono::steady_clock::now();
      share_ = share >= 0 && share <= 1 ? share : share_;
    } else if (line.starts_with(kStatusMark)) {
      status_ = printable(line.substr(1));
    } else {
      stages_.push_back(printable(line));
    }
  }
}

std::vector<std::string> RunProcess::take_stages() {
  return std::exchange(stages_, {});
}

std::optional<ProcessEnd> RunProcess::poll() {
  read_shares();
  int status = 0;
  rusage usage{};
  if (process_ <= 0 || wait4(process_, &status, WNOHANG, &usage) != process_) return std::nullopt;
  process_ = -1;
  ProcessEnd end;
  end.good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  end.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  end.cost = {.wall_s = age_s(),
              .cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime),
              .slam_s = 0,
              .frames_s = 0,
              .products_s = 0,
              .max_rss_mb = static_cast<double>(usage.ru_maxrss) / 1024.0};
  if (end.good) return end;
  end.message = last_line(log_);
  end.reported = end.message.starts_with(kErrorMark);
  if (end.reported) end.message.erase(0, kErrorMark.size());
  return end;
}

double RunProcess::age_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double RunProcess::working_s() const {
  if (share_ == 0) return 0;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - first_share_).count();
}

double RunProcess::rss_mb() const {
  std::ifstream file(fmt::format("/proc/{}/statm", process_));
  double all = 0, resident = 0;
  file >> all >> resident;
  return file ? resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0) : 0.0;
}

void die_with(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(3);  // the parent died before the line above
}

}  // namespace mh
