// SPDX-License-Identifier: Apache-2.0
#include "slam/io/read_record.hpp"

#include <fstream>
#include <functional>
#include <regex>
#include <set>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/held_bytes.hpp"
#include "slam/io/yaml.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {
namespace fs = std::filesystem;
using Kind = FileObservation::Kind;

/// A folder with a file `scene`, a file `table` and nothing else.
fs::path made_folder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / "read_record" / name;
  fs::remove_all(folder);
  make_output_folder(folder);
  write_atomically(folder / "scene", "a: 1\n");
  write_atomically(folder / "table", "b: 2\n");
  return folder;
}

ReadRecord recorded(const std::function<void()>& load) {
  const ReadScope scope;
  load();
  return scope.record();
}

std::vector<Kind> kinds(const ReadRecord& record) {
  std::vector<Kind> all;
  for (const FileObservation& o : record.observations) all.push_back(o.kind);
  return all;
}

/// Accesses a folder in every way that is recorded.
ReadRecord look_around(const fs::path& folder) {
  return recorded([&] {
    YamlReader::load(folder / "scene");
    map_file(folder / "table");
    is_there(folder / "labels");
    is_folder(folder);
    is_file(folder / "table");
    list_folder(folder, "*");
  });
}

TEST(ReadScope, NotesEveryWayOfLookingInTheirOrder) {
  const fs::path folder = made_folder("every_way");
  const ReadRecord record = look_around(folder);
  EXPECT_EQ(kinds(record), (std::vector{Kind::kRead, Kind::kRead, Kind::kAbsent, Kind::kFolder,
                                        Kind::kFile, Kind::kListed}));
  EXPECT_EQ(record.observations[0].path, folder / "scene");
  EXPECT_EQ(record.observations[2].path, folder / "labels");
}

TEST(ReadScope, WhatCannotBeReadCountsAsAbsent) {
  const fs::path folder = made_folder("unreadable");
  const ReadRecord record = recorded([&] {
    EXPECT_THROW(read_file(folder / "nothing"), InputError);
    EXPECT_THROW(map_file(folder / "nothing"), InputError);
    EXPECT_THROW(read_file(folder), InputError);
  });
  EXPECT_EQ(kinds(record), (std::vector{Kind::kAbsent, Kind::kAbsent, Kind::kAbsent}));
}

TEST(ReadScope, OuterScopesNoteWhatInnerOnesDoAndOtherThreadsNothing) {
  const fs::path folder = made_folder("nested");
  ReadRecord inner;
  const ReadRecord outer = recorded([&] {
    read_file(folder / "scene");
    inner = recorded([&] { read_file(folder / "table"); });
    std::thread([&] {
      EXPECT_FALSE(ReadScope::is_open());
      read_file(folder / "scene");
    }).join();
    ReadScope::report(inner);  // as if from another process
  });
  EXPECT_EQ(inner.observations.size(), 1U);
  ASSERT_EQ(outer.observations.size(), 3U);
  EXPECT_EQ(outer.observations[1], inner.observations[0]);
  EXPECT_EQ(outer.observations[2], inner.observations[0]);
  EXPECT_FALSE(ReadScope::is_open());
}

TEST(ReadRecord, DigestIsOfContentAndNamesNotOfThePlace) {
  const fs::path here = made_folder("here"), there = made_folder("quite/elsewhere");
  const std::uint64_t before = digest(look_around(here));
  EXPECT_EQ(before, digest(look_around(there)));
  const auto changed = [&](const std::function<void(const fs::path&)>& change) {
    const fs::path folder = made_folder("changed");
    change(folder);
    return digest(look_around(folder));
  };
  EXPECT_NE(before, changed([](const fs::path& f) { write_atomically(f / "scene", "a: 2\n"); }));
  EXPECT_NE(before, changed([](const fs::path& f) { write_atomically(f / "table", ""); }));
  EXPECT_NE(before, changed([](const fs::path& f) { write_atomically(f / "labels", ""); }));
  EXPECT_NE(before, changed([](const fs::path& f) { write_atomically(f / "z", "a: 1\n"); }));
  EXPECT_NE(before, changed([](const fs::path& f) {
              write_atomically(f / "scene", "b: 2\n");
              write_atomically(f / "table", "a: 1\n");
            }));
}

