// SPDX-License-Identifier: Apache-2.0
#include "bench/run/run_process.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

// A process that is waiting prints nothing: asking for its output must not block, since other
// processes run at the same time.
TEST(RunProcess, OneThatSaysNothingHoldsNobodyUp) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path());
  const std::string gate = folder.path() / "gate";
  ASSERT_EQ(mkfifo(gate.c_str(), 0600), 0);
  RunProcess process("/bin/sh",
                     {"-c", "read x < '" + gate + "'; echo 0.5; echo '~frame 3'; echo baking"},
                     folder.path() / "log");
  auto asked = std::async(std::launch::async, [&] { return process.poll().has_value(); });
  EXPECT_EQ(asked.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  std::ofstream(gate) << "go\n";
  EXPECT_FALSE(asked.get());
  std::optional<ProcessEnd> end;
  while (!end) {
    end = process.poll();
    std::this_thread::yield();
  }
  EXPECT_TRUE(end->good);
  EXPECT_EQ(process.share(), 0.5);
  EXPECT_EQ(process.status(), "frame 3");
  EXPECT_EQ(process.take_stages(), std::vector<std::string>{"baking"});
}

TEST(RunProcess, AProgramThatIsNotThereIsNamedWithTheReason) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path());
  const std::string none = folder.path() / "none";
  try {
    const RunProcess process(none, {}, folder.path() / "log");
    ADD_FAILURE() << "it was started";
  } catch (const MachineError& e) {
    EXPECT_EQ(e.what(), none + ": cannot be started: No such file or directory");
  }
}

TEST(RunProcess, HasLargePagesUnlessTheUserSetsOtherwise) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path());
  const auto tunables = [&] {
    RunProcess process("/bin/sh", {"-c", "echo \"$GLIBC_TUNABLES\" >&2; exit 1"},
                       folder.path() / "log");
    for (;;)
      if (auto end = process.poll()) return end->message;
  };
  const char* before = std::getenv("GLIBC_TUNABLES");
  const std::string kept = before == nullptr ? "" : before;
  unsetenv("GLIBC_TUNABLES");
  EXPECT_EQ(tunables(), "glibc.malloc.hugetlb=1");
  setenv("GLIBC_TUNABLES", "glibc.malloc.check=0", 1);
  EXPECT_EQ(tunables(), "glibc.malloc.check=0");
  if (before == nullptr)
    unsetenv("GLIBC_TUNABLES");
  else
    setenv("GLIBC_TUNABLES", kept.c_str(), 1);
}

TEST(RunProcess, TellsHowItEndedAndItsLastWords) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path());
  const auto end_of = [&](const std::string& script) {
    RunProcess process("/bin/sh", {"-c", script}, folder.path() / "log");
    for (;;)
      if (auto end = process.poll()) return *end;
  };
  const ProcessEnd failed = end_of("echo begun >&2; echo no room >&2; exit 3");
  EXPECT_FALSE(failed.good);
  EXPECT_EQ(failed.code, 3);
  EXPECT_EQ(failed.signal, 0);
  EXPECT_EQ(failed.message, "no room");
  const ProcessEnd killed = end_of("kill -9 $$");
  EXPECT_FALSE(killed.good);
  EXPECT_EQ(killed.signal, 9);
}

}  // namespace
}  // namespace mh
