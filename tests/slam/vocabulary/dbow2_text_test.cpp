// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/vocabulary/tree.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {
namespace {
namespace fs = std::filesystem;
using testing::StartsWith;

Descriptor drawn_descriptor(RandomStream random) {
  return {random.bits(0), random.bits(1), random.bits(2), random.bits(3)};
}

// A full tree in DBoW2's text format. DBoW2's own writer numbers the children of a node one after
// the other and then descends into the first of them; so does this one. The id of a node is the
// number of its line after the first.
class TextWriter {
 public:
  TextWriter(int k, int depth) : k_(k), depth_(depth) {
    text_ = fmt::format("{} {} 0 0 \n", k, depth);
    expand(0, 1);
  }
  const std::string& text() const { return text_; }
  Descriptor center(int id) const { return drawn_descriptor(RandomStream(1).fork(id)); }
  float weight(int id) const { return static_cast<float>(id) / 7; }

  // The leaf at which a walk through the written tree ends.
  int walk(const Descriptor& d) const {
    int node = 0;
    while (!children_.at(node).empty()) {
      const auto& children = children_.at(node);
      node = *std::ranges::min_element(children, {},
                                       [&](int child) { return hamming(center(child), d); });
    }
    return node;
  }

 private:
  void expand(int node, int level) {
    const int first = next_;
    for (int i = 0; i < k_; ++i) {
      const int id = next_++;
      children_[node].push_back(id);
      children_[id];
      text_ += fmt::format("{} {} ", node, level == depth_ ? 1 : 0);
      const Descriptor d = center(id);
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(d.data());
      for (std::size_t b = 0; b < sizeof d; ++b) text_ += fmt::format("{} ", bytes[b]);
      text_ += fmt::format("{}\n", level == depth_ ? weight(id) : 0.0F);
    }
    if (level < depth_)
      for (int i = 0; i < k_; ++i) expand(first + i, level + 1);
  }

  int k_, depth_, next_ = 1;
  std::string text_;
  std::map<int, std::vector<int>> children_;
};

TEST(Dbow2Text, WalksTheSameTreeToTheSameWeight) {
  const TextWriter written(5, 4);
  const VocabularyTree tree = read_dbow2_text(written.text(), "t.txt");
  EXPECT_EQ(tree.branching, 5U);
  EXPECT_EQ(tree.depth, 4U);
  EXPECT_EQ(tree.centers.size(), 1U + 5 + 25 + 125 + 625);
  const Vocabulary v(tree);
  ASSERT_EQ(v.size(), 625U);
  std::map<WordId, int> leaf_of;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Descriptor d = drawn_descriptor(RandomStream(2).fork(i));
    const int leaf = written.walk(d);
    const WordId word = v.quantize(d).word;
    EXPECT_EQ(v.idf(word), written.weight(leaf));
    EXPECT_EQ(leaf_of.try_emplace(word, leaf).first->second, leaf);  // one leaf for each word
  }
  EXPECT_GT(leaf_of.size(), 300U);
}

TEST(Dbow2Text, BytesOfADescriptorStandInTheOrderOfOpenCv) {
  // Byte 0 of a row contains tests 0 to 7, the lowest bit first.
  std::string zeros, ones;
  for (int b = 1; b < 32; ++b) zeros += " 0", ones += " 255";
  const VocabularyTree tree =
      read_dbow2_text("2 1 0 0\n0 1 5" + zeros + " 1.5\n0 1 0" + ones + " 0", "t.txt");
  ASSERT_EQ(tree.centers.size(), 3U);
  EXPECT_EQ(tree.centers[1], (Descriptor{5, 0, 0, 0}));
  EXPECT_EQ(tree.centers[2], (Descriptor{~0xffULL, ~0ULL, ~0ULL, ~0ULL}));
  EXPECT_EQ(tree.idf, (std::vector<float>{1.5F, 0.0F}));
}

TEST(Dbow2Text, LeavesMayStandAtAnyLevelAndLinesEndAsInDos) {
  const std::string d = " 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 ";
  const VocabularyTree tree = read_dbow2_text(
      "3 2 0 0\r\n0 1" + d + "1 0.5\r\n0 0" + d + "2 0\r\n2 1" + d + "3 2.5 \r\n\r\n", "t.txt");
  EXPECT_EQ(tree.child_counts, (std::vector<std::uint8_t>{2, 0, 1, 0}));
  EXPECT_EQ(tree.idf, (std::vector<float>{0.5F, 2.5F}));
  EXPECT_EQ(Vocabulary(tree).size(), 2U);
}

