// SPDX-License-Identifier: Apache-2.0
#include "slam/io/remove_tree.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Does `work` in a separate process without the rights of root, since root may do anything.
void as_nobody(const std::function<void()>& work) {
  const pid_t process = fork();
  if (process == 0) {
    constexpr uid_t kNobody = 65534;
    if (geteuid() == 0 && setresuid(kNobody, kNobody, kNobody) != 0) _exit(2);
    work();
    _exit(0);
  }
  int status = -1;
  waitpid(process, &status, 0);
  ASSERT_EQ(status, 0);
}

TEST(RemoveTree, RemovesWhatAProgramMadeOfIt) {
  const fs::path tree = fs::temp_directory_path() / ("mh_tree_" + std::to_string(getpid()));
  const fs::path outside = fs::temp_directory_path() / ("mh_kept_" + std::to_string(getpid()));
  std::ofstream(outside) << "mine";
  as_nobody([&] {
    fs::create_directories(tree / "locked" / "inner");
    std::ofstream(tree / "locked" / "inner" / "a\nfile") << "x";
    mkfifo((tree / "pipe").c_str(), 0600);
    fs::create_symlink(outside, tree / "link");
    fs::create_directory_symlink(tree, tree / "locked" / "circle");
    // Deeper than the longest possible path, and than the number of files that can be open.
    int here = open(tree.c_str(), O_RDONLY | O_DIRECTORY);
    for (int depth = 0; depth < 3000; ++depth) {
      mkdirat(here, "deep", 0700);
      const int inner = openat(here, "deep", O_RDONLY | O_DIRECTORY);
      close(here);
      here = inner;
    }
    close(here);
    fs::permissions(tree / "locked" / "inner", fs::perms::none);
    fs::permissions(tree / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    fs::permissions(tree, fs::perms::owner_read | fs::perms::owner_exec);
    remove_tree(tree.c_str());
  });
  EXPECT_FALSE(fs::exists(fs::symlink_status(tree)));
  EXPECT_EQ(fs::file_size(outside), 4u) << "what a link leads to is not ours";
  fs::create_symlink(outside, tree);
  remove_tree(tree.c_str());
  EXPECT_FALSE(fs::exists(fs::symlink_status(tree)));
  EXPECT_TRUE(fs::exists(outside));
  fs::remove(outside);
}

}  // namespace
}  // namespace mh
