// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/frames_read.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

TEST(FramesRead, CountsEachImageThatWasOpenedOnce) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path());
  for (const char* name : {"1.png", "2.png", "3.png"}) write_atomically(folder.path() / name, "x");
  FramesRead read(folder.path());
  EXPECT_EQ(read.count(), 0U) << "what wrote them came before";
  for (const char* name : {"1.png", "1.png", "3.png"}) read_file(folder.path() / name);
  EXPECT_EQ(read.count(), 2U);
  EXPECT_EQ(read.count(), 2U);
  ASSERT_EQ(std::system(("cat " + (folder.path() / "2.png").string() + " >/dev/null").c_str()), 0);
  EXPECT_EQ(read.count(), 3U) << "by another process";
}

TEST(FramesRead, OfAFolderThatIsNotThereAreNone) {
  FramesRead read("/no/such/folder");
  EXPECT_EQ(read.count(), 0U);
}

}  // namespace
}  // namespace mh
