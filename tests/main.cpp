// SPDX-License-Identifier: Apache-2.0
// gtest's main, with a temporary folder for each process: ctest runs tests in parallel, and two
// tests that both write testing::TempDir() + "made.yaml" would otherwise read each other's file.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  std::string folder = testing::TempDir() + "mh_test_XXXXXX";
  if (!mkdtemp(folder.data())) {
    std::perror(folder.c_str());
    return 1;
  }
  setenv("TEST_TMPDIR", folder.c_str(), 1);  // TempDir() reads it
  const int result = RUN_ALL_TESTS();
  std::error_code kept;
  std::filesystem::remove_all(folder, kept);
  return result;
}
