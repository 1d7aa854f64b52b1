// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/child_process.hpp"
#include "bench/suite/find_program.hpp"
#include "bench/systems/hiding.hpp"
#include "bench/systems/program_folder.hpp"
#include "slam/io/last_line.hpp"
#include "slam/io/printable.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <vector>

#include <fmt/format.h>

namespace mh {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestLine = std::size_t{16} << 20;  // a trajectory is about 1e5 bytes
constexpr auto kLook = std::chrono::milliseconds(500);       // between two checks of its limits
constexpr double kMegabyte = 1024.0 * 1024.0;
constexpr double kLogLimit_mb = 64;                      // docs/outside_systems.md
constexpr int kMoment_ms = 2000;                         // grace for a program that closed its pipe
constexpr std::size_t kMostSaid = 200, kMostTold = 600;  // maximum bytes of log line, message

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(std::min(seconds, 1e8)));
}

void close_if_open(int& fd) {
  if (fd >= 0) close(fd);
  fd = -1;
}

/// Contents of a folder: total size of its files, and whether folders are nested too deep to be
/// searched.
struct Contents {
  double mb = 0;
  bool too_deep = false;
};

/// Files removed meanwhile are not counted.
Contents contents_of(const fs::path& folder) {
  Contents found;
  std::error_code error;
  constexpr auto kHow = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator it(folder, kHow, error), end; !error && it != end;
       it.increment(error)) {
    if (it.depth() >= kDeepestFolder) {
      found.too_deep = true;
      it.disable_recursion_pending();
    }
    if (std::error_code gone; it->symlink_status(gone).type() == fs::file_type::regular)
      if (const auto size = it->file_size(gone); !gone)
        found.mb += static_cast<double>(size) / kMegabyte;
  }
  return found;
}

/// Removes the folders' names from file paths in a text, so that it does not depend on them.
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

/// What a program needs to see, as far as the suite names it.
std::vector<fs::path> needed_by(const OutsideProgram& program, const fs::path& folder) {
  std::vector<fs::path> needed = {program.folder, folder};
  if (!program.hidden.empty())
    for (const ProgramFile& file : files_of(program)) needed.push_back(file.file);
  return needed;
}

/// The beginning of a text as one line of printable characters.
std::string told(std::string text, std::size_t most) {
  const bool cut = text.size() > most;
  if (cut) text.resize(most);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return printable(std::move(text)) + (cut ? "..." : "");
}

}  // namespace

int new_log(const fs::path& file) {
  unlink(file.c_str());  // an earlier program may have put a link there
  return open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
}

ChildProcess::ChildProcess(const OutsideProgram& program, std::string command, Talk talk,
                           const fs::path& log, const fs::path& folder)
    : program_(program), command_(std::move(command)), log_(fs::absolute(log)), folder_(folder) {
  const auto machine = [&](std::string_view what) {
    throw MachineError(fmt::format("{}: {}: {}", program_.name, what, std::strerror(errno)));
  };
  log_file_ = new_log(log_);
  if (log_file_ < 0) machine(log_.string());
  int in[2] = {-1, -1}, out[2] = {-1, -1};  // our end, the child's end
  if (talk == Talk::kOverPipes) {
    // A socket, not a pipe: writing to a program that has exited must return an error, not raise
    // SIGPIPE.
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in) != 0)
      machine("cannot create a socket");
    if (pipe2(out, O_CLOEXEC) != 0) machine("cannot create a pipe");
  } else {
    in[1] = open("/dev/null", O_RDONLY | O_CLOEXEC);
  }
  to_child_ = in[0];
  from_child_ = out[0];
  size_before_mb_ = contents_of(folder_).mb;
  const std::string runs_in = program_.folder.string(), scratch = folder_.string();
  const auto [memory_mb, disk_mb] = std::pair(program_.memory_limit_mb, program_.disk_limit_mb);
  const double shared_mb =
      memory_mb > 0 && disk_mb > 0 ? std::min(memory_mb, disk_mb) : std::max(memory_mb, disk_mb);
  const Hiding hiding(program_.hidden, needed_by(program_, folder_), folder_, shared_mb);
  watcher_.emplace(WatchedCommand{
      .folder = runs_in.c_str(),
      .command = command_.c_str(),
      .in = in[1],
      .out = out[1],
      .log = log_file_,
      .log_limit_bytes = static_cast<std::uint64_t>(kLogLimit_mb * kMegabyte),
      .file_limit_bytes = static_cast<std::uint64_t>(program_.disk_limit_mb * kMegabyte),
      .scratch = scratch.c_str(),
      .hiding = &hiding});
  for (const int file : {in[1], out[1]})
    if (file >= 0) close(file);
}

ChildProcess::~ChildProcess() {
  close_if_open(to_child_);
  close_if_open(from_child_);
  close_if_open(log_file_);
}

void ChildProcess::fail(std::string_view what) {
  watcher_->end_all();
  const std::vector<fs::path> folders = {folder_, log_.parent_path()};
  // Read through the open file, since the file with this name may have been replaced.
  std::string said = last_line_of(log_file_);
  if (said.starts_with("modelhouse: ")) said.clear();  // the watcher's note; reported separately
  said = told(without_folders(std::move(said), folders), kMostSaid);
  throw OutsideError(fmt::format("{} {}{}", described(program_),
                                 told(without_folders(std::string(what), folders), kMostTold),
                                 said.empty() ? "" : "; it last wrote: " + said));
}