TEST(ReadRecord, SurvivesTheWayToAnotherProcess) {
  const ReadRecord record = look_around(made_folder("encoded"));
  const std::string bytes = encode(record);
  EXPECT_EQ(decode_read_record(bytes), record);
  EXPECT_EQ(decode_read_record(""), ReadRecord{});
  for (std::size_t size = 1; size < 24; ++size)
    EXPECT_THROW(decode_read_record(std::string_view(bytes).substr(0, size)), InputError);
}

// A reader that opened or looked for files without the recorder would make results that are
// outdated without notice.
TEST(ReadScope, NoReaderLooksAtFilesPastIt) {
  const std::regex past(
      R"(ifstream|fopen|imread|LoadFile|directory_iterator|zip_open\(|(fs|filesystem)::(exists|is_\w+|status)\()");
  // Exceptions: code that writes a zip, that inspects the process itself, or that checks for its
  // own files; and the cache of exposures, whose files are found by a key of everything that they
  // depend on.
  const std::set<std::string> allowed = {"file_checksums.cpp", "frame_files.cpp",
                                         "guarded_child.cpp", "label_images.cpp",
                                         "shared_exposures.cpp"};
  std::size_t files = 0;
  for (const char* part : {"scenes", "robots", "sim"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(MH_SOURCE_DIR) / part)) {
      const std::string ending = entry.path().extension().string();
      if ((ending != ".cpp" && ending != ".hpp") ||
          allowed.contains(entry.path().filename().string()))
        continue;
      ++files;
      std::istringstream lines(read_file(entry.path()));
      for (std::string line; std::getline(lines, line);)
        EXPECT_FALSE(std::regex_search(line.substr(0, line.find("//")), past))
            << entry.path() << ": " << line;
    }
  EXPECT_GT(files, 100U);
}

TEST(RequireUnchanged, SeesEveryChangeAlsoOneThatWasTakenBack) {
  const auto changes = {
      std::function<void(const fs::path&)>(
          [](const fs::path& f) { write_atomically(f, "a: 2\n"); }),
      std::function<void(const fs::path&)>([](const fs::path& f) { fs::remove(f); }),
      std::function<void(const fs::path&)>(
          [](const fs::path& f) {  // changed and changed back, with the old time
            const auto time = fs::last_write_time(f);
            std::ofstream(f) << "a: 2\n";
            std::ofstream(f) << "a: 1\n";
            fs::last_write_time(f, time);
          }),
      std::function<void(const fs::path&)>([](const fs::path& f) {  // replaced by an equal copy
        const fs::path copy = f.string() + ".copy";
        fs::copy_file(f, copy);
        fs::rename(copy, f);
      })};
  for (const auto& change : changes) {
    const fs::path folder = made_folder("unchanged");
    ReadRecord record = recorded([&] {
      read_file(folder / "scene");
      map_file(folder / "table");
      is_there(folder / "labels");
    });
    // The record also works after it was passed on by another process.
    record = decode_read_record(encode(record));
    EXPECT_NO_THROW(require_unchanged(record));
    write_atomically(folder / "other", "was not looked for");
    EXPECT_NO_THROW(require_unchanged(record));
    write_atomically(folder / "labels", "was not there");
    EXPECT_THROW(require_unchanged(record), InputChanged);
    fs::remove(folder / "labels");
    EXPECT_NO_THROW(require_unchanged(record));
    for (const char* name : {"scene", "table"}) {
      const ReadRecord before = recorded([&] { map_file(folder / name); });
      change(folder / name);
      EXPECT_THROW(require_unchanged(before), InputChanged) << name;
      EXPECT_THROW(require_unchanged(record), InputChanged) << name;
    }
  }
}

TEST(ListFolder, GivesWhatMatchesSorted) {
  const fs::path folder = made_folder("listed");
  write_atomically(folder / "b.ply", "");
  write_atomically(folder / "a.ply", "");
  write_atomically(folder / ".c.ply", "");
  EXPECT_EQ(list_folder(folder, "*.ply"), (std::vector<std::string>{"a.ply", "b.ply"}));
  EXPECT_TRUE(list_folder(folder / "none", "*").empty());
  // Files that do not match change nothing.
  const auto listing = [&] { return digest(recorded([&] { list_folder(folder, "*.ply"); })); };
  const std::uint64_t before = listing();
  write_atomically(folder / "views.png", "");
  EXPECT_EQ(listing(), before);
  fs::remove(folder / "a.ply");
  EXPECT_NE(listing(), before);
}

}  // namespace
}  // namespace mh
