// SPDX-License-Identifier: Apache-2.0
#include "bench/vocabulary_training.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"

namespace mh {
namespace {

VocabularyTraining small() {
  VocabularyTraining config;
  config.rooms = 2;
  config.views = 2;
  config.light_samples = 16;
  config.tree.depth = 2;
  return config;
}

TEST(TrainVocabulary, IsTheSameAtAnyThreadCountAndOtherForOtherSeeds) {
  VocabularyTraining config = small();
  config.threads = 1;
  int calls = 0;
  const Vocabulary one = train_vocabulary(config, [&](int done, int total) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(total, 2);
  });
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(one.size(), 100U);
  config.threads = 2;
  EXPECT_EQ(train_vocabulary(config).digest(), one.digest());
  config.seed = 2;
  EXPECT_NE(train_vocabulary(config).digest(), one.digest());
}

TEST(TrainVocabulary, FailuresInARoomReachTheCaller) {
  const auto stop = [](int, int) { throw std::runtime_error("stop"); };
  EXPECT_THROW(train_vocabulary(small(), stop), std::runtime_error);
}

TEST(TrainVocabulary, RefusesNonsense) {
  for (int VocabularyTraining::*field : {&VocabularyTraining::rooms, &VocabularyTraining::views,
                                         &VocabularyTraining::light_samples}) {
    VocabularyTraining config = small();
    config.*field = 0;
    EXPECT_THROW(train_vocabulary(config), InputError);
  }
}

// The file that comes with the project is whole, and its words are used evenly enough to tell
// pictures apart: few occur in more than half of them (weight below ln 2).
TEST(Assets, VocabularyHoldsWordsThatTell) {
  const Vocabulary vocabulary = Vocabulary::load(MH_SOURCE_DIR "/assets/vocabulary.mhvoc");
  EXPECT_GT(vocabulary.size(), 9000U);
  std::size_t common = 0;
  for (WordId w = 0; w < vocabulary.size(); ++w) common += vocabulary.idf(w) < 0.693F;
  EXPECT_LT(common, vocabulary.size() / 100);
}

}  // namespace
}  // namespace mh
