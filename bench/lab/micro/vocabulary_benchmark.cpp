// SPDX-License-Identifier: Apache-2.0
// The shipped vocabulary: time to load it, to find the words of a frame of 1,000 features, and to
// find candidates among 500 keyframes with and without the inverted index. For comparison, also a
// tree of 10^6 words (k = 10, L = 6, as large as the public ORBvoc.txt) in DBoW2's text format and
// in our own. Run it from the repository's root, or name the vocabulary: MH_VOCABULARY=FILE.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "slam/core/random.hpp"
#include "slam/io/files.hpp"
#include "slam/vocabulary/inverted_index.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {
namespace {
namespace fs = std::filesystem;

std::string shipped_file() {
  const char* const named = std::getenv("MH_VOCABULARY");
  return named ? named : "assets/vocabulary.mhvoc";
}

/// Random descriptors visit words all over the tree: the worst case for caches.
std::vector<Descriptor> frame(std::uint64_t index) {
  std::vector<Descriptor> descriptors;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const RandomStream r = RandomStream(index).fork(i);
    descriptors.push_back({r.bits(0), r.bits(1), r.bits(2), r.bits(3)});
  }
  return descriptors;
}

AugmentedVector words_of(const Vocabulary& vocabulary, const std::vector<Descriptor>& descriptors) {
  std::vector<WordId> words;
  words.reserve(descriptors.size());
  for (const Descriptor& d : descriptors) words.push_back(vocabulary.quantize(d).word);
  return augmented_vector({}, words, 0.0,
                          [&](WordId word) { return static_cast<double>(vocabulary.idf(word)); });
}

void load_shipped(benchmark::State& state) {
  const std::string file = shipped_file();
  for (auto _ : state) benchmark::DoNotOptimize(Vocabulary::load(file));
}
BENCHMARK(load_shipped)->Unit(benchmark::kMillisecond);

void quantize_frame(benchmark::State& state) {
  const Vocabulary vocabulary = Vocabulary::load(shipped_file());
  std::vector<std::vector<Descriptor>> frames;
  for (std::uint64_t i = 0; i < 20; ++i) frames.push_back(frame(i));
  std::size_t i = 0;
  for (auto _ : state)
    for (const Descriptor& d : frames[i++ % frames.size()])
      benchmark::DoNotOptimize(vocabulary.quantize(d));
  state.counters["words"] = static_cast<double>(vocabulary.size());
}
BENCHMARK(quantize_frame)->Unit(benchmark::kMillisecond);

void words_of_frame(benchmark::State& state) {
  const Vocabulary vocabulary = Vocabulary::load(shipped_file());
  std::vector<std::vector<Descriptor>> frames;
  for (std::uint64_t i = 0; i < 20; ++i) frames.push_back(frame(i));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(words_of(vocabulary, frames[i++ % frames.size()]));
}
BENCHMARK(words_of_frame)->Unit(benchmark::kMillisecond);

/// A map of 500 views, each of which shares half of its features with the view before it.
struct Views {
  std::vector<AugmentedVector> vectors;
  InvertedIndex index;

  Views() {
    const Vocabulary vocabulary = Vocabulary::load(shipped_file());
    for (std::uint32_t k = 0; k < 500; ++k) {
      std::vector<Descriptor> descriptors = frame(k);
      const std::vector<Descriptor> before = frame(k == 0 ? 0 : k - 1);
      std::copy(before.begin() + 500, before.end(), descriptors.begin());
      vectors.push_back(words_of(vocabulary, descriptors));
      index.add(KeyframeId{k}, vectors.back());
    }
  }
};

void candidates_one_by_one(benchmark::State& state) {
  const Views views;
  for (auto _ : state)
    for (const AugmentedVector& v : views.vectors) {
      benchmark::DoNotOptimize(l1_similarity(views.vectors[250], v));
      benchmark::DoNotOptimize(shared_words(views.vectors[250], v));
    }
}
BENCHMARK(candidates_one_by_one)->Unit(benchmark::kMillisecond);

void candidates_by_inverted_index(benchmark::State& state) {
  const Views views;
  for (auto _ : state) benchmark::DoNotOptimize(views.index.query(views.vectors[250]));
}
BENCHMARK(candidates_by_inverted_index)->Unit(benchmark::kMillisecond);

/// 10^6 random words as DBoW2 writes them, level by level.
struct MillionWords {
  fs::path text = fs::temp_directory_path() / "vocabulary_benchmark.txt";
  fs::path own = fs::temp_directory_path() / "vocabulary_benchmark.mhvoc";

  MillionWords() {
    std::string lines = "10 6 0 0\n";
    std::uint64_t id = 0, first_parent = 0;
    for (std::uint64_t level = 1, count = 10; level <= 6; ++level, count *= 10) {
      const std::uint64_t first = id + 1;
      for (std::uint64_t i = 0; i < count; ++i) {
        const RandomStream r(++id);
        lines += fmt::format("{} {} ", first_parent + i / 10, level == 6 ? 1 : 0);
        for (std::uint64_t b = 0; b < 32; ++b) lines += fmt::format("{} ", r.below(b, 256));
        lines += fmt::format("{}\n", level == 6 ? r.uniform(32, 1.0, 9.0) : 0.0);
      }
      first_parent = first;
    }
    write_atomically(text, lines);
    Vocabulary::load(text).save(own);
  }
  ~MillionWords() {
    fs::remove(text);
    fs::remove(own);
  }
};

void load_dbow2_text_of_a_million_words(benchmark::State& state) {
  const MillionWords words;
  for (auto _ : state) benchmark::DoNotOptimize(Vocabulary::load(words.text));
  state.counters["bytes"] = static_cast<double>(fs::file_size(words.text));
}
BENCHMARK(load_dbow2_text_of_a_million_words)->Unit(benchmark::kMillisecond)->Iterations(2);

void load_a_million_words(benchmark::State& state) {
  const MillionWords words;
  for (auto _ : state) benchmark::DoNotOptimize(Vocabulary::load(words.own));
  state.counters["bytes"] = static_cast<double>(fs::file_size(words.own));
}
BENCHMARK(load_a_million_words)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mh

BENCHMARK_MAIN();
