// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/heads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr float kMostScore = 1.001F;  // 1 with slack for rounding

/// A cell of a head without anchors; these heads list the cells of each stride, row by row.
struct Cell {
  int x = 0, y = 0, stride = 0;
};

constexpr std::array<std::array<int, 4>, 3> kStrides = {
    {{8, 16, 32, 0}, {8, 16, 32, 64}, {16, 32, 0, 0}}};

std::vector<Cell> cells(const InputSize& input, const std::array<int, 4>& strides) {
  std::vector<Cell> all;
  for (const int stride : strides)
    for (int y = 0; stride > 0 && y < input.height / stride; ++y)
      for (int x = 0; x < input.width / stride; ++x) all.push_back({x, y, stride});
  return all;
}

/// The cells of a head with this number of boxes; empty if no choice of strides gives this number.
std::vector<Cell> cells_of(int boxes, const InputSize& input) {
  for (const auto& strides : kStrides) {
    int count = 0;
    for (const int stride : strides)
      if (stride > 0) count += (input.width / stride) * (input.height / stride);
    if (count == boxes) return cells(input, strides);
  }
  return {};
}

/// A matrix of `rows` x `columns`, stored row by row or column by column.
struct Matrix {
  int rows = 0, columns = 0;
  std::span<const float> values;
  bool transposed = false;  // stored column by column

  float at(int row, int column) const {
    const auto r = static_cast<std::size_t>(row), c = static_cast<std::size_t>(column);
    return transposed ? values[c * static_cast<std::size_t>(rows) + r]
                      : values[r * static_cast<std::size_t>(columns) + c];
  }
};

/// A tensor as a matrix of its last two dimensions; nullopt unless the others are 1.
std::optional<Matrix> as_matrix(const Tensor& tensor) {
  const auto& shape = tensor.shape;
  if (shape.size() < 2) return std::nullopt;
  for (std::size_t i = 0; i + 2 < shape.size(); ++i)
    if (shape[i] != 1) return std::nullopt;
  return Matrix{shape[shape.size() - 2], shape.back(), tensor.values};
}

/// Whether a tensor has a channel per class, and the aspect ratio of the input to within a cell.
/// (Outputs of other networks, such as Yolo-FastestV2, are ordered by height, width, channels.)
bool is_segmentation(const Tensor& tensor, const InputSize& input) {
  const auto& s = tensor.shape;
  return s.size() == 4 && s[0] == 1 && s[1] >= 2 && s[1] <= 4096 && s[2] > 1 && s[3] > 1 &&
         std::abs(std::int64_t{s[3]} * input.height - std::int64_t{s[2]} * input.width) <=
             std::max(input.width, input.height);
}

/// Whether there are tensors with a channel per class in different sizes, as the scales of a
/// detector have.
bool has_scales(std::span<const Tensor> outputs, const InputSize& input) {
  const Tensor* first = segmentation_in(outputs, input);
  return first != nullptr && std::ranges::any_of(outputs, [&](const Tensor& tensor) {
           return is_segmentation(tensor, input) && tensor.shape[3] != first->shape[3];
         });
}

/// Whether the boxes' centers are pixel positions near their cells, as decoded ones are. Raw ones
/// are offsets of about half a cell.
bool is_decoded(const Matrix& m, const std::vector<Cell>& of) {
  double from_cell = 0, from_zero = 0;
  for (int i = 0; i < m.rows; ++i) {
    const Cell& cell = of[static_cast<std::size_t>(i)];
    const double x = m.at(i, 0), y = m.at(i, 1);
    from_cell +=
        std::abs(x / cell.stride - cell.x - 0.5) + std::abs(y / cell.stride - cell.y - 0.5);
    from_zero += std::abs(x - 0.5) + std::abs(y - 0.5);
  }
  return from_cell < from_zero;
}

Matrix transposed(const Matrix& m) {
  return {m.columns, m.rows, m.values, true};
}

/// Whether a matrix whose shape fits one box per row in fact has one box per column, judging by the
/// boxes' positions.
bool has_boxes_in_columns(const Matrix& m, const InputSize& input) {
  const std::vector<Cell> by_row = cells_of(m.rows, input), by_column = cells_of(m.columns, input);
  return m.rows > 4 && !by_column.empty() && is_decoded(transposed(m), by_column) &&
         !is_decoded(m, by_row);
}

