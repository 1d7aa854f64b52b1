// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "slam/core/grid2d.hpp"

namespace mh {

/// An immutable image; copies share its memory.
template <class T>
class SharedGrid {
 public:
  SharedGrid() = default;
  SharedGrid(Grid2d<T> grid) {
    if (!grid.empty()) grid_ = std::make_shared<const Grid2d<T>>(std::move(grid));
  }

  const Grid2d<T>& grid() const {
    static const Grid2d<T> kNone;
    return grid_ ? *grid_ : kNone;
  }
  operator const Grid2d<T>&() const { return grid(); }

  int width() const { return grid().width(); }
  int height() const { return grid().height(); }
  bool empty() const { return grid_ == nullptr; }
  std::size_t size() const { return grid().size(); }
  const T& operator()(int x, int y) const { return grid()(x, y); }
  const T* data() const { return grid().data(); }
  auto begin() const { return grid().begin(); }
  auto end() const { return grid().end(); }

  /// Equal for images that share their memory; null for an empty image.
  const void* identity() const { return grid_.get(); }

  friend bool operator==(const SharedGrid& a, const SharedGrid& b) {
    return a.grid_ == b.grid_ || a.grid() == b.grid();
  }

 private:
  std::shared_ptr<const Grid2d<T>> grid_;
};

}  // namespace mh