void ChildProcess::check_limits(std::string_view doing) {
  if (Clock::now() < next_look_) return;
  const auto start = Clock::now();
  if (program_.memory_limit_mb > 0)
    if (const double mb = watcher_->resident_mb(); mb > program_.memory_limit_mb)
      fail(fmt::format("used {:.0f} MB of memory during {}, its limit is {:g} MB", mb, doing,
                       program_.memory_limit_mb));
  if (program_.disk_limit_mb > 0) {
    const Contents found = contents_of(folder_);
    if (found.too_deep)
      fail(fmt::format("nested folders more than {} levels deep in its folder during {}",
                       kDeepestFolder, doing));
    if (const double mb = found.mb - size_before_mb_; mb > program_.disk_limit_mb)
      fail(fmt::format("wrote {:.0f} MB into its folder during {}, its limit is {:g} MB", mb, doing,
                       program_.disk_limit_mb));
  }
  // The next check is late enough that checking takes a small share of the time, however many files
  // there are.
  next_look_ = Clock::now() + std::max<Clock::duration>(kLook, 20 * (Clock::now() - start));
}

double ChildProcess::written_mb() const {
  return contents_of(folder_).mb - size_before_mb_;
}

std::string ChildProcess::ending(int wait_ms) {
  const auto end = watcher_->end(wait_ms);
  if (!end) return "closed its pipe";
  switch (end->kind) {
    case WatchedEnd::kNotStarted:
      return fmt::format("could not be started: {}", std::strerror(end->value));
    case WatchedEnd::kTooMuchSaid:
      return fmt::format("wrote more than {} MB to its log, the limit", kLogLimit_mb);
    case WatchedEnd::kUnknown:
      return "was lost: the process that watched it was killed";
    case WatchedEnd::kEnded:
      break;
  }
  // A shell reports the signal that ended its command as exit code 128 + signal.
  if ((WIFSIGNALED(end->value) && WTERMSIG(end->value) == SIGXFSZ) ||
      WEXITSTATUS(end->value) == 128 + SIGXFSZ)
    return fmt::format("wrote a file of more than {:g} MB, its limit", program_.disk_limit_mb);
  if (WIFEXITED(end->value)) return fmt::format("exited with code {}", WEXITSTATUS(end->value));
  return fmt::format("was killed by signal {}", WTERMSIG(end->value));
}

bool ChildProcess::ended_well() {
  const auto end = watcher_->end(0);
  return end && end->kind == WatchedEnd::kEnded && WIFEXITED(end->value) &&
         WEXITSTATUS(end->value) == 0;
}

void ChildProcess::send(std::string_view line, std::string_view doing) {
  std::string text(line);
  text += '\n';
  for (std::size_t sent = 0; sent < text.size();) {
    // A program replies before the next request is sent, so the socket's buffer never fills.
    const ssize_t n =
        ::send(to_child_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n >= 0)
      sent += static_cast<std::size_t>(n);
    else if (errno == EAGAIN)
      fail(fmt::format("does not read its standard input, before {}", doing));
    else if (errno != EINTR)
      fail(fmt::format("{} before {}", ending(kMoment_ms), doing));
  }
}

std::string ChildProcess::read_line(double limit_s, std::string_view doing) {
  const auto deadline = after(limit_s);
  for (std::size_t searched = 0;;) {
    if (const std::size_t end = unread_.find('\n', searched); end != std::string::npos) {
      std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      return line;
    }
    if (unread_.size() > kLongestLine)
      fail(fmt::format("replied to {} with a line of more than {} MB", doing, kLongestLine >> 20));
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() < 0) fail(fmt::format("did not reply to {} within {:g} s", doing, limit_s));
    check_limits(doing);
    pollfd wait{from_child_, POLLIN, 0};
    const int ready = poll(&wait, 1, static_cast<int>(std::min(left, kLook).count()) + 1);
    if (ready <= 0) continue;
    char buffer[1 << 16];
    const ssize_t n = read(from_child_, buffer, sizeof buffer);
    searched = unread_.size();
    if (n > 0)
      unread_.append(buffer, static_cast<std::size_t>(n));
    else if (n == 0 || errno != EINTR)
      fail(fmt::format("{} during {}", ending(kMoment_ms), doing));
  }
}

void ChildProcess::wait_for_success(double limit_s, const std::function<void()>& meanwhile) {
  const auto deadline = after(limit_s);
  constexpr int kWait_ms = 100;
  while (!watcher_->end(kWait_ms)) {
    if (Clock::now() > deadline)
      fail(fmt::format("was still running after {:g} s, its limit", limit_s));
    check_limits("its run");
    meanwhile();
  }
  if (!ended_well()) fail(ending(0));
  watcher_->end_all();
}

void ChildProcess::finish(double limit_s) {
  close_if_open(to_child_);
  if (watcher_->end(static_cast<int>(1e3 * limit_s)) && !ended_well())
    fail(ending(0) + " after its input was closed");
  watcher_->end_all();
}

}  // namespace mh
