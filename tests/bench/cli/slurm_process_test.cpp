// SPDX-License-Identifier: Apache-2.0
// `modelhouse bench --slurm` against a real Slurm controller and a real worker on this machine.
#include <arpa/inet.h>
#include <pwd.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <thread>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "source_dir.hpp"
#include "tests/bench/cli/small_suite.hpp"

namespace {

namespace fs = std::filesystem;
using mh::test::code_of;
using mh::test::content;
using namespace std::chrono_literals;

/// A folder whose name contains a space, as a user's might.
const fs::path& test_folder() {
  static const struct Folder {
    fs::path path = fs::temp_directory_path() / ("mh slurm " + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
  } folder;
  return folder.path;
}

/// Runs `modelhouse ARGUMENTS` in a shell, with its outputs in the files `stdout` and `stderr`.
int run(const std::string& arguments) {
  const std::string folder = "'" + test_folder().string() + "'/";
  return code_of(std::system(
      (MH_EXECUTABLE " " + arguments + " >" + folder + "stdout 2>" + folder + "stderr").c_str()));
}

std::string errors() {
  return content(test_folder() / "stderr");
}

/// Three runs per trial in a small room.
fs::path write_suite() {
  const fs::path file = test_folder() / "small suite.yaml";
  mh::test::SmallSuite{}.write(file);
  return file;
}

fs::path folder_of(const std::string& out) {
  return test_folder() / out;
}

/// A bench command whose cache holds only the light that other tests have baked: every run has to
/// map.
std::string bench(const std::string& out, const std::string& more) {
  const fs::path cache = test_folder() / ("cache of " + out);
  std::error_code there_or_none;
  fs::create_directories(cache);
  fs::copy(MH_TEST_CACHE "/modelhouse-cache", cache / "modelhouse-cache",
           fs::copy_options::recursive, there_or_none);
  fs::remove_all(cache / "modelhouse-cache/map");
  const auto quoted = [](const fs::path& path) { return "'" + path.string() + "'"; };
  return "bench " + quoted(write_suite()) + " --cache " + quoted(cache) + " --out " +
         quoted(folder_of(out)) + " " + more;
}

/// Everything that is exported and must not depend on how the work was split or interrupted.
std::string tables(const std::string& out) {
  EXPECT_EQ(run("export '" + folder_of(out).string() + "' --format json"), 0) << errors();
  return content(folder_of(out) / "results.json") + content(folder_of(out) / "table.txt") +
         content(test_folder() / "stdout");
}

/// A child process that dies with this one.
class Daemon {
 public:
  /// @param user  user to run as; nullptr: ours
  explicit Daemon(const std::vector<std::string>& words, const passwd* user = nullptr) {
    process_ = fork();
    if (process_ != 0) return;
    if (user != nullptr && (setgid(user->pw_gid) != 0 || setuid(user->pw_uid) != 0)) _exit(126);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(126);
    if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(126);
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  ~Daemon() {
    kill(process_, SIGTERM);
    for (int i = 0; i < 100 && waitpid(process_, nullptr, WNOHANG) == 0; ++i)
      std::this_thread::sleep_for(50ms);
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

 private:
  pid_t process_ = -1;
};

/// A port on which nothing listens.
int free_port() {
  const int file = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  bind(file, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(file, reinterpret_cast<sockaddr*>(&address), &size);
  close(file);
  return ntohs(address.sin_port);
}

bool succeeds(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}

/// Why no cluster can run on this machine; empty if one can.
std::string why_no_cluster() {
  for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch"})
    if (!succeeds(std::string("command -v ") + program))
      return std::string(program) + " is not installed (slurmctld, slurmd, slurm-client, munge)";
  if (getuid() != 0) return "slurmd starts jobs as root only";
  if (getpwnam("munge") == nullptr) return "there is no user munge";
  return "";
}

/// A controller and a worker with two processors and their own key, sockets, ports and files.
class Cluster {
 public:
  Cluster() : folder_(fs::temp_directory_path() / ("mh_cluster_" + std::to_string(getpid()))) {
    const std::string d = folder_.string();
    for (const char* name : {"munge", "state", "spool"}) fs::create_directories(folder_ / name);
    fs::permissions(folder_, fs::perms(0755));
    fs::permissions(folder_ / "munge", fs::perms(0755));
    const passwd* const munge = getpwnam("munge");
    const fs::path key = folder_ / "munge/key";
    std::random_device random;
    {
      std::ofstream file(key, std::ios::binary);
      for (int i = 0; i < 128; ++i) file.put(static_cast<char>(random()));
    }
    fs::permissions(key, fs::perms(0400));
    for (const fs::path& path : {folder_ / "munge", key})
      EXPECT_EQ(chown(path.c_str(), munge->pw_uid, munge->pw_gid), 0);
    // As in Slurm's default configuration, no job is requeued for its exit code alone. With
    // cred_expire, a requeued task starts at once instead of after two minutes.
    std::ofstream(folder_ / "slurm.conf")
        << "ClusterName=modelhouse\nSlurmctldHost=localhost\nSlurmUser=root\nSlurmdUser=root\n"
        << "SlurmctldPort=" << free_port() << "\nSlurmdPort=" << free_port()
        << "\nAuthType=auth/munge\nAuthInfo=socket=" << d << "/munge/s,cred_expire=5\n"
        << "StateSaveLocation=" << d << "/state\nSlurmdSpoolDir=" << d << "/spool\n"
        << "SlurmctldPidFile=" << d << "/slurmctld.pid\nSlurmdPidFile=" << d << "/slurmd.pid\n"
        << "SlurmctldLogFile=" << d << "/slurmctld.log\nSlurmdLogFile=" << d << "/slurmd.log\n"
        << "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n"
        << "JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n"
        << "SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nMpiDefault=none\n"
        << "SwitchType=switch/none\nReturnToService=2\nJobRequeue=1\n"
        << "SchedulerParameters=sched_interval=1,batch_sched_delay=1\nKillWait=2\n"
        << "NodeName=localhost NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n"
        << "PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n";
    setenv("SLURM_CONF", (folder_ / "slurm.conf").c_str(), 1);
    const std::string m = d + "/munge/";
    start({"munged", "--foreground", "--socket=" + m + "s", "--key-file=" + m + "key",
           "--pid-file=" + m + "pid", "--log-file=" + m + "log", "--seed-file=" + m + "seed"},
          munge);
    for (int i = 0; i < 100 && !fs::exists(folder_ / "munge/s"); ++i)
      std::this_thread::sleep_for(50ms);
    start({"slurmctld", "-D"});
    start({"slurmd", "-D", "-N", "localhost"});
    for (int i = 0; i < 200 && !is_up(); ++i) std::this_thread::sleep_for(100ms);
  }
  ~Cluster() {
    succeeds("scancel --user=root");
    for (int i = 0; i < 100 && !succeeds("test -z \"$(squeue --noheader)\""); ++i)
      std::this_thread::sleep_for(100ms);
    while (!daemons_.empty()) daemons_.pop_back();
    fs::remove_all(folder_);
  }
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  bool is_up() const { return succeeds("sinfo --noheader --format=%t | grep -q idle"); }
  std::string log() const {
    return content(folder_ / "slurmctld.log") + content(folder_ / "slurmd.log");
  }

 private:
  void start(const std::vector<std::string>& words, const passwd* user = nullptr) {
    daemons_.push_back(std::make_unique<Daemon>(words, user));
  }

  fs::path folder_;
  std::vector<std::unique_ptr<Daemon>> daemons_;
};

/// The first process whose command line starts with `begin` and contains all `parts`; 0 if none
/// does.
pid_t process_of(const std::string& begin, const std::vector<std::string>& parts) {
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator("/proc", gone)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::string line = content(entry.path() / "cmdline");
    std::ranges::replace(line, '\0', ' ');
    const auto is_in = [&](const std::string& part) { return line.find(part) < line.size(); };
    if (line.starts_with(begin) && std::ranges::all_of(parts, is_in)) return std::stoi(name);
  }
  return 0;
}

/// The parent of a process; 0 if the process has ended.
pid_t parent_of(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  pid_t parent = 0;
  for (std::string word; status >> word;)
    if (word == "PPid:" && status >> parent) break;
  return parent;
}

/// Number of finished runs in a results file, which others may be writing.
int finished_in(const fs::path& folder) {
  try {
    SQLite::Database db((folder / "results.sqlite").string());
    db.setBusyTimeout(1000);
    return db.execAndGet("SELECT COUNT(*) FROM runs").getInt();
  } catch (const SQLite::Exception&) {
    return 0;  // the file does not exist yet
  }
}

/// Runs `arguments` and calls `kill_it` as soon as `share` has finished a run. @returns the exit
/// code
template <class Kill>
int run_and_kill(const std::string& arguments, const fs::path& share, Kill&& kill_it) {
  int code = -1;
  std::atomic<bool> ended = false;
  std::thread command([&] {
    code = run(arguments);
    ended = true;
  });
  bool killed = false;
  while (!killed && !ended) {
    if (finished_in(share) > 0) killed = kill_it();
    std::this_thread::sleep_for(20ms);
  }
  command.join();
  EXPECT_TRUE(killed);
  return code;
}

int count_of(const std::string& text, const std::string& what) {
  int count = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(SlurmProcess, AWorkerThatIsKilledGoesOnAndNoByteChanges) {
  if (const std::string why = why_no_cluster(); !why.empty()) GTEST_SKIP() << why;
  const std::string suite = "--trials 8 --frames 30 ";
  const Cluster cluster;
  ASSERT_TRUE(cluster.is_up()) << cluster.log();
  const fs::path out = folder_of("four shares"), share = out / "slurm/2";
  const auto kill_worker = [&] {
    const pid_t worker = process_of(MH_EXECUTABLE " bench", {"--shard 2/4"});
    return worker > 0 && kill(worker, SIGKILL) == 0;
  };
  EXPECT_EQ(run_and_kill(bench("four shares", suite + "--slurm 4"), share, kill_worker), 0)
      << errors() << cluster.log();
  EXPECT_NE(errors().find("24 runs in 4 shares of "), std::string::npos) << errors();
  const std::string log = content(out / "slurm/2.log");
  EXPECT_EQ(count_of(log, "ended with code 137, is requeued"), 1) << log;
  EXPECT_EQ(count_of(log, ", restart 1"), 1) << log;
  EXPECT_EQ(count_of(log, "24 runs, 6 of them to do"), 1) << log << "the second time it had fewer";

  // Everything is finished, so no job is submitted.
  EXPECT_EQ(run(bench("four shares", suite + "--slurm 4")), 0) << errors();
  EXPECT_NE(errors().find(", 0 unfinished"), std::string::npos) << errors();
  EXPECT_EQ(errors().find("is submitted"), std::string::npos) << errors();

  const std::string made = tables("four shares");
  EXPECT_EQ(run(bench("alone", suite)), 0) << errors();
  ASSERT_GT(made.size(), 10000u);
  EXPECT_EQ(made == tables("alone"), true) << "the bytes differ";
  for (const auto& entry : fs::directory_iterator(folder_of("alone")))
    EXPECT_TRUE(fs::exists(out / entry.path().filename()) || entry.is_directory()) << entry.path();
}

// Slurm treats a killed batch script as a failure and requeues nothing.
TEST(SlurmProcess, AShareWhoseScriptIsKilledIsNamedAndTheSameCommandFinishesIt) {
  if (const std::string why = why_no_cluster(); !why.empty()) GTEST_SKIP() << why;
  const Cluster cluster;
  ASSERT_TRUE(cluster.is_up()) << cluster.log();
  const std::string command = bench("two shares", "--trials 2 --frames 30 --slurm 2");
  const auto kill_script = [&] {
    const pid_t worker = process_of(MH_EXECUTABLE " bench", {"--shard 1/2"});
    const pid_t script = worker == 0 ? 0 : parent_of(worker);
    if (script <= 1) return false;
    kill(script, SIGKILL);
    kill(worker, SIGKILL);
    return true;
  };
  const fs::path out = folder_of("two shares");
  EXPECT_EQ(run_and_kill(command, out / "slurm/1", kill_script), 3) << errors() << cluster.log();
  EXPECT_NE(errors().find("missing, from share 1 of 2"), std::string::npos) << errors();
  EXPECT_NE(content(out / "table.txt").find("missing"), std::string::npos);
  EXPECT_EQ(run(command), 0) << errors() << cluster.log();
  EXPECT_NE(errors().find(", 1 unfinished"), std::string::npos) << errors();
  const std::string made = tables("two shares");
  EXPECT_EQ(run(bench("alone", "--trials 2 --frames 30")), 0) << errors();
  EXPECT_EQ(made == tables("alone"), true) << "the bytes differ";
}

TEST(SlurmProcess, WhatCannotBeSubmittedIsTold) {
  EXPECT_EQ(run(bench("no", "--slurm 2 --shard 1/2")), 2);
  EXPECT_NE(errors().find("--slurm: makes the shards itself"), std::string::npos) << errors();
  EXPECT_EQ(run(bench("no", "--slurm 2 --audit")), 2);
  EXPECT_NE(errors().find("--slurm: audits nothing"), std::string::npos) << errors();
  EXPECT_EQ(run(bench("no", "--slurm 2 --sbatch '--mem=1G | rm'")), 2);
  EXPECT_NE(errors().find("--sbatch '--mem=1G | rm'"), std::string::npos) << errors();
  EXPECT_EQ(run(bench("no", "--sbatch=--mem=1G")), 2);
  EXPECT_NE(errors().find("--slurm"), std::string::npos) << errors();
  EXPECT_FALSE(fs::exists(folder_of("no")));
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  EXPECT_EQ(run(bench("no", "--slurm 2")), 3);
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(errors().find("there is no sbatch on PATH"), std::string::npos) << errors();
}

}  // namespace
