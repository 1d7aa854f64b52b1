// SPDX-License-Identifier: Apache-2.0
#include "slam/vocabulary/vocabulary.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <set>

#define XXH_INLINE_ALL
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

Descriptor random_descriptor(RandomStream random) {
  return {random.bits(0), random.bits(1), random.bits(2), random.bits(3)};
}

// A copy with `flips` bits changed, or fewer if a bit is drawn twice.
Descriptor near(Descriptor d, int flips, RandomStream random) {
  for (int i = 0; i < flips; ++i) {
    const std::uint64_t bit = random.below(static_cast<std::uint64_t>(i), 256);
    d[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
  return d;
}

// Images whose descriptors scatter around `clusters` random centers.
std::vector<std::vector<Descriptor>> scattered(int images, int per_image, std::uint64_t clusters,
                                               std::uint64_t seed, int flips = 20) {
  const RandomStream random(seed);
  std::vector<std::vector<Descriptor>> result(static_cast<std::size_t>(images));
  std::uint64_t n = 0;
  for (auto& image : result)
    for (int i = 0; i < per_image; ++i, ++n) {
      const RandomStream r = random.fork(n);
      const Descriptor center = random_descriptor(random.fork(1u << 30).fork(r.below(0, clusters)));
      image.push_back(near(center, flips, r.fork(1)));
    }
  return result;
}

TEST(Train, SeparatesWellSeparatedClustersExactly) {
  // Random centers are about 128 bits apart, members at most 20 bits from their center.
  const auto images = scattered(10, 100, 6, 1);
  const Vocabulary v =
      Vocabulary::train(images, {.branching = 6, .depth = 1, .max_iterations = 20, .seed = 3});
  ASSERT_EQ(v.size(), 6U);
  std::map<std::uint64_t, WordId> word_of;
  std::set<WordId> words;
  for (std::uint64_t c = 0; c < 6; ++c) {
    word_of[c] = v.quantize(random_descriptor(RandomStream(1).fork(1u << 30).fork(c))).word;
    words.insert(word_of[c]);
  }
  EXPECT_EQ(words.size(), 6U);
  std::uint64_t n = 0;
  for (const auto& image : images)
    for (const Descriptor& d : image)
      EXPECT_EQ(v.quantize(d).word, word_of[RandomStream(1).fork(n++).below(0, 6)]);
}

TEST(Train, MediansAreBitwiseMajorities) {
  // Two groups of three; each group's center is the bitwise majority of its members, although no
  // member equals it.
  const RandomStream random(5);
  std::vector<std::vector<Descriptor>> images(1);
  std::vector<Descriptor> centers;
  for (std::uint64_t c = 0; c < 2; ++c) {
    centers.push_back(random_descriptor(random.fork(c)));
    for (std::uint64_t m = 0; m < 3; ++m) {
      Descriptor d = centers.back();
      d[m] ^= 0xffULL << (8 * c);  // each member differs in a different place
      images[0].push_back(d);
    }
  }
  const Vocabulary v = Vocabulary::train(images, {.branching = 2, .depth = 1, .seed = 1});
  ASSERT_EQ(v.size(), 2U);
  // With centers c0 and c1, the border between the words is where the distances are equal.
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Descriptor d = random_descriptor(random.fork(100 + i));
    const int to_0 = hamming(d, centers[0]), to_1 = hamming(d, centers[1]);
    if (to_0 == to_1) continue;
    EXPECT_EQ(v.quantize(d).word, v.quantize(centers[to_0 < to_1 ? 0 : 1]).word);
  }
}

TEST(Train, FewDescriptorsBecomeWordsThemselves) {
  const auto images = scattered(1, 9, 9000, 6);
  const Vocabulary v = Vocabulary::train(images, {.branching = 10, .depth = 3});
  ASSERT_EQ(v.size(), 9U);
  // The depth is effectively 1: quantizing finds the nearest of the nine, checked by brute force.
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Descriptor d = random_descriptor(RandomStream(7).fork(i));
    int best = 257;
    for (const Descriptor& leaf : images[0]) best = std::min(best, hamming(leaf, d));
    bool is_nearest = false;
    for (const Descriptor& leaf : images[0])
      is_nearest |= hamming(leaf, d) == best && v.quantize(leaf).word == v.quantize(d).word;
    EXPECT_TRUE(is_nearest);
  }
}

TEST(Train, ManyCopiesOfOneDescriptorAreOneWord) {
  const Descriptor d = random_descriptor(RandomStream(8));
  const std::vector<std::vector<Descriptor>> images(3, std::vector<Descriptor>(50, d));
  const Vocabulary v = Vocabulary::train(images, {});
  EXPECT_EQ(v.size(), 1U);
  EXPECT_EQ(v.idf(0), 0.0F);  // the word is in every image and carries no information
}

