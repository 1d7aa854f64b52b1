// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>

#include "slam/detect/heads.hpp"

namespace mh {
namespace {

constexpr int kSteps = 4;        // steps of certainty per class
constexpr std::size_t kTop = 3;  // classes per palette entry

/// Probabilities of our classes at each cell of an output.
struct Cells {
  int width, height;
  std::vector<ClassId> ids;   // all that occur, ascending
  std::vector<float> values;  // by cell, then by id

  const float* at(int x, int y) const {
    return values.data() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x)) *
                               ids.size();
  }
};

/// Whether the values of every cell are shares that sum to 1.
bool are_probabilities(const Tensor& output, std::size_t classes, std::size_t cells) {
  for (std::size_t i = 0; i < cells; ++i) {
    double sum = 0;
    for (std::size_t c = 0; c < classes; ++c) {
      const float v = output.values[c * cells + i];
      if (!(v >= -1e-3F && v <= 1.001F)) return false;
      sum += v;
    }
    if (std::abs(sum - 1) > 1e-2) return false;
  }
  return true;
}

Cells our_cells(const Tensor& output, const ClassNames& names) {
  const auto classes = static_cast<std::size_t>(output.shape[1]);
  Cells cells{.width = output.shape[3], .height = output.shape[2], .ids = {}, .values = {}};
  const std::size_t count =
      static_cast<std::size_t>(cells.width) * static_cast<std::size_t>(cells.height);
  cells.ids = names.ids;
  std::ranges::sort(cells.ids);
  cells.ids.erase(std::unique(cells.ids.begin(), cells.ids.end()), cells.ids.end());
  std::vector<std::size_t> slot;
  for (const ClassId id : names.ids)
    slot.push_back(
        static_cast<std::size_t>(std::ranges::lower_bound(cells.ids, id) - cells.ids.begin()));
  const bool ready = are_probabilities(output, classes, count);
  cells.values.assign(count * cells.ids.size(), 0.0F);
  std::vector<float> shares(classes);
  for (std::size_t i = 0; i < count; ++i) {
    float most = -1e30F, sum = 0;
    for (std::size_t c = 0; c < classes; ++c) {
      const float v = output.values[c * count + i];
      shares[c] = std::isfinite(v) ? v : -1e30F;
      most = std::max(most, shares[c]);
    }
    for (float& share : shares) {
      if (!ready) share = std::exp(share - most);
      sum += share;
    }
    for (std::size_t c = 0; c < classes; ++c)
      cells.values[i * cells.ids.size() + slot[c]] += shares[c] / sum;
  }
  return cells;
}

}  // namespace

SemanticImage segmented(const Tensor& output, const Placement& at, const InputSize& input,
                        const InputSize& of_image, const ClassNames& names, double confidence) {
  const auto [width, height] = of_image;
  const Cells cells = our_cells(output, names);
  const std::size_t n = cells.ids.size();
  const double per_cell_x = static_cast<double>(cells.width) / input.width,
               per_cell_y = static_cast<double>(cells.height) / input.height;
  struct Sum {
    std::vector<double> shares;
    double pixels = 0;
  };
  std::map<int, Sum> sums;  // by group: best class, step of its certainty
  Grid2d<std::int32_t> group(width, height, -1);
  std::vector<float> shares(n);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      // The cells around the pixel's center, weighted by nearness.
      const double cx =
          std::clamp(((x + 0.5) * at.scale_x + at.left) * per_cell_x - 0.5, 0.0, cells.width - 1.0);
      const double cy =
          std::clamp(((y + 0.5) * at.scale_y + at.top) * per_cell_y - 0.5, 0.0, cells.height - 1.0);
      const int x0 = static_cast<int>(cx), y0 = static_cast<int>(cy);
      const int x1 = std::min(x0 + 1, cells.width - 1), y1 = std::min(y0 + 1, cells.height - 1);
      const auto fx = static_cast<float>(cx - x0), fy = static_cast<float>(cy - y0);
      const float *a = cells.at(x0, y0), *b = cells.at(x1, y0), *c = cells.at(x0, y1),
                  *d = cells.at(x1, y1);
      std::size_t best = 0;
      for (std::size_t k = 0; k < n; ++k) {
        shares[k] = (a[k] * (1 - fx) + b[k] * fx) * (1 - fy) + (c[k] * (1 - fx) + d[k] * fx) * fy;
        if (shares[k] > shares[best]) best = k;
      }
      if (cells.ids[best] == kVoid || !(shares[best] >= confidence)) continue;
      const int step = std::min(kSteps - 1, static_cast<int>(shares[best] * kSteps));
      group(x, y) = static_cast<int>(best) * kSteps + step;
      Sum& sum = sums[group(x, y)];
      sum.shares.resize(n);
      sum.pixels += 1;
      for (std::size_t k = 0; k < n; ++k) sum.shares[k] += shares[k];
    }

  SemanticImage image{{width, height, 0}, {ClassDistribution{}}};
  std::map<int, std::uint8_t> entry;
  for (const auto& [key, sum] : sums) {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < n; ++k)
      if (cells.ids[k] != kVoid) order.push_back(k);
    std::ranges::stable_sort(order, std::greater<>(),
                             [&shares = sum.shares](std::size_t k) { return shares[k]; });
    order.resize(std::min(order.size(), kTop));
    std::ranges::sort(order);
    ClassDistribution classes;
    for (const std::size_t k : order)
      if (const double share = sum.shares[k] / sum.pixels; share >= 0.01)
        classes.entries.emplace_back(cells.ids[k], static_cast<float>(share));
    if (image.palette.size() == 256) break;
    entry[key] = static_cast<std::uint8_t>(image.palette.size());
    image.palette.push_back(std::move(classes));
  }
  for (std::size_t i = 0; i < group.size(); ++i)
    if (const auto found = entry.find(group.data()[i]); found != entry.end())
      image.index.data()[i] = found->second;
  return image;
}

}  // namespace mh
