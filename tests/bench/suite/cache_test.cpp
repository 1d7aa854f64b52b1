// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/cache.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <map>
#include <thread>

#include <gtest/gtest.h>

#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class CacheFolder : public testing::Test {
 protected:
  CacheFolder() : folder_(fs::temp_directory_path() / ("mh_cache_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
  }
  ~CacheFolder() override { fs::remove_all(folder_); }
  std::string get(const Cache& cache, const std::string& key,
                  const std::string& content = "light") {
    return cache.get("light", key, [&] {
      ++made_;
      return content;
    });
  }
  fs::path own() const { return folder_ / Cache::kOwnFolder; }
  fs::path entry(const std::string& key) const { return own() / "light" / key; }

  fs::path folder_;
  int made_ = 0;
};

/// Every file below a folder with its content; for a link, the path it points to.
std::map<std::string, std::string> files_below(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_symlink())
      files[entry.path().string()] = fs::read_symlink(entry.path()).string();
    else if (entry.is_regular_file())
      files[entry.path().string()] = read_file(entry.path());
  return files;
}

TEST_F(CacheFolder, MakesAnEntryOnce) {
  const Cache cache(folder_);
  EXPECT_EQ(get(cache, "aa1"), "light");
  EXPECT_EQ(get(cache, "aa1"), "light");
  EXPECT_EQ(get(Cache(folder_), "aa1"), "light") << "another process finds it";
  EXPECT_EQ(made_, 1);
  get(cache, "aa2");
  EXPECT_EQ(made_, 2);
}

TEST_F(CacheFolder, ADamagedEntryIsMadeAnew) {
  const Cache cache(folder_);
  const fs::path file = entry("aa1");
  get(cache, "aa1");
  for (const auto& damage : {+[](const fs::path& f) { fs::resize_file(f, fs::file_size(f) - 1); },
                             +[](const fs::path& f) {
                               std::fstream s(f, std::ios::in | std::ios::out | std::ios::binary);
                               s.seekp(-2, std::ios::end);
                               s.put('X');
                             },
                             +[](const fs::path& f) { std::ofstream(f) << "no entry"; },
                             +[](const fs::path& f) { std::ofstream(f, std::ios::trunc); }}) {
    damage(file);
    const int before = made_;
    EXPECT_EQ(get(cache, "aa1"), "light");
    EXPECT_EQ(made_, before + 1);
    EXPECT_EQ(get(cache, "aa1"), "light");
    EXPECT_EQ(made_, before + 1);
  }
}

TEST_F(CacheFolder, AnEntryUnderAnothersNameIsMadeAnew) {
  const Cache cache(folder_);
  get(cache, "aa1");
  get(cache, "aa2");
  fs::copy_file(entry("aa1"), entry("aa2"), fs::copy_options::overwrite_existing);
  const int before = made_;
  get(cache, "aa2");
  EXPECT_EQ(made_, before + 1);
  get(cache, "aa1");
  EXPECT_EQ(made_, before + 1);
}

TEST_F(CacheFolder, ForgetsWhatWasNotReadForLongest) {
  const Cache cache(folder_, 2500);
  const std::string kilobyte(1000, 'x');
  get(cache, "aa1", kilobyte);
  get(cache, "aa2", kilobyte);
  fs::last_write_time(entry("aa2"), fs::file_time_type::clock::now() - std::chrono::hours(1));
  get(cache, "aa1", kilobyte);  // read just now
  get(cache, "aa3", kilobyte);
  EXPECT_FALSE(fs::exists(entry("aa2")));
  EXPECT_TRUE(fs::exists(entry("aa1")));
  EXPECT_TRUE(fs::exists(entry("aa3")));
}

