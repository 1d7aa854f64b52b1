// SPDX-License-Identifier: Apache-2.0
// The executable on files that no correct program wrote: each gives one line and exit code 2, or a
// warning if the file can still be used; none causes a crash, a hang or memory exhaustion.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/bench/cli/hostile_files.hpp"

namespace mh {

namespace {

namespace fs = std::filesystem;

// Limits for the build that users have; with sanitizers, a command takes several times as much.
constexpr double kMostProcessor_s = 10.0, kMostMemory_gb = 5.0;
constexpr int kMostWall_s = 120;  // other work may be running

struct Outcome {
  int code = -1;  ///< exit code; -1 if ended by a signal
  std::string said;
  double processor_s = 0,
         memory_gb = 0;  ///< time of the process and its children; memory of the largest one
};

/// Runs one case in its own folder.
class Trial {
 public:
  explicit Trial(const HostileCase& c)
      : case_(c),
        folder_(fs::temp_directory_path() / ("mh_hostile_" + c.name + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    for (const auto& [name, content] : c.files) write(name, content);
  }
  ~Trial() { fs::remove_all(folder_); }
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  Outcome run() const;

 private:
  void write(const std::string& name, const std::string& content) const {
    const fs::path file = folder_ / name.substr(0, name.find_first_of("|+"));
    fs::create_directories(file.parent_path());
    if (name.ends_with('|'))
      ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    else
      std::ofstream(file, std::ios::binary) << content;
    if (name.ends_with('+')) fs::resize_file(file, std::uintmax_t{100} << 30);
  }

  const HostileCase& case_;
  fs::path folder_;
};

Outcome Trial::run() const {
  std::string command = "XDG_CACHE_HOME={}/cache exec " MH_EXECUTABLE " " + case_.arguments;
  for (std::size_t at = 0; (at = command.find("{}", at)) != command.npos;)
    command.replace(at, 2, folder_.string());
  const std::string reported = (folder_ / "stderr").string();
  const pid_t child = fork();
  if (child == 0) {
    alarm(kMostWall_s);
    const int nothing = open("/dev/null", O_RDWR);
    const int err = open(reported.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(nothing, 0);
    dup2(nothing, 1);
    dup2(err, 2);
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  std::ostringstream said;
  said << std::ifstream(reported).rdbuf();
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, said.str(),
          seconds(used.ru_utime) + seconds(used.ru_stime),
          static_cast<double>(used.ru_maxrss) * 1024e-9};
}

void expect_one_line_or_a_warning(const HostileCase& c, const Outcome& outcome) {
  SCOPED_TRACE(c.name + ": " + outcome.said);
  EXPECT_TRUE(outcome.code == 2 || (c.passes && outcome.code == 0)) << "code " << outcome.code;
  EXPECT_NE(outcome.said.find(c.says), std::string::npos) << "does not say: " << c.says;
  EXPECT_LT(outcome.processor_s, kMostProcessor_s);
  EXPECT_LT(outcome.memory_gb, kMostMemory_gb);
  int errors = 0;
  std::istringstream lines(outcome.said);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_EQ(errors, 0) << "a line behind the error: " << line;
    errors += line.starts_with("modelhouse: error: ");
    for (const char letter : line)
      EXPECT_GE(static_cast<unsigned char>(letter), ' ') << "unprintable: " << line;
  }
  EXPECT_EQ(errors, outcome.code == 0 ? 0 : 1);
}

void expect_it_of(const std::vector<HostileCase>& cases) {
  ASSERT_FALSE(cases.empty());
  // Cases run in parallel, but only a few: the most demanding ones reach their limits of time and
  // memory (4 GB each).
  constexpr std::size_t kAtOnce = 3;
  std::vector<Outcome> outcomes(cases.size());
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> workers;
  for (std::size_t w = 0; w < kAtOnce; ++w)
    workers.emplace_back([&] {
      for (std::size_t i = 0; (i = next++) < cases.size();) outcomes[i] = Trial(cases[i]).run();
    });
  workers.clear();
  for (std::size_t i = 0; i < cases.size(); ++i)
    expect_one_line_or_a_warning(cases[i], outcomes[i]);
}

TEST(HostileFiles, Scenes) {
  expect_it_of(hostile_scenes());
}

TEST(HostileFiles, WorldsAndPlans) {
  expect_it_of(hostile_worlds());
}

TEST(HostileFiles, Recordings) {
  expect_it_of(hostile_recordings());
}

TEST(HostileFiles, RobotsSettingsAndResults) {
  expect_it_of(hostile_settings());
}

TEST(HostileFiles, DamagedByChance) {
  expect_it_of(damaged_files(18));
}

}  // namespace
}  // namespace mh