TEST(Train, EveryWordOccursAndWeighsItsInverseDocumentFrequency) {
  const auto images = scattered(30, 100, 200, 9, 40);
  const Vocabulary v = Vocabulary::train(images, {.branching = 5, .depth = 4, .seed = 2});
  EXPECT_GT(v.size(), 200U);
  EXPECT_LE(v.size(), 625U);
  std::vector<std::set<std::size_t>> images_with(v.size());
  for (std::size_t i = 0; i < images.size(); ++i)
    for (const Descriptor& d : images[i]) images_with[v.quantize(d).word].insert(i);
  for (WordId w = 0; w < v.size(); ++w) {
    ASSERT_FALSE(images_with[w].empty()) << w;
    EXPECT_FLOAT_EQ(
        v.idf(w), static_cast<float>(std::log(30.0 / static_cast<double>(images_with[w].size()))));
  }
}

TEST(Train, SameSeedSameBytesOtherSeedOtherBytes) {
  const auto images = scattered(20, 100, 100, 10, 60);
  const Vocabulary a = Vocabulary::train(images, {.depth = 3, .seed = 1});
  EXPECT_EQ(a.digest(), Vocabulary::train(images, {.depth = 3, .seed = 1}).digest());
  EXPECT_NE(a.digest(), Vocabulary::train(images, {.depth = 3, .seed = 2}).digest());
}

TEST(Train, RefusesNothingAndNonsense) {
  EXPECT_THROW(Vocabulary::train({}, {}), InputError);
  const std::vector<std::vector<Descriptor>> no_features(5);
  EXPECT_THROW(Vocabulary::train(no_features, {}), InputError);
  const auto images = scattered(1, 10, 5, 11);
  EXPECT_THROW(Vocabulary::train(images, {.branching = 1}), std::invalid_argument);
  EXPECT_THROW(Vocabulary::train(images, {.branching = 256}), std::invalid_argument);
  EXPECT_THROW(Vocabulary::train(images, {.depth = 0}), std::invalid_argument);
  EXPECT_THROW(Vocabulary::train(images, {.max_iterations = 0}), std::invalid_argument);
}

TEST(Quantize, NodesOfTheDirectIndexGroupWords) {
  const auto images = scattered(40, 200, 2000, 12, 30);
  const Vocabulary v = Vocabulary::train(images, {.branching = 5, .depth = 4});
  std::map<WordId, std::uint32_t> node_of;
  std::set<std::uint32_t> nodes;
  for (const auto& image : images)
    for (const Descriptor& d : image) {
      const Vocabulary::Quantized q = v.quantize(d);
      EXPECT_EQ(node_of.try_emplace(q.word, q.node).first->second, q.node);
      nodes.insert(q.node);
    }
  EXPECT_EQ(node_of.size(), v.size());
  EXPECT_LE(nodes.size(), 25U);  // branching^2
  EXPECT_GE(nodes.size(), 20U);
}

// ---- files ----

class VocabularyFile : public testing::Test {
 protected:
  VocabularyFile()
      : folder_(fs::path(testing::TempDir()) /
                testing::UnitTest::GetInstance()->current_test_info()->name()),
        file_(folder_ / "words.mhv"),
        vocabulary_(Vocabulary::train(scattered(10, 100, 50, 13), {.branching = 4, .depth = 3})) {
    fs::remove_all(folder_);
    make_output_folder(folder_);
    vocabulary_.save(file_);
    bytes_ = read_file(file_);
  }
  ~VocabularyFile() override { fs::remove_all(folder_); }

  void rewrite(const std::string& bytes) {
    std::ofstream(file_, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
  }
  // The bytes with a corrected checksum, so that the checks after that of the checksum are reached.
  static std::string signed_again(std::string bytes) {
    const std::uint64_t sum = XXH3_64bits(bytes.data(), bytes.size() - 8);
    std::memcpy(bytes.data() + bytes.size() - 8, &sum, 8);
    return bytes;
  }
  std::string message_of_loading() const {
    try {
      Vocabulary::load(file_);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file_.string()));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "no error";
  }

  fs::path folder_, file_;
  Vocabulary vocabulary_;
  std::string bytes_;
};

TEST_F(VocabularyFile, HoldsTheSameVocabulary) {
  const Vocabulary loaded = Vocabulary::load(file_);
  EXPECT_EQ(loaded.digest(), vocabulary_.digest());
  EXPECT_EQ(loaded.branching(), 4);
  EXPECT_EQ(loaded.depth(), 3);
  ASSERT_EQ(loaded.size(), vocabulary_.size());
  for (WordId w = 0; w < loaded.size(); ++w) EXPECT_EQ(loaded.idf(w), vocabulary_.idf(w));
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Descriptor d = random_descriptor(RandomStream(14).fork(i));
    EXPECT_EQ(loaded.quantize(d).word, vocabulary_.quantize(d).word);
    EXPECT_EQ(loaded.quantize(d).node, vocabulary_.quantize(d).node);
  }
}

