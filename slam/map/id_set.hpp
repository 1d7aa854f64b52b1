// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mh {

/// A set of ids for marking what a stage has visited. Memory grows with its members, not with the
/// map: bits are stored in pages of 4096 ids, allocated on first use, so that a stage's cost does
/// not grow with the parts of the map that it does not see. Ids are assigned in order, and
/// landmarks that are near each other were mapped together: few pages cover many ids.
template <class IdType>
class IdSet {
 public:
  /// @returns whether it was new.
  bool insert(IdType id) {
    const std::size_t page = id.value / kPageIds;
    if (page >= page_of_.size()) page_of_.resize(page + 1, kNone);
    if (page_of_[page] == kNone) {
      page_of_[page] = static_cast<std::uint32_t>(pages_.size());
      pages_.emplace_back();
    }
    std::uint64_t& word = pages_[page_of_[page]][id.value % kPageIds / 64];
    const std::uint64_t bit = std::uint64_t{1} << (id.value % 64);
    const bool is_new = (word & bit) == 0;
    word |= bit;
    return is_new;
  }
  bool contains(IdType id) const {
    const std::size_t page = id.value / kPageIds;
    if (page >= page_of_.size() || page_of_[page] == kNone) return false;
    return (pages_[page_of_[page]][id.value % kPageIds / 64] >> (id.value % 64) & 1) != 0;
  }

 private:
  static constexpr std::size_t kPageIds = 4096;
  static constexpr std::uint32_t kNone = UINT32_MAX;
  std::vector<std::uint32_t> page_of_;
  std::vector<std::array<std::uint64_t, kPageIds / 64>> pages_;
};

}  // namespace mh
