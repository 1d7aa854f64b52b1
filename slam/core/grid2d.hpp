// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

namespace mh {

/// Allocator that aligns memory to cache lines, so that rows can be written in whole lines, and
/// leaves elements uninitialized unless given a value.
template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::size_t kLine = 64;

  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) noexcept {}
  /// The byte before the aligned start stores its offset in the allocated memory. (An aligned
  /// operator new is not used: glibc 2.36 does not reuse memory freed by aligned allocations, so
  /// the memory of a long run grew with every frame.)
  T* allocate(std::size_t count) {
    auto* memory = static_cast<unsigned char*>(::operator new(count * sizeof(T) + kLine));
    const std::size_t shift = kLine - reinterpret_cast<std::uintptr_t>(memory) % kLine;
    memory[shift - 1] = static_cast<unsigned char>(shift);
    return reinterpret_cast<T*>(memory + shift);
  }
  void deallocate(T* line, std::size_t) noexcept {
    auto* memory = reinterpret_cast<unsigned char*>(line);
    ::operator delete(memory - memory[-1]);
  }
  template <class U>
  void construct(U*) noexcept {
    static_assert(std::is_trivially_copyable_v<U>);
  }
  friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }
};

/// Tag for a Grid2d whose elements are all about to be written: they start uninitialized.
struct Unfilled {};

/// A dense row-major 2D array: images, label maps, occupancy. Pixel centers are at integers; (0, 0)
/// is the upper left element.
template <class T>
class Grid2d {
 public:
  Grid2d() = default;
  Grid2d(int width, int height, T fill = T{})
      : width_(width),
        height_(height),
        data_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {
    assert(width >= 0 && height >= 0);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return data_.empty(); }
  std::size_t size() const { return data_.size(); }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }

  Grid2d(int width, int height, Unfilled)
      : width_(width),
        height_(height),
        data_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    assert(width >= 0 && height >= 0);
  }

  T& operator()(int x, int y) { return data_[index(x, y)]; }
  const T& operator()(int x, int y) const { return data_[index(x, y)]; }

  std::span<T> row(int y) { return {data_.data() + index(0, y), static_cast<std::size_t>(width_)}; }
  std::span<const T> row(int y) const {
    return {data_.data() + index(0, y), static_cast<std::size_t>(width_)};
  }

  T* data() { return data_.data(); }
  const T* data() const { return data_.data(); }
  auto begin() { return data_.begin(); }
  auto end() { return data_.end(); }
  auto begin() const { return data_.begin(); }
  auto end() const { return data_.end(); }

  friend bool operator==(const Grid2d&, const Grid2d&) = default;

 private:
  std::size_t index(int x, int y) const {
    assert(x >= 0 && y >= 0 && x <= width_ && y < height_);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<T, LineAllocator<T>> data_;
};

}  // namespace mh
