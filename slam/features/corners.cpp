// SPDX-License-Identifier: Apache-2.0
#include "slam/features/corners.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include <opencv2/features2d.hpp>

namespace mh {
namespace {

constexpr int kCell_px = 36;
constexpr int kFastRadius_px = 3;  // of FAST's circle: cv::FAST leaves a border that wide

// Appends the corners of `area` (in pixels of the image), judged as if the whole image were
// searched.
void append_corners(const cv::Mat& image, const cv::Rect& area, int threshold,
                    std::vector<cv::KeyPoint>& scratch, std::vector<Corner>& out) {
  // One pixel more than the circle needs, so that maxima at the area's rim are compared with their
  // neighbours beyond it.
  constexpr int kMargin = kFastRadius_px + 1;
  const cv::Rect grown = cv::Rect(area.x - kMargin, area.y - kMargin, area.width + 2 * kMargin,
                                  area.height + 2 * kMargin) &
                         cv::Rect({0, 0}, image.size());
  cv::FAST(image(grown), scratch, threshold, /*nonmaxSuppression=*/true);
  for (const cv::KeyPoint& k : scratch) {
    const cv::Point p(cvRound(k.pt.x) + grown.x, cvRound(k.pt.y) + grown.y);
    if (!area.contains(p)) continue;
    out.push_back({static_cast<std::int16_t>(p.x), static_cast<std::int16_t>(p.y),
                   static_cast<std::int16_t>(k.response)});
  }
}

// The area under search, cut into cells of about kCell_px.
struct Cells {
  cv::Rect area;
  int columns, rows;

  explicit Cells(const cv::Rect& a)
      : area(a),
        columns(std::max(1, cvRound(static_cast<double>(a.width) / kCell_px))),
        rows(std::max(1, cvRound(static_cast<double>(a.height) / kCell_px))) {}

  int left(int column) const { return area.x + area.width * column / columns; }
  int top(int row) const { return area.y + area.height * row / rows; }
  // Inverse of left and top: the last cell that starts at or before a pixel.
  int column_of(int x) const { return ((x - area.x + 1) * columns - 1) / area.width; }
  int row_of(int y) const { return ((y - area.y + 1) * rows - 1) / area.height; }
};

std::vector<char> occupied(const Cells& cells, const std::vector<Corner>& corners) {
  std::vector<char> result(static_cast<std::size_t>(cells.columns) * cells.rows, 0);
  for (const Corner& c : corners)
    result[static_cast<std::size_t>(cells.row_of(c.y)) * cells.columns + cells.column_of(c.x)] = 1;
  return result;
}

// Corners at least `spacing` apart, strongest first, at most `count`.
class SpacedPicker {
 public:
  explicit SpacedPicker(const std::vector<Corner>& corners) : corners_(corners) {
    for (const Corner& c : corners) {
      width_ = std::max(width_, c.x + 1);
      height_ = std::max(height_, c.y + 1);
    }
  }

  std::vector<Corner> pick(int spacing, std::size_t count) {
    // Cells as large as the spacing hold one taken corner at most. A rim of empty cells saves
    // asking for bounds.
    const int columns = width_ / spacing + 3;
    const int rows = height_ / spacing + 3;
    taken_.assign(static_cast<std::size_t>(columns) * rows, kNone);
    std::vector<Corner> picked;
    picked.reserve(count);
    for (const Corner& c : corners_) {
      Corner* cell =
          &taken_[static_cast<std::size_t>(c.y / spacing + 1) * columns + c.x / spacing + 1];
      if (!is_free(c, cell, columns, spacing)) continue;
      *cell = c;
      picked.push_back(c);
      if (picked.size() == count) break;
    }
    return picked;
  }

  // No spacing above this one can hold `count` corners.
  int largest_spacing(std::size_t count) const {
    int spacing = 1;
    while (static_cast<std::size_t>((width_ / (spacing + 1) + 1)) * (height_ / (spacing + 1) + 1) >=
               count &&
           spacing < std::max(width_, height_))
      ++spacing;
    return spacing;
  }

 private:
  static constexpr Corner kNone{-20000, -20000, 0};  // farther from any corner than any spacing

  static bool is_free(const Corner& c, const Corner* cell, int columns, int spacing) {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Corner& other = cell[dy * columns + dx];
        if (std::abs(other.x - c.x) < spacing && std::abs(other.y - c.y) < spacing) return false;
      }
    return true;
  }

  const std::vector<Corner>& corners_;
  int width_ = 1, height_ = 1;
  std::vector<Corner> taken_;
};

}  // namespace

std::vector<Corner> find_corners(const cv::Mat& image, int edge_px, int threshold,
                                 int low_threshold) {
  assert(edge_px > kFastRadius_px);
  const cv::Rect area(edge_px, edge_px, image.cols - 2 * edge_px, image.rows - 2 * edge_px);
  if (area.width <= 0 || area.height <= 0) return {};

  std::vector<Corner> corners;
  std::vector<cv::KeyPoint> scratch;
  append_corners(image, area, threshold, scratch, corners);

  const Cells cells(area);
  const std::vector<char> full = occupied(cells, corners);
  for (int row = 0; row < cells.rows; ++row) {
    const char* row_full = &full[static_cast<std::size_t>(row) * cells.columns];
    // Neighbouring empty cells are searched in one go.
    for (int first = 0, last = 0; first < cells.columns; first = last + 1) {
      last = first;
      if (row_full[first]) continue;
      while (last + 1 < cells.columns && !row_full[last + 1]) ++last;
      const cv::Point top_left(cells.left(first), cells.top(row));
      const cv::Point bottom_right(cells.left(last + 1), cells.top(row + 1));
      append_corners(image, {top_left, bottom_right}, low_threshold, scratch, corners);
    }
  }
  std::sort(corners.begin(), corners.end(), stronger);
  return corners;
}

std::vector<Corner> spread(const std::vector<Corner>& corners, int count) {
  assert(std::is_sorted(corners.begin(), corners.end(), stronger));
  const auto wanted = static_cast<std::size_t>(std::max(count, 0));
  if (corners.size() <= wanted) return corners;
  if (wanted == 0) return {};

  SpacedPicker picker(corners);
  int good = 1;  // at spacing 1 nothing is refused
  std::vector<Corner> best(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(wanted));
  int bad = picker.largest_spacing(wanted) + 1;
  while (bad - good > 1) {
    const int spacing = good + (bad - good) / 2;
    std::vector<Corner> picked = picker.pick(spacing, wanted);
    if (picked.size() < wanted) {
      bad = spacing;
    } else {
      good = spacing;
      best = std::move(picked);
    }
  }
  return best;
}

std::vector<int> share_out(int total, double ratio, const std::vector<int>& available) {
  const auto levels = available.size();
  double sum = 0;
  for (std::size_t l = 0; l < levels; ++l) sum += std::pow(ratio, static_cast<double>(l));

  std::vector<int> share(levels);
  int left = total;
  for (std::size_t l = levels; l-- > 0;) {  // the finest level gets what rounding leaves
    const int quota =
        l == 0
            ? left
            : static_cast<int>(std::lround(total / sum * std::pow(ratio, static_cast<double>(l))));
    left -= quota;
    share[l] = quota;
  }
  int unused = 0;
  for (std::size_t l = 0; l < levels; ++l) {
    unused += std::max(0, share[l] - available[l]);
    share[l] = std::min(share[l], available[l]);
  }
  for (std::size_t l = 0; l < levels; ++l) {
    const int more = std::min(unused, available[l] - share[l]);
    share[l] += more;
    unused -= more;
  }
  return share;
}

}  // namespace mh
