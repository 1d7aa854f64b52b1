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

/// Landmarks by id. Ids are given in order and never again; references last until their landmark is
/// erased. An erased one leaves four bytes behind, and its id names the tombstone that all share: a
/// robot that lives in one house makes ten times the landmarks that stand.
class LandmarkTable {
 public:
  /// Walks over all ids ever given, erased ones as the tombstone.
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

  /// How many ids were ever given.
  std::size_t size() const { return place_of_.size(); }
  const Landmark& operator[](LandmarkId id) const { return pool_[place_of_[id.value]]; }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, static_cast<std::uint32_t>(size())}; }

  /// A landmark to write to; null if it was erased.
  Landmark* find(LandmarkId id) {
    const std::uint32_t place = place_of_[id.value];
    return place == kTombstone ? nullptr : &pool_[place];
  }
  /// Gives it the next id. One that is erased already becomes a tombstone.
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
  /// @pre it stands
  void erase(LandmarkId id) {
    std::uint32_t& place = place_of_[id.value];
    pool_[place] = Landmark{};  // gives back the memory of its observations
    free_.push_back(place);
    place = kTombstone;
  }

 private:
  static constexpr std::uint32_t kTombstone = 0;
  std::deque<Landmark> pool_;
  std::vector<std::uint32_t> place_of_;  // in pool_, by id
  std::vector<std::uint32_t> free_;      // places in pool_
};

}  // namespace mh
