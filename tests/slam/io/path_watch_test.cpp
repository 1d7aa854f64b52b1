// SPDX-License-Identifier: Apache-2.0
#include "slam/io/path_watch.hpp"

#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include "slam/io/read_record.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

TEST(PathWatch, NoticesAPathThatLedElsewhereForAMomentAndNothingElse) {
  const TemporaryFolder temporary(testing::TempDir());
  const fs::path root = temporary.path();
  for (const char* name : {"a", "b"}) {
    fs::create_directories(root / name);
    std::ofstream(root / name / "program.py") << name;
  }
  fs::create_symlink("a", root / "now");
  const auto exchange = [&] {
    fs::rename(root / "a", root / "aside");
    fs::rename(root / "b", root / "a");
    fs::rename(root / "aside", root / "b");
  };
  const auto said = [&](const fs::path& file, const std::function<void()>& change) -> std::string {
    const fs::path files[] = {file};
    PathWatch watch(files);
    watch.require_unmoved();
    change();
    try {
      watch.require_unmoved();
    } catch (const InputChanged& error) {
      return error.what();
    }
    return "";
  };
  const auto twice = [&] { exchange(), exchange(); };
  const auto relink = [&] {
    for (const char* to : {"b", "a"}) {
      fs::remove(root / "now");
      fs::create_symlink(to, root / "now");
    }
  };
  const auto nothing = [&] {
    std::ofstream(root / "a" / "output") << "x";
    fs::create_directories(root / "a" / "__pycache__");
    std::ofstream(root / "b" / "program.py") << "another";
  };
  EXPECT_NE(said(root / "a" / "program.py", twice).find((root / "a").string()), std::string::npos);
  EXPECT_NE(said(root / "now" / "program.py", twice).find((root / "a").string()),
            std::string::npos);
  EXPECT_NE(said(root / "now" / "program.py", relink).find((root / "now").string()),
            std::string::npos);
  EXPECT_EQ(said(root / "a" / "program.py", relink), "");
  EXPECT_EQ(said(root / "now" / "program.py", nothing), "");
  EXPECT_EQ(said(root / "no" / "such", nothing), "");
}

}  // namespace
}  // namespace mh
