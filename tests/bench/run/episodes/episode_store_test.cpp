// SPDX-License-Identifier: Apache-2.0
#include "bench/run/episodes/episode_store.hpp"

#include <filesystem>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class EpisodeStores : public testing::Test {
 protected:
  EpisodeStores() {
    EpisodeStore store(file_);
    for (std::size_t start = 0; start < 20; ++start)
      store.put("key", "plain-0", {.variant = "as_mapped", .start = start, .goal = "sofa"});
  }
  void expect_refused(const char* why) const {
    try {
      const EpisodeStore store(file_);
      ADD_FAILURE() << "was read; expected: " << why;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  }

  TemporaryFolder folder_{fs::temp_directory_path()};
  fs::path file_ = folder_.path() / "episodes.sqlite";
};

TEST_F(EpisodeStores, KeepsWhatWasPut) {
  const EpisodeStore store(file_);
  ASSERT_EQ(store.load("key").size(), 20U);
  EXPECT_EQ(store.load("key")[7].start, 7U);
  EXPECT_TRUE(store.load("another").empty());
}

TEST_F(EpisodeStores, AChangedNumberIsNoticed) {
  SQLite::Database(file_.string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE episodes SET spl = 0.99 WHERE start = 3");
  expect_refused("is damaged: row (key, as_mapped, 3) of its table 'episodes'");
}

TEST_F(EpisodeStores, ATruncatedFileIsNotBegunAnew) {
  fs::resize_file(file_, 5000);
  expect_refused("is damaged");
  EXPECT_EQ(fs::file_size(file_), 5000U);
}

TEST_F(EpisodeStores, AnotherFileIsRefused) {
  fs::remove(file_);
  {
    SQLite::Database(file_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
        .exec("CREATE TABLE a (b)");
  }
  expect_refused("is no file of episodes");
}

}  // namespace
}  // namespace mh