TEST_F(VocabularyFile, Missing) {
  fs::remove(file_);
  EXPECT_THAT(message_of_loading(), HasSubstr("no such file"));
}

TEST_F(VocabularyFile, IsAFolder) {
  fs::remove(file_);
  fs::create_directory(file_);
  EXPECT_THAT(message_of_loading(), HasSubstr("cannot be read"));
}

TEST_F(VocabularyFile, IsNoVocabulary) {
  for (const char* text : {"", "x", "%YAML:1.0\nnot: this\n", "MHVOCAX\n and so on"}) {
    rewrite(text);
    EXPECT_THAT(message_of_loading(), HasSubstr("is not a Modelhouse vocabulary"));
  }
}

TEST_F(VocabularyFile, IsOfAnotherVersion) {
  bytes_[8] = 7;
  rewrite(bytes_);
  EXPECT_THAT(message_of_loading(), HasSubstr("of version 7, but this program reads 2"));
}

TEST_F(VocabularyFile, CutShortAnywhere) {
  for (std::size_t size = 1; size < bytes_.size(); size += size < 40 ? 1 : 97) {
    rewrite(bytes_.substr(0, size));
    EXPECT_THAT(message_of_loading(),
                HasSubstr("truncated: has " + std::to_string(size) + " bytes, needs"));
  }
  rewrite(bytes_.substr(0, bytes_.size() - 1));
  EXPECT_THAT(message_of_loading(), HasSubstr("needs " + std::to_string(bytes_.size())));
}

TEST_F(VocabularyFile, TooLong) {
  rewrite(bytes_ + "x");
  EXPECT_THAT(message_of_loading(), HasSubstr("too long"));
}

TEST_F(VocabularyFile, DamagedAnywhereBehindTheHeader) {
  for (std::size_t at = 28; at < bytes_.size(); at += 53) {
    std::string damaged = bytes_;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    rewrite(damaged);
    EXPECT_THAT(message_of_loading(), HasSubstr("checksum")) << at;
  }
}

TEST_F(VocabularyFile, SignedNonsenseIsRefusedToo) {
  std::uint32_t nodes = 0, words = 0;
  std::memcpy(&nodes, bytes_.data() + 20, 4);
  std::memcpy(&words, bytes_.data() + 24, 4);
  const std::size_t idf = 64 + 32 * std::size_t{nodes}, child_counts = idf + 4 * std::size_t{words};
  std::string more_children = bytes_;
  more_children[child_counts] = 100;
  rewrite(signed_again(more_children));
  EXPECT_THAT(message_of_loading(), HasSubstr("not a consistent tree"));
  std::string fewer_children = bytes_;
  fewer_children[child_counts] = 0;
  rewrite(signed_again(fewer_children));
  EXPECT_THAT(message_of_loading(), HasSubstr("not a consistent tree"));
  std::string negative = bytes_;
  negative[child_counts - 1] = static_cast<char>(0xff);  // the last byte of the last weight
  rewrite(signed_again(negative));
  EXPECT_THAT(message_of_loading(), HasSubstr("weight"));
}

// A mapped file remains readable when its name refers to a different file.
TEST_F(VocabularyFile, StaysWholeWhenTheFileIsReplacedOrRemoved) {
  const Vocabulary loaded = Vocabulary::load(file_);
  Vocabulary::train(scattered(10, 100, 50, 99), {.branching = 4, .depth = 3}).save(file_);
  const Vocabulary copy = loaded;
  fs::remove(file_);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Descriptor d = random_descriptor(RandomStream(15).fork(i));
    EXPECT_EQ(copy.quantize(d).word, vocabulary_.quantize(d).word);
  }
}

TEST_F(VocabularyFile, SaysWhatItWasTrainedOn) {
  EXPECT_EQ(Vocabulary::load(file_).training_images(), 10U);
  EXPECT_EQ(Vocabulary::load(file_).training_descriptors(), 1000U);
  EXPECT_EQ(Vocabulary().digest(), 0U);
}

TEST_F(VocabularyFile, SavingWhereNothingCanBeWrittenLeavesNothing) {
  EXPECT_THROW(vocabulary_.save(folder_ / "no_folder" / "words.mhv"), InputError);
  EXPECT_FALSE(fs::exists(folder_ / "no_folder"));
}

}  // namespace
}  // namespace mh
