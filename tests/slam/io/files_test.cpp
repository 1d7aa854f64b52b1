// SPDX-License-Identifier: Apache-2.0
#include "slam/io/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/held_bytes.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {
namespace fs = std::filesystem;

TEST(WriteAtomically, KeepsTheOldFileWhenWritingFails) {
  const fs::path folder = fs::path(testing::TempDir()) / "write_atomically";
  fs::remove_all(folder);
  make_output_folder(folder);
  const fs::path file = folder / "result.json";
  write_atomically(file, "old");
  EXPECT_THROW(write_atomically(file,
                                [](const fs::path& temporary) {
                                  std::ofstream(temporary) << "half";
                                  throw std::runtime_error("disk full");
                                }),
               std::runtime_error);
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "a temporary was left behind";
}

TEST(ReadFile, MoreThanFourGigabytesAreNotReadAtOnce) {
  const fs::path file = fs::path(testing::TempDir()) / "enormous";
  std::ofstream{file};
  fs::resize_file(file, kMostReadAtOnce_bytes + 1);  // a hole, which takes no space on disk
  for (const auto& read :
       {+[](const fs::path& f) { read_file(f); }, +[](const fs::path& f) { map_file(f); }}) {
    try {
      read(file);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(),
                file.string() + ": cannot be read: it has 4.3 GB, at most 4.3 GB can be read");
    }
  }
  EXPECT_EQ(map_file(file, MapPages::kAsTouched).view.size(), kMostReadAtOnce_bytes + 1);
  fs::remove(file);
}

TEST(WriteAtomically, AFullDiskIsNoBadInput) {
  const fs::path folder = fs::path(testing::TempDir()) / "full_disk";
  fs::remove_all(folder);
  make_output_folder(folder);
  const fs::path file = folder / "result.json";
  write_atomically(file, "old");
  // Writing to the temporary file fails because the disk is full.
  EXPECT_THROW(write_atomically(file,
                                [](const fs::path& temporary) {
                                  fs::remove(temporary);
                                  fs::create_symlink("/dev/full", temporary);
                                  const int full = open(temporary.c_str(), O_WRONLY | O_CLOEXEC);
                                  const bool failed = write(full, "new", 3) < 0;
                                  const int error = failed ? errno : 0;
                                  close(full);
                                  throw_unwritable(temporary, error);
                                }),
               DiskFullError);
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "a temporary was left behind";
}

TEST(WriteAtomically, TakesNoNameThatIsTaken) {
  const fs::path folder = fs::path(testing::TempDir()) / "near_names";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const fs::path elsewhere = folder / "elsewhere";
  for (const fs::path& mine :
       {folder / fmt::format(".result.{}.0.tmp.json", getpid()),
        folder / fmt::format(".probe.{}.0", getpid()), folder / ".result.json", elsewhere})
    std::ofstream(mine) << "mine";
  fs::create_symlink(elsewhere, folder / fmt::format(".result.{}.1.tmp.json", getpid()));
  make_output_folder(folder);
  write_atomically(folder / "result.json", "new");
  EXPECT_EQ(read_file(folder / "result.json"), "new");
  int mine = 0;
  for (const auto& entry : fs::directory_iterator(folder))
    mine += read_file(entry.path()) == "mine" ? 1 : 0;
  EXPECT_EQ(mine, 5);
}

TEST(WriteAtomically, PutsNoFileInThePlaceOfAnythingElse) {
  EXPECT_THROW(write_atomically(testing::TempDir(), "x"), InputError);
  const fs::path pipe = fs::path(testing::TempDir()) / "no_file_to_write";
  fs::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(write_atomically(pipe, "x"), InputError);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(WriteAtomically, WritesThroughASymbolicLink) {
  const fs::path folder = fs::path(testing::TempDir()) / "write_through_link";
  fs::remove_all(folder);
  make_output_folder(folder / "disk");
  fs::create_symlink("disk/map", folder / "link");  // relative, to a file that does not exist yet
  for (const char* content : {"first", "second"}) {
    write_atomically(folder / "link", content);
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(read_file(folder / "disk/map"), content);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "disk"), {}), 1);
}

TEST(ReadFile, SaysWhetherItIsMissingOrAFolder) {
  const auto error_of = [](const fs::path& file) -> std::string {
    try {
      read_file(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of("/nowhere/a"), "/nowhere/a: cannot be read: no such file");
  EXPECT_EQ(error_of(testing::TempDir()), testing::TempDir() + ": cannot be read: it is a folder");
  const fs::path pipe = fs::path(testing::TempDir()) / "a_pipe";
  fs::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(error_of(pipe), pipe.string() + ": cannot be read: it is not a file");
  EXPECT_THROW(map_file(pipe), InputError);
}

TEST(ReadText, TakesTheMarkOfUtf8OffAndRefusesUtf16) {
  const fs::path file = fs::path(testing::TempDir()) / "marked.txt";
  for (const std::string& text : {std::string("1.0 a"), std::string(), std::string("\xef\xbb")}) {
    write_atomically(file, "\xef\xbb\xbf" + text);
    EXPECT_EQ(read_text(file), text);
    write_atomically(file, text);
    EXPECT_EQ(read_text(file), text);
  }
  for (const char* mark : {"\xff\xfe", "\xfe\xff"}) {
    write_atomically(file, mark + std::string("1\0", 2));
    try {
      read_text(file);
      ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), file.string() + ":1: is UTF-16 text: save it as UTF-8");
    }
  }
}

TEST(MakeOutputFolder, RefusesAPathThatIsAFile) {
  const fs::path file = fs::path(testing::TempDir()) / "a_file";
  std::ofstream(file) << "x";
  EXPECT_THROW(make_output_folder(file), InputError);
  EXPECT_THROW(make_output_folder(file / "below"), InputError);
}

}  // namespace
}  // namespace mh