TEST(Dbow2Text, IsWrittenAsItsReadersExpectIt) {
  // By hand: a root with a word and a node of two words, written as by DBoW2's TemplatedVocabulary.
  VocabularyTree tree;
  tree.branching = tree.depth = 2;
  const Descriptor a{1, 0, 0, 0}, b{0x0201, 0, 0, 0}, c{0, 0, 0, 0xffULL << 56U}, d{2, 0, 0, 0};
  tree.centers = {Descriptor{}, a, b, c, d};
  tree.child_counts = {2, 0, 2, 0, 0};
  tree.idf = {0.1F, 2.5F, 0.0F};
  std::string zeros30, zeros31;
  for (int i = 0; i < 31; ++i) zeros31 += " 0", zeros30 += i < 30 ? " 0" : "";
  EXPECT_EQ(dbow2_text(tree), "2 2 0 0\n0 1 1" + zeros31 + " 0.1\n0 0 1 2" + zeros30 + " 0\n2 1" +
                                  zeros31 + " 255 2.5\n2 1 2" + zeros31 + " 0")
      << "no line end at the end: ORB-SLAM would take what follows it for a node";
  tree.branching = 21;
  EXPECT_THROW(dbow2_text(tree), InputError);
}

TEST(Dbow2Text, RoundTripKeepsEveryDescriptorWeightAndParent) {
  std::vector<std::vector<Descriptor>> images(30);
  for (std::size_t i = 0; i < images.size(); ++i)
    for (std::uint64_t k = 0; k < 40; ++k)
      images[i].push_back(drawn_descriptor(RandomStream(i).fork(k)));
  const Vocabulary trained = Vocabulary::train(images, {.branching = 7, .depth = 3});
  const fs::path folder = fs::path(testing::TempDir()) / "dbow2_round_trip";
  make_output_folder(folder);
  trained.save_dbow2(folder / "words.txt");
  const VocabularyTree once = read_dbow2_text(read_file(folder / "words.txt"), "t.txt");
  EXPECT_EQ(once.centers.size(), trained.node_count());
  ASSERT_EQ(once.idf.size(), trained.size());
  for (WordId word = 0; word < trained.size(); ++word) EXPECT_EQ(once.idf[word], trained.idf(word));
  const Vocabulary again(once);
  for (const Descriptor& d : images[3]) {
    EXPECT_EQ(again.quantize(d).word, trained.quantize(d).word);
    EXPECT_EQ(again.quantize(d).node, trained.quantize(d).node);
  }
  const VocabularyTree twice = read_dbow2_text(dbow2_text(once), "t.txt");
  EXPECT_EQ(twice.centers, once.centers);
  EXPECT_EQ(twice.child_counts, once.child_counts);
  EXPECT_EQ(twice.idf, once.idf);
}

TEST(Dbow2Text, IsLoadedLikeAFileOfOurOwnAndSavedAsOne) {
  const fs::path folder = fs::path(testing::TempDir()) / "dbow2_text";
  make_output_folder(folder);
  write_atomically(folder / "words.txt", TextWriter(4, 3).text());
  const Vocabulary text = Vocabulary::load(folder / "words.txt");
  text.save(folder / "words.mhvoc");
  const Vocabulary own = Vocabulary::load(folder / "words.mhvoc");
  EXPECT_EQ(own.size(), 64U);
  EXPECT_EQ(own.digest(), text.digest());
  EXPECT_EQ(own.training_images(), 0U);  // not known
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Descriptor d = drawn_descriptor(RandomStream(3).fork(i));
    EXPECT_EQ(own.quantize(d).word, text.quantize(d).word);
    EXPECT_EQ(own.quantize(d).node, text.quantize(d).node);
  }
  fs::remove_all(folder);
}

