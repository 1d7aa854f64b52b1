// SPDX-License-Identifier: Apache-2.0
#include "scenes/vocabulary_rooms/prints.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/materials/canvas.hpp"

namespace mh::training {
namespace {

constexpr float kFullTurn = 2 * std::numbers::pi_v<float>;

/// Draws one number after the other from an ink.
class Draws {
 public:
  Draws(const Ink& ink, std::uint64_t first) : ink_(ink), next_(first) {}
  float uniform(double low, double high) { return ink_.uniform(next_++, low, high); }
  int whole(int low, int high) { return ink_.whole(next_++, low, high); }
  const Tint& pick() { return ink_.pick(next_++); }

 private:
  const Ink& ink_;
  std::uint64_t next_;
};

}  // namespace

Sheet barcodes(const Ink& ink) {
  Sheet sheet(kTexels, kTexels, to_rgb8(ink.palette[0]));
  Canvas canvas(sheet);
  Draws draw(ink, 100);
  constexpr float kPanel = 128;
  for (int panel = 0; panel < 16; ++panel) {
    const float left = kPanel * static_cast<float>(panel % 4),
                top = kPanel * static_cast<float>(panel / 4);
    const Tint ground = blend(draw.pick(), Tint(245, 245, 240), 0.6F);
    const Tint bar = blend(draw.pick(), Tint(12, 12, 14), 0.8F);
    const bool upright = draw.whole(0, 1) == 1;
    canvas.rectangle(left + 5, top + 5, kPanel - 10, kPanel - 10, ground);
    for (float at = 14; at < kPanel - 18;) {
      const float width = draw.uniform(1.5, 9);
      const float length = draw.uniform(0.6, 1.0) * (kPanel - 28);
      if (upright)
        canvas.rectangle(left + at, top + 14, width, length, bar);
      else
        canvas.rectangle(left + 14, top + at, length, width, bar);
      at += width + draw.uniform(2, 8);
    }
  }
  return sheet;
}

Sheet charts(const Ink& ink) {
  Sheet sheet(kTexels, kTexels, to_rgb8(blend(ink.palette[0], Tint(240, 240, 235), 0.7F)));
  Canvas canvas(sheet);
  Draws draw(ink, 100);
  const int squares = draw.whole(12, 32);
  const Tint line = ink.palette[1];
  for (int i = 0; i < squares; ++i) {
    const float at = static_cast<float>(i * kTexels / squares), thick = i % 4 == 0 ? 2.0F : 1.0F;
    canvas.rectangle(at, 0, thick, kTexels, line);
    canvas.rectangle(0, at, kTexels, thick, line);
  }
  for (int curve = 0; curve < 7; ++curve) {
    const Tint tint = draw.pick() * 0.6F;
    const float thick = draw.uniform(1.5, 5), step = draw.uniform(14, 40);
    float y = draw.uniform(0, kTexels);
    for (float x = 0; x < kTexels; x += step) {
      const float next = y + draw.uniform(-60, 60);
      canvas.line(x, y, x + step, next, thick, tint);
      if (curve % 2 == 0) canvas.ellipse(x, y, 2 * thick, 2 * thick, 0, tint);
      y = next;
    }
  }
  return sheet;
}

Sheet collage(const Ink& ink) {
  Sheet sheet(kTexels, kTexels, to_rgb8(ink.palette[0]));
  Canvas canvas(sheet);
  Draws draw(ink, 100);
  const double largest = draw.uniform(30, 130);
  for (int piece = 0; piece < 220; ++piece) {
    const float x = draw.uniform(-20, kTexels + 20), y = draw.uniform(-20, kTexels + 20);
    const float turn = draw.uniform(0, kFullTurn), a = draw.uniform(5, largest),
                b = draw.uniform(5, largest);
    const Tint tint = draw.pick() * draw.uniform(0.7, 1.25);
    const int shape = draw.whole(0, 2);
    if (shape == 0) {
      canvas.ellipse(x, y, 0.5F * a, 0.5F * b, turn, tint);
      continue;
    }
    const int corners = shape == 1 ? 4 : 3;
    std::vector<Eigen::Vector2f> outline;
    for (int i = 0; i < corners; ++i) {
      const float angle = turn + kFullTurn * static_cast<float>(i) / static_cast<float>(corners);
      outline.emplace_back(x + 0.6F * (i % 2 == 0 ? a : b) * std::cos(angle),
                           y + 0.6F * (i % 2 == 0 ? a : b) * std::sin(angle));
    }
    canvas.polygon(outline, tint);
  }
  return sheet;
}

Sheet confetti(const Ink& ink) {
  const Field cloud = clouds(ink, 1, 6);
  Sheet sheet = fill([&](int x, int y) { return ink.palette[0] * (1.0F + 0.08F * cloud(x, y)); });
  Canvas canvas(sheet);
  Draws draw(ink, 100);
  const int bits = draw.whole(150, 700);
  const double size = draw.uniform(4, 11);
  for (int i = 0; i < bits; ++i) {
    const float x = draw.uniform(0, kTexels), y = draw.uniform(0, kTexels);
    const float turn = draw.uniform(0, kFullTurn), length = draw.uniform(2, size);
    const Tint tint = draw.pick();
    if (i % 3 == 0)
      canvas.ellipse(x, y, 0.6F * length, 0.6F * length, 0, tint);
    else
      canvas.line(x, y, x + 1.6F * length * std::cos(turn), y + 1.6F * length * std::sin(turn),
                  0.4F * length, tint);
  }
  return sheet;
}

Sheet halftone(const Ink& ink) {
  const int dots = 2 * ink.whole(0, 14, 34);
  const Field cloud = clouds(ink, 1, ink.whole(1, 2, 6), 4);
  const float cell = static_cast<float>(kTexels) / static_cast<float>(dots);
  return fill([&](int x, int y) {
    // Alternate rows are shifted by half a cell, as in a halftone screen.
    const int row = static_cast<int>(static_cast<float>(y) / cell);
    const float shift = row % 2 == 0 ? 0.0F : 0.5F;
    const float u = static_cast<float>(x) / cell + shift, v = static_cast<float>(y) / cell;
    const float distance = std::hypot(u - std::floor(u) - 0.5F, v - std::floor(v) - 0.5F);
    const int column = static_cast<int>(u) % dots;
    const int cx = std::min(kTexels - 1, static_cast<int>((column + 0.5F) * cell));
    const int cy = std::min(kTexels - 1, static_cast<int>((row + 0.5F) * cell));
    const float radius = std::clamp(0.3F + 0.35F * cloud(cx, cy), 0.05F, 0.48F);
    return blend(ink.palette[0], ink.palette[1],
                 smoothstep(radius + 0.08F, radius - 0.02F, distance));
  });
}

Sheet scales(const Ink& ink) {
  const int columns = ink.whole(0, 6, 14), rows = 2 * columns;
  const Field rough = clouds(ink, 1, 20, 4);
  return fill([&](int x, int y) {
    const float u = static_cast<float>(x * columns) / kTexels;
    const float v = static_cast<float>(y * rows) / kTexels;
    // The topmost of the scales that cover this texel is the one in the lowest row.
    for (int row = static_cast<int>(v) + 1; row >= static_cast<int>(v) - 1; --row) {
      const float shift = 0.5F * static_cast<float>((row + 2) % 2);
      const float column = std::floor(u - shift);
      const float d =
          std::hypot(u - shift - column - 0.5F, 0.5F * (v - static_cast<float>(row - 1)));
      if (d > 0.52F) continue;
      const auto id = static_cast<std::uint64_t>(((row + rows) % rows) * columns +
                                                 (static_cast<int>(column) + columns) % columns);
      const float shade = static_cast<float>(ink.random.fork(3).uniform(id, 0.8, 1.2));
      const Tint body = (ink.random.fork(4).below(id, 5) == 0 ? ink.palette[2] : ink.palette[0]) *
                        (shade * (0.75F + 0.6F * d) + 0.15F * rough(x, y));
      return blend(body, ink.palette[1] * 0.6F, smoothstep(0.44F, 0.5F, d));
    }
    return ink.palette[1] * 0.6F;
  });
}

Sheet scribbles(const Ink& ink) {
  const Field cloud = clouds(ink, 1, 4);
  Sheet sheet = fill([&](int x, int y) { return ink.palette[0] * (1.0F + 0.1F * cloud(x, y)); });
  Canvas canvas(sheet);
  Draws draw(ink, 100);
  const int lines = draw.whole(25, 60);
  for (int i = 0; i < lines; ++i) {
    float x = draw.uniform(0, kTexels), y = draw.uniform(0, kTexels), heading = draw.uniform(-3, 3);
    const float thick = draw.uniform(1, 4.5), length = draw.uniform(4, 14);
    const Tint tint = draw.pick();
    for (int step = 0; step < 28; ++step) {
      heading += draw.uniform(-0.9, 0.9);
      const float nx = x + length * std::cos(heading), ny = y + length * std::sin(heading);
      canvas.line(x, y, nx, ny, thick, tint);
      x = nx;
      y = ny;
    }
  }
  return sheet;
}

Sheet truchet(const Ink& ink) {
  const int count = ink.whole(0, 8, 24);
  const float width = ink.uniform(1, 0.08, 0.2);
  const Field rough = clouds(ink, 1, 16);
  return fill([&](int x, int y) {
    const float u = static_cast<float>(x * count) / kTexels;
    const float v = static_cast<float>(y * count) / kTexels;
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const auto id = static_cast<std::uint64_t>(j * count + i);
    float s = u - static_cast<float>(i);
    const float t = v - static_cast<float>(j);
    if (ink.random.fork(2).below(id, 2) == 0) s = 1 - s;
    const float arc = std::min(std::hypot(s, t), std::hypot(1 - s, 1 - t));
    const float edge = smoothstep(width, 0.7F * width, std::abs(arc - 0.5F));
    return blend(ink.palette[0] * (1.0F + 0.15F * rough(x, y)), ink.palette[1], edge);
  });
}

Sheet wire_mesh(const Ink& ink) {
  const int wires = 2 * ink.whole(0, 7, 20);
  const float thick = ink.uniform(1, 0.1, 0.3);
  const Field behind = clouds(ink, 1, 7, 5);
  return fill([&](int x, int y) {
    // Wires run along both diagonals; which one is on top alternates at the crossings.
    const float a = static_cast<float>((x + y) * wires) / (2 * kTexels);
    const float b = static_cast<float>((x - y + kTexels) * wires) / (2 * kTexels);
    const float da = std::abs(a - std::round(a)), db = std::abs(b - std::round(b));
    const bool a_on_top =
        (static_cast<int>(std::round(a)) + static_cast<int>(std::round(b))) % 2 == 0;
    const float first = a_on_top ? da : db, second = a_on_top ? db : da;
    if (first < 0.5F * thick) return ink.palette[0] * (1.25F - 1.8F * first / thick);
    if (second < 0.5F * thick) return ink.palette[0] * (1.0F - 1.4F * second / thick);
    return ink.palette[1] * (0.3F + 0.15F * behind(x, y));
  });
}

}  // namespace mh::training
