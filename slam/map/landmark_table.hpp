// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>
#include <utility>
#include <vector>

#include "slam/map/landmark.hpp"

namespace mh {

/// Landmarks by id. Ids are assigned in order and never reused; references stay valid until their
/// landmark is erased. An erased landmark leaves four bytes behind, and its id maps to one shared
/// tombstone: over time, a robot in one house creates ten times as many landmarks as are live.
class LandmarkTable {
 public:
  /// Iterates over all ids ever assigned; erased ones yield the tombstone.
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = Landmark;
    using difference_type = std::ptrdiff_t;
    using pointer = const Landmark*;
    using reference = const Landmark&;
    Iterator() = default;
    Iterator(const LandmarkTable& table, std::uint32_t id) : table_(&table), id_(id) {}
    const Landmark& operator*() const { return (*table_)[LandmarkId{id_}]; }
    Iterator& operator++() {
      ++id_;
      return *this;
    }
    void operator++(int) { ++*this; }
    bool operator==(const Iterator& other) const { return id_ == other.id_; }

   private:
    const LandmarkTable* table_ = nullptr;
    std::uint32_t id_ = 0;
  };

  LandmarkTable() : pool_(1) { pool_[kTombstone].erased = true; }

  /// Number of ids ever assigned.
  std::size_t size() const { return place_of_.size(); }
  const Landmark& operator[](LandmarkId id) const { return pool_[place_of_[id.value]]; }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, static_cast<std::uint32_t>(size())}; }

  /// A mutable landmark; null if erased.
  Landmark* find(LandmarkId id) {
    const std::uint32_t place = place_of_[id.value];
    return place == kTombstone ? nullptr : &pool_[place];
  }
  /// Adds a landmark under the next id. One that is already erased becomes a tombstone.
  LandmarkId add(Landmark landmark) {
    const LandmarkId id{static_cast<std::uint32_t>(size())};
    if (landmark.erased) {
      place_of_.push_back(kTombstone);
      return id;
    }
    landmark.id = id;
    if (free_.empty()) {
      place_of_.push_back(static_cast<std::uint32_t>(pool_.size()));
      pool_.push_back(std::move(landmark));
    } else {
      place_of_.push_back(free_.back());
      pool_[free_.back()] = std::move(landmark);
      free_.pop_back();
    }
    return id;
  }
  /// @pre the landmark is live
  void erase(LandmarkId id) {
    std::uint32_t& place = place_of_[id.value];
    pool_[place] = Landmark{};  // frees its observations
    free_.push_back(place);
    place = kTombstone;
  }

 private:
  static constexpr std::uint32_t kTombstone = 0;
  std::deque<Landmark> pool_;
  std::vector<std::uint32_t> place_of_;  // in pool_, by id
  std::vector<std::uint32_t> free_;      // unused slots of pool_
};

}  // namespace mh