TEST(Dbow2Text, FaultsAreToldWithTheirLine) {
  const auto fault_of = [](const std::string& text) -> std::string {
    try {
      read_dbow2_text(text, "t.txt");
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "no error";
  };
  const std::string d =
      " 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27"
      " 28 29 30 31 ";
  const std::string leaf = "0 1" + d + "32 0.5\n", inner = "0 0" + d + "32 0\n";
  ASSERT_EQ(fault_of("2 2 0 0\n" + leaf), "no error");

  EXPECT_EQ(fault_of(" \n"), "t.txt: is empty");
  EXPECT_EQ(fault_of("10 6 0 0\n"), "t.txt:1: holds no node");
  EXPECT_EQ(fault_of("10 6 0\n" + leaf), "t.txt:1: line ends where weighting is expected");
  EXPECT_EQ(fault_of("10 6 0 0 9\n" + leaf), "t.txt:1: line continues where it should end: '9'");
  EXPECT_EQ(fault_of("1 6 0 0\n" + leaf), "t.txt:1: k: 1 is not from 2 to 20");
  EXPECT_EQ(fault_of("99999999999 6 0 0\n" + leaf), "t.txt:1: k: 99999999999 is not from 2 to 20");
  EXPECT_EQ(fault_of("10 11 0 0\n" + leaf), "t.txt:1: L: 11 is not from 1 to 10");
  EXPECT_EQ(fault_of("10 6 7 0\n" + leaf), "t.txt:1: scoring: 7 is not from 0 to 5");
  EXPECT_EQ(fault_of("10 6 0 4\n" + leaf), "t.txt:1: weighting: 4 is not from 0 to 3");
  EXPECT_EQ(fault_of("ten 6 0 0\n" + leaf), "t.txt:1: k: 'ten' is not a valid number here");

  const std::string head = "2 2 0 0\n" + leaf;
  EXPECT_EQ(fault_of(head + "3 1" + d + "32 0.5\n"),
            "t.txt:3: the parent: there is no node 3 before this line");
  EXPECT_EQ(fault_of(head + "2 1" + d + "32 0.5\n"),  // its parent is itself
            "t.txt:3: the parent: there is no node 2 before this line");
  EXPECT_EQ(fault_of(head + "-1 1" + d + "32 0.5\n"),
            "t.txt:3: the parent: there is no node -1 before this line");
  EXPECT_EQ(fault_of(head + "1 1" + d + "32 0.5\n"), "t.txt:3: the parent: node 1 is a leaf");
  EXPECT_EQ(fault_of(head + leaf + leaf), "t.txt:4: node 0 has more than the 2 children of line 1");
  EXPECT_EQ(fault_of("2 1 0 0\n" + inner + "1 1" + d + "32 0.5\n"),
            "t.txt:3: deeper than the 1 levels of line 1");
  EXPECT_EQ(fault_of(head + inner), "t.txt:3: is not a leaf and has no child in the whole file");
  EXPECT_EQ(fault_of(head + "0 2" + d + "32 0.5\n"), "t.txt:3: is-leaf: 2 is not from 0 to 1");
  EXPECT_EQ(fault_of(head + "0 1" + d + "256 0.5\n"),
            "t.txt:3: a byte of the descriptor: 256 is not from 0 to 255");
  EXPECT_EQ(fault_of(head + "0 1" + d + "3.5 0.5\n"),
            "t.txt:3: a byte of the descriptor: '3.5' is not a valid number here");
  EXPECT_EQ(fault_of(head + "0 1" + d + "\n"),
            "t.txt:3: line ends where a byte of the descriptor is expected");
  EXPECT_EQ(fault_of(head + "0 1" + d + "32\n"), "t.txt:3: line ends where the weight is expected");
  EXPECT_EQ(fault_of(head + "0 1" + d + "32 0.5 7\n"),
            "t.txt:3: line continues where it should end: '7'");
  EXPECT_EQ(fault_of(head + "0 1" + d + "32 nan\n"),
            "t.txt:3: the weight: nan is not a number from 0");
  EXPECT_EQ(fault_of(head + "0 1" + d + "32 -0.5\n"),
            "t.txt:3: the weight: -0.5 is not a number from 0");
  EXPECT_EQ(fault_of("2 2 0 0\n\n" + leaf), "t.txt:2: line ends where the parent is expected");
}

TEST(Dbow2Text, CutShortAnywhereIsRefusedOrHoldsFewerWords) {
  const std::string whole = TextWriter(3, 3).text();
  std::size_t refused = 0, read = 0;
  for (std::size_t size = 0; size < whole.size(); size += 37) {
    try {
      EXPECT_LT(Vocabulary(read_dbow2_text(whole.substr(0, size), "t.txt")).size(), 27U);
      ++read;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), StartsWith("t.txt"));
      ++refused;
    }
  }
  EXPECT_GT(refused, 20U) << read;
}

}  // namespace
}  // namespace mh