/// The output that a head reads, as rows of boxes; nullopt if there is none.
std::optional<Matrix> rows_of(Head head, std::span<const Tensor> outputs, const InputSize& input) {
  for (const Tensor& tensor : outputs) {
    std::optional<Matrix> m = as_matrix(tensor);
    if (!m) continue;
    if (head == Head::kYolov8) {
      if (m->rows < m->columns || !cells_of(m->columns, input).empty()) *m = transposed(*m);
      if (m->columns > 4) return m;
    } else if (m->columns > 5 && (head != Head::kYolox || !cells_of(m->rows, input).empty())) {
      return m;
    }
  }
  return std::nullopt;
}

double overlap(const DetectedBox& a, const DetectedBox& b) {
  const double w = std::min(a.right, b.right) - std::max(a.left, b.left),
               h = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  if (w <= 0 || h <= 0) return 0;
  const auto area = [](const DetectedBox& box) {
    return double{box.right - box.left} * double{box.bottom - box.top};
  };
  return w * h / (area(a) + area(b) - w * h);
}

/// Adds the boxes of one matrix.
void decode_rows(Head head, const Matrix& m, const InputSize& input, double confidence,
                 std::vector<Candidate>& found) {
  const bool raw = head == Head::kYolox;
  const int first = head == Head::kYolov8 ? 4 : 5;
  const std::vector<Cell> of = raw ? cells_of(m.rows, input) : std::vector<Cell>{};
  for (int i = 0; i < m.rows; ++i) {
    // Darknet's classes already contain the objectness.
    const float object = head == Head::kYolov8 || head == Head::kDarknet ? 1.0F : m.at(i, 4);
    if (!(object >= confidence)) continue;
    Candidate box;
    float best = -1;
    for (int c = first; c < m.columns; ++c)
      if (const float score = object * m.at(i, c); score > best) best = score, box.best = c - first;
    if (!(best >= confidence)) continue;
    box.x = m.at(i, 0), box.y = m.at(i, 1), box.width = m.at(i, 2), box.height = m.at(i, 3);
    if (raw) {
      const Cell& cell = of[static_cast<std::size_t>(i)];
      box.x = (box.x + cell.x) * cell.stride, box.y = (box.y + cell.y) * cell.stride;
      box.width = std::exp(box.width) * cell.stride;
      box.height = std::exp(box.height) * cell.stride;
    } else if (head == Head::kDarknet) {
      box.x *= input.width, box.width *= input.width;
      box.y *= input.height, box.height *= input.height;
    }
    const bool finite = std::isfinite(box.x) && std::isfinite(box.y) && std::isfinite(box.width) &&
                        std::isfinite(box.height) && std::isfinite(best);
    if (!finite || box.width <= 0 || box.height <= 0) continue;
    if (best > kMostScore)
      throw InputError(
          fmt::format("gives a score of {:.4g}, and scores are at most 1: its export lacks the "
                      "sigmoid, or it has a different head",
                      best));
    box.scores.reserve(static_cast<std::size_t>(m.columns - first));
    for (int c = first; c < m.columns; ++c) {
      const float score = object * m.at(i, c);
      box.scores.push_back(std::isfinite(score) ? std::clamp(score, 0.0F, 1.0F) : 0.0F);
    }
    found.push_back(std::move(box));
  }
}

}  // namespace

std::string shape_text(const Tensor& tensor) {
  return fmt::format("{}", fmt::join(tensor.shape, " x "));
}

const Tensor* segmentation_in(std::span<const Tensor> outputs, const InputSize& input) {
  const auto found =
      std::ranges::find_if(outputs, [&](const Tensor& t) { return is_segmentation(t, input); });
  return found == outputs.end() ? nullptr : &*found;
}

bool gives_boxes_and_masks(std::span<const Tensor> outputs, const InputSize& input) {
  const auto boxes = [&](const Tensor& tensor) {
    const std::optional<Matrix> m = as_matrix(tensor);
    return m && (!cells_of(m->columns, input).empty() || !cells_of(m->rows, input).empty() ||
                 (m->rows % 3 == 0 && !cells_of(m->rows / 3, input).empty()));
  };
  const auto masks = [&](const Tensor& tensor) { return is_segmentation(tensor, input); };
  return std::ranges::any_of(outputs, masks) && std::ranges::any_of(outputs, boxes);
}

