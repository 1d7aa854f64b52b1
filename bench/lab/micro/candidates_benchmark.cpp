// SPDX-License-Identifier: Apache-2.0
// candidates_benchmark MAP [KEYFRAMES]: times the selection of keyframe candidates (Algorithm 1) in
// a large map (100,000 keyframes by default) against a literal scan, which follows the paper's
// equations and compares the query with every keyframe. MAP is a map file. Each keyframe of the
// large map gets labels and words from two of that file's keyframes, so words are as common as in
// the file. In a real map of many different places, words would be less common, and queries would
// share fewer of them. The keyframes have no neighbors: for equation 5, these would add the same
// few sums to both methods. Both methods must choose the same candidates, to the bit. Times are CPU
// time of this thread, as medians over the queries. Run it from the repository's root, or name the
// vocabulary: MH_VOCABULARY=FILE.

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/lab/micro/timing.hpp"
#include "slam/core/random.hpp"
#include "slam/files/map_file.hpp"
#include "slam/io/error.hpp"
#include "slam/relocalize/relocalize.hpp"

namespace {

using namespace mh;

constexpr std::uint64_t kQueries = 20;

/// Appends each member of `from` with its weight, with probability 1/2.
void add_half(std::vector<WeightedMember>& to, const std::vector<WeightedMember>& from,
              const RandomStream& random) {
  for (const WeightedMember& member : from)
    if (random.uniform(member.id) < 0.5) to.push_back(member);
}

/// Sorts by id and removes duplicates, as AugmentedVector requires.
void put_in_order(std::vector<WeightedMember>& members) {
  std::ranges::sort(members, {}, &WeightedMember::id);
  const auto repeated = std::ranges::unique(members, {}, &WeightedMember::id);
  members.erase(repeated.begin(), repeated.end());
}

/// A view with labels and words from two real views.
AugmentedVector made_view(const std::vector<AugmentedVector>& real, const RandomStream& random) {
  AugmentedVector view;
  for (const std::uint64_t part : {0, 1}) {
    const AugmentedVector& of = real[random.below(part, real.size())];
    add_half(view.labels, of.labels, random.fork(2 * part));
    add_half(view.words, of.words, random.fork(2 * part + 1));
  }
  double sum = 0;
  for (auto* members : {&view.labels, &view.words}) {
    put_in_order(*members);
    for (const WeightedMember& member : *members) sum += member.weight;
  }
  for (auto* members : {&view.labels, &view.words})
    for (WeightedMember& member : *members) member.weight /= sum;
  return view;
}

CandidateSelection<KeyframeId> literal_scan(const Map& map, const AugmentedVector& query,
                                            const SemanticConfig& config) {
  std::vector<KeyframeId> all;
  for (const Keyframe& k : map.keyframes()) all.push_back(k.id);
  const auto vector_of = [&](KeyframeId k) -> const AugmentedVector& {
    return map.at(k).words.vector;
  };
  return select_candidates(
      std::span<const KeyframeId>(all),
      [&](KeyframeId k) {
        return shared_labels(query, vector_of(k)) + shared_words(query, vector_of(k));
      },
      [&](KeyframeId k) { return neighborhood(map, k); },
      [&](KeyframeId k) { return l1_similarity(query, vector_of(k)); }, config.alpha, config.beta);
}

bool same(const CandidateSelection<KeyframeId>& a, const CandidateSelection<KeyframeId>& b) {
  return a.c1 == b.c1 && a.c2 == b.c2 && a.c3 == b.c3 &&
         std::ranges::equal(a.candidates, b.candidates, [](const auto& x, const auto& y) {
           return x.keyframe == y.keyframe && x.score == y.score;
         });
}

int run(const std::string& map_file, std::size_t count) {
  const char* const named = std::getenv("MH_VOCABULARY");
  const auto vocabulary = std::make_shared<const Vocabulary>(
      Vocabulary::load(named ? named : "assets/vocabulary.mhvoc"));
  std::vector<AugmentedVector> real;
  double words = 0, labels = 0;
  const SlamState slam = load_slam(map_file, vocabulary);
  for (const Keyframe& k : slam.map.keyframes()) {
    if (k.erased) continue;
    real.push_back(k.words.vector);
    words += static_cast<double>(k.words.vector.words.size());
    labels += static_cast<double>(k.words.vector.labels.size());
  }
  if (real.empty()) throw InputError(map_file + ": has no keyframes");
  const auto views = static_cast<double>(real.size());
  fmt::print("{}: {} keyframes, {:.0f} words and {:.1f} labels each\n", map_file, real.size(),
             words / views, labels / views);

  const RandomStream random(1);
  Map map;
  for (std::size_t i = 0; i < count; ++i) {
    Keyframe keyframe;
    keyframe.words.vector = made_view(real, random.fork(i));
    map.add(std::move(keyframe));
  }
  SemanticConfig config;
  config.overlap = Overlap::kAugmented;
  std::vector<double> index_ms, scan_ms, candidates;
  for (std::uint64_t q = 0; q < kQueries; ++q) {
    const AugmentedVector query = made_view(real, random.fork(count + q));
    const double start_ms = thread_ms();
    const auto chosen = select_keyframes(map, query, config);
    const double between_ms = thread_ms();
    const auto scanned = literal_scan(map, query, config);
    scan_ms.push_back(thread_ms() - between_ms);
    index_ms.push_back(between_ms - start_ms);
    candidates.push_back(static_cast<double>(chosen.candidates.size()));
    if (!same(chosen, scanned)) {
      fmt::print("query {}: another choice than the literal scan's\n", q);
      return 1;
    }
  }
  fmt::print(
      "{} keyframes, {} queries, the same choice ({:.0f} candidates): literal scan {:.1f} ms, "
      "selection {:.2f} ms, {:.1f} times as fast\n",
      count, kQueries, median(candidates), median(scan_ms), median(index_ms),
      median(scan_ms) / median(index_ms));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "candidates_benchmark MAP [KEYFRAMES]\n");
    return 2;
  }
  try {
    return run(argv[1], argc > 2 ? std::stoul(argv[2]) : 100'000);
  } catch (const std::exception& error) {
    fmt::print(stderr, "candidates_benchmark: {}\n", error.what());
    return 2;
  }
}
