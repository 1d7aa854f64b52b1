// SPDX-License-Identifier: Apache-2.0
#include "slam/map/inverted_index.hpp"

#include <algorithm>
#include <span>

namespace mh {
namespace {

using Holders = std::vector<KeyframeId>;

void insert(std::vector<Holders>& of, std::span<const WeightedMember> members, KeyframeId id) {
  for (const WeightedMember& member : members) {
    if (member.id >= of.size()) of.resize(member.id + 1);
    Holders& holders = of[member.id];
    holders.insert(std::lower_bound(holders.begin(), holders.end(), id), id);
  }
}

void erase(std::vector<Holders>& of, std::span<const WeightedMember> members, KeyframeId id) {
  for (const WeightedMember& member : members) {
    Holders& holders = of[member.id];
    holders.erase(std::lower_bound(holders.begin(), holders.end(), id));
  }
}

}  // namespace

void InvertedIndex::add(KeyframeId keyframe, const AugmentedVector& vector) {
  insert(of_label_, vector.labels, keyframe);
  insert(of_word_, vector.words, keyframe);
}

void InvertedIndex::remove(KeyframeId keyframe, const AugmentedVector& vector) {
  erase(of_label_, vector.labels, keyframe);
  erase(of_word_, vector.words, keyframe);
}

std::vector<SharedMembers> InvertedIndex::shared(const AugmentedVector& view) const {
  std::vector<SharedMembers> counts;  // one place per keyframe id
  const auto at = [&](KeyframeId id) -> SharedMembers& {
    if (id.value >= counts.size()) counts.resize(id.value + 1);
    return counts[id.value];
  };
  for (const WeightedMember& member : view.labels)
    if (member.id < of_label_.size())
      for (const KeyframeId id : of_label_[member.id]) ++at(id).labels;
  for (const WeightedMember& member : view.words)
    if (member.id < of_word_.size())
      for (const KeyframeId id : of_word_[member.id]) ++at(id).words;
  for (std::uint32_t i = 0; i < counts.size(); ++i) counts[i].keyframe = KeyframeId{i};
  std::erase_if(counts, [](const SharedMembers& s) { return s.labels == 0 && s.words == 0; });
  return counts;
}

}  // namespace mh
