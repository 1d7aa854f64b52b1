// SPDX-License-Identifier: Apache-2.0
#include "slam/io/temporary_folder.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class TemporaryFolders : public testing::Test {
 protected:
  TemporaryFolders() : folder_(fs::temp_directory_path() / fmt::format("mh_work_{}", getpid())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~TemporaryFolders() override { fs::remove_all(folder_); }

  /// The folder that a killed process leaves behind, with a file in it.
  fs::path left_by_a_killed_process() const {
    if (const pid_t process = fork(); process == 0) {
      const TemporaryFolder work(folder_);
      std::ofstream(work.path() / "half a file") << "half";
      kill(getpid(), SIGKILL);
    } else {
      waitpid(process, nullptr, 0);
    }
    for (const auto& entry : fs::directory_iterator(folder_))
      if (fs::exists(entry.path() / "half a file")) return entry.path();
    return {};
  }
  fs::path folder_;
};

TEST_F(TemporaryFolders, GoWhenTheyAreLeftAndAfterTheirOwnersDeath) {
  const fs::path left = left_by_a_killed_process();
  ASSERT_FALSE(left.empty());
  {
    const TemporaryFolder work(folder_);
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::is_directory(work.path()));
    const TemporaryFolder other(folder_);
    EXPECT_TRUE(fs::is_directory(work.path())) << "its owner lives";
    EXPECT_NE(work.path(), other.path());
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(TemporaryFolders, WhatOthersNamedAlikeStays) {
  const fs::path left = left_by_a_killed_process();
  const std::string name = left.filename().string();
  const std::string host = name.substr(0, name.find('.', 6));  // ".work.HOST"
  const fs::path elsewhere = folder_ / "photographs";
  fs::create_directories(elsewhere);
  std::ofstream(elsewhere / "cat.jpg") << "mine";
  fs::copy(left / OwnedFolder::kMarker, elsewhere / OwnedFolder::kMarker);
  // A folder of a process that cannot exist: ids end at 2^22.
  const fs::path no_marker = folder_ / (host + ".99999999.0");
  fs::create_directories(no_marker);
  std::ofstream(no_marker / "notes.txt") << "mine";
  const fs::path other_marker = folder_ / (host + ".99999999.1");
  fs::create_directories(other_marker);
  std::ofstream(other_marker / OwnedFolder::kMarker) << "mine";
  const fs::path link = folder_ / (host + ".99999999.2");
  fs::create_directory_symlink(elsewhere, link);
  const fs::path file = folder_ / (host + ".99999999.3");
  std::ofstream(file) << "mine";
  // A link inside a folder of ours is removed, but not the folder that it points to.
  fs::create_directory_symlink(elsewhere, left / "linked");
  { const TemporaryFolder work(folder_); }
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(read_file(no_marker / "notes.txt"), "mine");
  EXPECT_EQ(read_file(other_marker / OwnedFolder::kMarker), "mine");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_file(elsewhere / "cat.jpg"), "mine");
  EXPECT_EQ(read_file(file), "mine");
}

TEST_F(TemporaryFolders, AnOwnedFolderIsTakenByOneAtATime) {
  const fs::path place = folder_ / "place";
  EXPECT_FALSE(OwnedFolder::take(place)) << "there is none";
  {
    auto made = OwnedFolder::make(place);
    ASSERT_TRUE(made);
    std::ofstream(place / "result") << "1";
    EXPECT_FALSE(OwnedFolder::make(place));
    EXPECT_FALSE(OwnedFolder::take(place)) << "its owner holds it";
  }
  EXPECT_EQ(read_file(place / "result"), "1") << "it stays when it is let go of";
  auto taken = OwnedFolder::take(place);
  ASSERT_TRUE(taken);
  taken->remove();
  EXPECT_FALSE(fs::exists(place));
}

TEST_F(TemporaryFolders, AHeldFolderIsSharedByThoseOfTheSameWorkAlone) {
  std::string recorded;
  const auto join = [&](FolderHold& hold, const std::string& work) {
    hold.join([&] { recorded = work; }, [&] { return recorded == work; });
  };
  {
    FolderHold alone(folder_), late(folder_);
    alone.take();
    EXPECT_THROW(late.take(), InputError);
    EXPECT_THROW(join(late, "a"), InputError);
    EXPECT_EQ(recorded, "");
  }
  {
    FolderHold first(folder_), second(folder_), other(folder_);
    join(first, "a");
    EXPECT_NO_THROW(join(second, "a"));
    EXPECT_THROW(join(other, "b"), InputError);
    EXPECT_THROW(other.take(), InputError);
    EXPECT_EQ(recorded, "a");
  }
  FolderHold next(folder_);
  join(next, "b");
  EXPECT_EQ(recorded, "b") << "nobody was left";
}

}  // namespace
}  // namespace mh
