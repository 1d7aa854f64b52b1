// SPDX-License-Identifier: Apache-2.0
#include "slam/vocabulary/inverted_index.hpp"

#include <algorithm>
#include <cassert>

namespace mh {

void InvertedIndex::insert(Postings& postings, KeyframeId keyframe,
                           const std::vector<WeightedMember>& members) {
  for (const WeightedMember& member : members) {
    std::vector<Posting>& list = postings[member.id];
    const auto at = std::ranges::lower_bound(list, keyframe, {}, &Posting::keyframe);
    assert(at == list.end() || at->keyframe != keyframe);
    list.insert(at, {keyframe, member.weight});
  }
}

void InvertedIndex::remove(Postings& postings, KeyframeId keyframe,
                           const std::vector<WeightedMember>& members) {
  for (const WeightedMember& member : members) {
    const auto found = postings.find(member.id);
    assert(found != postings.end());
    std::vector<Posting>& list = found->second;
    const auto at = std::ranges::lower_bound(list, keyframe, {}, &Posting::keyframe);
    assert(at != list.end() && at->keyframe == keyframe && at->weight == member.weight);
    list.erase(at);
    if (list.empty()) postings.erase(found);
  }
}

void InvertedIndex::add(KeyframeId keyframe, const AugmentedVector& vector) {
  insert(labels_, keyframe, vector.labels);
  insert(words_, keyframe, vector.words);
  end_ = std::max(end_, keyframe.value + 1);
  ++size_;
}

void InvertedIndex::erase(KeyframeId keyframe, const AugmentedVector& vector) {
  remove(labels_, keyframe, vector.labels);
  remove(words_, keyframe, vector.words);
  --size_;
}

std::vector<InvertedIndex::Score> InvertedIndex::query(const AugmentedVector& vector) const {
  std::vector<Score> scores(end_);
  // Members in the order in which l1_similarity() adds them: floating-point sums depend on it.
  const auto collect = [&](const Postings& postings, const std::vector<WeightedMember>& members,
                           int Score::*shared) {
    for (const WeightedMember& member : members) {
      const auto found = postings.find(member.id);
      if (found == postings.end()) continue;
      for (const Posting& posting : found->second) {
        Score& score = scores[posting.keyframe.value];
        score.keyframe = posting.keyframe;
        ++(score.*shared);
        score.similarity += std::min(member.weight, posting.weight);
      }
    }
  };
  collect(labels_, vector.labels, &Score::shared_labels);
  collect(words_, vector.words, &Score::shared_words);
  std::erase_if(scores, [](const Score& score) { return !score.keyframe.valid(); });
  return scores;
}

}  // namespace mh