Head recognize_head(std::span<const Tensor> outputs, const InputSize& input, bool darknet) {
  if (darknet) return rows_of(Head::kDarknet, outputs, input) ? Head::kDarknet : Head::kAuto;
  if (gives_boxes_and_masks(outputs, input) || has_scales(outputs, input)) return Head::kAuto;
  if (segmentation_in(outputs, input) != nullptr) return Head::kSegmentation;
  for (const Tensor& tensor : outputs) {
    const std::optional<Matrix> m = as_matrix(tensor);
    if (!m) continue;
    const std::vector<Cell> by_row = cells_of(m->rows, input);
    if (!by_row.empty() && m->columns > 5 && !has_boxes_in_columns(*m, input))
      return is_decoded(*m, by_row) ? Head::kYoloxDecoded : Head::kYolox;
    if (m->rows > 4 && !cells_of(m->columns, input).empty()) return Head::kYolov8;
    // Three anchors in each cell.
    if (m->columns > 5 && m->rows % 3 == 0 && !cells_of(m->rows / 3, input).empty())
      return Head::kYolov5;
  }
  return Head::kAuto;
}

int class_count(Head head, std::span<const Tensor> outputs, const InputSize& input) {
  if (head == Head::kSegmentation) {
    const Tensor* tensor = segmentation_in(outputs, input);
    return tensor == nullptr ? 0 : tensor->shape[1];
  }
  const std::optional<Matrix> m = rows_of(head, outputs, input);
  return m ? m->columns - (head == Head::kYolov8 ? 4 : 5) : 0;
}

std::vector<Candidate> decode(Head head, std::span<const Tensor> outputs, const InputSize& input,
                              double confidence) {
  std::vector<Candidate> found;
  if (head == Head::kDarknet) {  // one output per scale
    for (const Tensor& tensor : outputs)
      if (const auto m = as_matrix(tensor); m && m->columns > 5)
        decode_rows(head, *m, input, confidence, found);
  } else if (const auto m = rows_of(head, outputs, input)) {
    decode_rows(head, *m, input, confidence, found);
  }
  return found;
}

ClassDistribution our_classes(std::span<const float> scores, int best, const ClassNames& names) {
  constexpr float kLeast = 0.01F;
  ClassDistribution classes;
  if (names.ids[static_cast<std::size_t>(best)] == kVoid) return classes;
  std::array<float, 256> sums{};
  float sum = 0;
  for (std::size_t c = 0; c < scores.size(); ++c)
    if (names.ids[c] != kVoid && scores[c] >= kLeast)
      sums[names.ids[c]] += scores[c], sum += scores[c];
  const float scale = sum > 1 ? 1 / sum : 1;
  for (std::size_t id = 0; id < sums.size(); ++id)
    if (sums[id] > 0) classes.entries.emplace_back(static_cast<ClassId>(id), sums[id] * scale);
  return classes;
}

std::vector<DetectedBox> select_boxes(const std::vector<Candidate>& candidates, const Placement& at,
                                      int width, int height, const ClassNames& names,
                                      const DetectorSettings& settings) {
  struct Ranked {
    DetectedBox box;
    std::size_t index;
  };
  std::vector<Ranked> ranked;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    const auto clip = [](double v, int limit) {
      return static_cast<float>(std::clamp(v, 0.0, static_cast<double>(limit)));
    };
    DetectedBox box;
    box.left = clip(at.image_x(c.x - c.width / 2), width);
    box.right = clip(at.image_x(c.x + c.width / 2), width);
    box.top = clip(at.image_y(c.y - c.height / 2), height);
    box.bottom = clip(at.image_y(c.y + c.height / 2), height);
    box.network_class = c.best;
    box.score = c.scores[static_cast<std::size_t>(c.best)];
    if (box.left < box.right && box.top < box.bottom) ranked.push_back({box, i});
  }
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return a.box.score != b.box.score ? a.box.score > b.box.score : a.index < b.index;
  });
  std::vector<DetectedBox> kept;
  for (const Ranked& r : ranked) {
    if (kept.size() == static_cast<std::size_t>(settings.max_detections)) break;
    const bool covered = std::ranges::any_of(kept, [&](const DetectedBox& better) {
      return better.network_class == r.box.network_class && overlap(better, r.box) > settings.nms;
    });
    if (covered) continue;
    kept.push_back(r.box);
    kept.back().classes = our_classes(candidates[r.index].scores, r.box.network_class, names);
  }
  return kept;
}

}  // namespace mh
