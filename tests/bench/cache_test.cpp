// SPDX-License-Identifier: Apache-2.0
#include "bench/cache/cache.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

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
  fs::path folder_;
  int made_ = 0;
};

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
  const fs::path file = folder_ / "light" / "aa1";
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

TEST_F(CacheFolder, ForgetsWhatWasNotReadForLongest) {
  const Cache cache(folder_, 2500);
  const std::string kilobyte(1000, 'x');
  get(cache, "aa1", kilobyte);
  get(cache, "aa2", kilobyte);
  fs::last_write_time(folder_ / "light" / "aa2",
                      fs::file_time_type::clock::now() - std::chrono::hours(1));
  get(cache, "aa1", kilobyte);  // read just now
  get(cache, "aa3", kilobyte);
  EXPECT_FALSE(fs::exists(folder_ / "light" / "aa2"));
  EXPECT_TRUE(fs::exists(folder_ / "light" / "aa1"));
  EXPECT_TRUE(fs::exists(folder_ / "light" / "aa3"));
}

TEST_F(CacheFolder, OneThatCannotBeWrittenCostsTimeAlone) {
  std::ofstream(folder_) << "a file where the folder should be";
  EXPECT_EQ(get(Cache(folder_), "aa1"), "light");
  EXPECT_EQ(get(Cache(), "aa1"), "light");
  EXPECT_EQ(made_, 2);
  EXPECT_NE(Cache(folder_).why_unwritable().find(folder_.string()), std::string::npos);
  fs::remove(folder_);
  EXPECT_EQ(Cache(folder_).why_unwritable(), "");
  EXPECT_TRUE(fs::is_empty(folder_)) << "the probe is gone";
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