TEST_F(CacheFolder, OneThatCannotBeWrittenCostsTimeAlone) {
  std::ofstream(folder_) << "a file where the folder should be";
  EXPECT_EQ(get(Cache(folder_), "aa1"), "light");
  EXPECT_EQ(get(Cache(), "aa1"), "light");
  EXPECT_EQ(made_, 2);
  EXPECT_NE(Cache(folder_).why_unwritable().find(folder_.string()), std::string::npos);
  fs::remove(folder_);
  EXPECT_EQ(Cache(folder_).why_unwritable(), "");
  const auto left = files_below(folder_);
  ASSERT_EQ(left.size(), 1u) << "the probe is gone";
  EXPECT_EQ(left.begin()->first, (own() / "CACHEDIR.TAG").string());
}

TEST_F(CacheFolder, TouchesNothingButItsOwnEntries) {
  const fs::path outside = folder_.string() + "_outside";
  const auto put = [](const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1000));
  };
  { get(Cache(folder_), "aa1"); }
  const std::string entry_of_old = read_file(entry("aa1"));
  // Files next to the cache's folder, inside it and behind links in it; with names like those of
  // entries, and with contents like those of entries.
  put(folder_ / "notes.txt", std::string(9000, 'n'));
  put(folder_ / "photographs" / "cat.jpg", "\xff\xd8" + std::string(9000, 'c'));
  put(folder_ / "light" / "aa9", entry_of_old);
  put(own() / "notes.txt", "kept by hand");
  put(own() / "light" / "abc123", "no entry, but named like one");
  put(own() / "light" / "my light.bin", entry_of_old);
  put(own() / "light" / "deeper" / "aa7", entry_of_old);
  put(outside / "aa5", entry_of_old);
  fs::create_directory_symlink(outside, own() / "linked");
  fs::create_symlink(outside / "aa5", entry("aa5"));
  auto before = files_below(folder_);
  before.merge(files_below(outside));
  before.erase(entry("aa1").string());

  const Cache small(folder_, 100);
  for (const char* key : {"aa2", "aa3", "aa4"}) get(small, key, std::string(1000, 'x'));
  EXPECT_FALSE(fs::exists(entry("aa1"))) << "its own are removed beyond the bound";
  EXPECT_EQ(get(small, "abc123"), "light") << "is made though another file has its name";
  EXPECT_EQ(get(small, "aa5"), "light");
  std::string gone;
  for (const auto& [file, content] : before) {
    const bool moved_aside = file == entry("abc123").string() || file == entry("aa5").string();
    const fs::path now = file + (moved_aside ? ".found" : "");
    if (!fs::exists(fs::symlink_status(now)))
      gone += now.string() + " ";
    else if (fs::is_symlink(now))
      EXPECT_EQ(fs::read_symlink(now), content);
    else
      EXPECT_EQ(read_file(now), content) << now;
  }
  EXPECT_EQ(gone, "");
  fs::remove_all(outside);
}

TEST_F(CacheFolder, AFolderOfItsNameThatIsSomebodyElsesIsLeftAlone) {
  fs::create_directories(own() / "light");
  std::ofstream(own() / "diary.txt") << "dear diary";
  const std::string why = Cache(folder_).why_unwritable();
  EXPECT_NE(why.find("is not a modelhouse cache"), std::string::npos) << why;
  EXPECT_EQ(get(Cache(folder_, 1), "aa1"), "light");
  EXPECT_EQ(files_below(folder_).size(), 1u);
  EXPECT_EQ(read_file(own() / "diary.txt"), "dear diary");
  // A link to a whole cache elsewhere is not a cache, either.
  const fs::path elsewhere = folder_.string() + "_elsewhere";
  get(Cache(elsewhere), "aa1");
  fs::remove_all(own());
  fs::create_directory_symlink(elsewhere / Cache::kOwnFolder, own());
  EXPECT_NE(Cache(folder_).why_unwritable(), "");
  fs::remove_all(elsewhere);
}

TEST_F(CacheFolder, WhoAsksMeanwhileWaitsInsteadOfMakingItTwice) {
  std::atomic<int> made = 0;
  const auto ask = [&] {
    Cache(folder_).get("light", "aa1", [&] {
      ++made;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      return std::string("light");
    });
  };
  { const std::jthread a(ask), b(ask), c(ask); }
  EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace mh
