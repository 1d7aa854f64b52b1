// SPDX-License-Identifier: Apache-2.0
#include "scenes/vocabulary_rooms/patterns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "scenes/materials/canvas.hpp"
#include "scenes/vocabulary_rooms/ink.hpp"
#include "scenes/vocabulary_rooms/prints.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using namespace training;

constexpr float kTile = 1.2F;  // m

Sheet brick(const Ink& ink) {
  const int rows = 2 * ink.whole(0, 5, 10), columns = ink.whole(1, 4, 8);
  const Field rough = clouds(ink, 1, 24);
  const Field grain = white_noise(kTexels, kTexels, ink.random.fork(2));
  return fill([&](int x, int y) {
    const int row = y * rows / kTexels;
    const int shifted = (x + (row % 2) * kTexels / (2 * columns)) % kTexels;
    const int column = shifted * columns / kTexels;
    const int in_x = shifted - column * kTexels / columns, in_y = y - row * kTexels / rows;
    const Tint noise = Tint(14, 14, 14) * grain(x, y);
    if (in_x < 4 || in_y < 4) return ink.palette[1] * (0.95F + 0.2F * rough(x, y)) + noise;
    const auto id = static_cast<std::uint64_t>(row * columns + column);
    const float shade = static_cast<float>(ink.random.fork(3).uniform(id, 0.75, 1.2));
    return ink.palette[0] * (shade + 0.35F * rough(x, y)) + noise;
  });
}

Sheet marble(const Ink& ink) {
  const Field coarse = clouds(ink, 1, ink.whole(0, 2, 5), 6, 0.6F);
  const Field fine = clouds(ink, 2, ink.whole(1, 5, 10), 6, 0.6F);
  return fill([&](int x, int y) {
    const float vein = smoothstep(0.05F, 0.0F, std::abs(coarse(x, y)));
    const float hair = smoothstep(0.03F, 0.0F, std::abs(fine(x, y)));
    const Tint ground = ink.palette[0] * (1.0F + 0.25F * fine(x, y));
    return blend(blend(ground, ink.palette[1], 0.8F * vein), ink.palette[2], 0.6F * hair);
  });
}

Sheet terrazzo(const Ink& ink) {
  const int cells = ink.whole(0, 20, 50);
  const Voronoi chips = voronoi(kTexels, kTexels, cells, cells, 0.9F, ink.random.fork(1));
  const Field rough = clouds(ink, 2, 40, 3);
  return fill([&](int x, int y) {
    const auto id = static_cast<std::uint64_t>(chips.cell(x, y));
    const auto size = static_cast<float>(ink.random.fork(3).uniform(id, 0.05, 0.55));
    const bool chip = chips.nearest(x, y) * (1.0F + 0.5F * rough(x, y)) < size;
    return chip ? ink.pick(id) * (1.0F + 0.2F * rough(x, y))
                : ink.palette[0] * (1.0F + 0.1F * rough(x, y));
  });
}

Sheet mosaic(const Ink& ink) {
  const int count = 4 * ink.whole(0, 6, 14);
  const float turns = ink.uniform(1, 0.5, 3.0);
  return fill([&](int x, int y) {
    const int i = x * count / kTexels, j = y * count / kTexels;
    if (x - i * kTexels / count == 0 || y - j * kTexels / count == 0) return Tint(70, 68, 66);
    const auto id = static_cast<std::uint64_t>(j * count + i);
    const float cx = std::abs(std::fmod(i, count / 2.0F) - count / 4.0F);
    const float cy = std::abs(std::fmod(j, count / 2.0F) - count / 4.0F);
    const auto ring = static_cast<std::uint64_t>(std::hypot(cx, cy) * turns);
    const float shade = static_cast<float>(ink.random.fork(3).uniform(id, 0.8, 1.2));
    return (ink.random.fork(4).below(id, 6) == 0 ? ink.pick(id) : ink.pick(ring)) * shade;
  });
}

Sheet hexagons(const Ink& ink) {
  const int columns = ink.whole(0, 6, 16), rows = std::max(2, columns * 4 / 7);
  const Field rough = clouds(ink, 1, 12);
  return fill([&](int x, int y) {
    const float u = static_cast<float>(x) * columns / kTexels,
                v = static_cast<float>(y) * rows / kTexels;
    float best = 1e9F, next = 1e9F;
    std::uint64_t id = 0;
    for (int lattice = 0; lattice < 2; ++lattice)
      for (int dj = 0; dj < 2; ++dj)
        for (int di = 0; di < 2; ++di) {
          const float offset = 0.5F * static_cast<float>(lattice);
          const float ci = std::floor(u - offset) + static_cast<float>(di) + offset;
          const float cj = std::floor(v - offset) + static_cast<float>(dj) + offset;
          const float d = std::hypot(u - ci, (v - cj) * 1.75F);
          if (d < best) {
            next = best;
            best = d;
            const int wi = (static_cast<int>(ci) + columns) % columns;
            const int wj = (static_cast<int>(cj) + rows) % rows;
            id = static_cast<std::uint64_t>((wj * columns + wi) * 2 + lattice);
          } else if (d < next) {
            next = d;
          }
        }
    if (next - best < 0.07F) return ink.palette[4];
    return ink.palette[ink.random.fork(2).below(id, 3)] * (1.0F + 0.3F * rough(x, y));
  });
}

Sheet stripes(const Ink& ink) {
  const int slope = ink.whole(0, -1, 1);
  const bool upright = ink.whole(1, 0, 1) == 1;
  std::array<Tint, kTexels> line;
  for (int x = 0, stripe = 0; x < kTexels; ++stripe) {
    const auto id = static_cast<std::uint64_t>(stripe);
    for (int end = x + ink.whole(10 + id, 3, 42); x < std::min(end, kTexels); ++x)
      line[x] = ink.pick(id) * (0.8F + 0.4F * ink.uniform(500 + id, 0, 1));
  }
  const Field rough =
      fbm(kTexels, kTexels, {upright ? 170 : 8, upright ? 8 : 170, 2, 0.6F}, ink.random.fork(2));
  return fill([&](int x, int y) {
    const int along = ((upright ? x : y) + slope * (upright ? y : x) + kTexels) % kTexels;
    return line[along] * (1.0F + 0.2F * rough(x, y));
  });
}

Sheet checks(const Ink& ink) {
  const int count = 2 * ink.whole(0, 4, 16);
  const Field rough = clouds(ink, 1, 30, 4);
  return fill([&](int x, int y) {
    const int i = x * count / kTexels, j = y * count / kTexels;
    const auto id = static_cast<std::uint64_t>(j * count + i);
    const Tint tint =
        ink.random.fork(2).below(id, 9) == 0 ? ink.palette[2] : ink.palette[(i + j) % 2];
    return tint * (1.0F + 0.25F * rough(x, y));
  });
}

Sheet camouflage(const Ink& ink) {
  const Field shape = clouds(ink, 1, ink.whole(0, 3, 9), 5, 0.5F);
  const Field second = clouds(ink, 2, ink.whole(1, 4, 12), 4, 0.5F);
  return fill([&](int x, int y) {
    const int a = shape(x, y) > 0.08F ? 2 : shape(x, y) > -0.12F ? 1 : 0;
    return second(x, y) > 0.2F ? ink.palette[3] : ink.palette[a];
  });
}

Sheet rust(const Ink& ink) {
  const Field where = clouds(ink, 1, 4, 7, 0.65F);
  const Field rough = clouds(ink, 2, 40, 4, 0.7F);
  const Tint metal = blend(Tint(120, 124, 128), ink.palette[0], 0.4F);
  Sheet sheet = fill([&](int x, int y) {
    const float eaten = smoothstep(-0.05F, 0.12F, where(x, y) + 0.15F * rough(x, y));
    const Tint crust = Tint(140, 72, 34) * (0.9F + 0.8F * rough(x, y));
    return blend(metal * (1.0F + 0.1F * rough(x, y)), crust, eaten);
  });
  Canvas canvas(sheet);
  for (std::uint64_t i = 0; i < 40; ++i) {
    const float x = ink.uniform(4 * i, 0, kTexels), y = ink.uniform(4 * i + 1, 0, kTexels);
    canvas.line(x, y, x + ink.uniform(4 * i + 2, -60, 60), y + ink.uniform(4 * i + 3, -20, 20), 1,
                metal * 1.4F);
  }
  return sheet;
}

/// Lines of made-up letters: each letter a few strokes between the nodes of a 3 x 3 lattice.
Sheet signs(const Ink& ink) {
  Sheet sheet(kTexels, kTexels, to_rgb8(ink.palette[0]));
  Canvas canvas(sheet);
  std::uint64_t next = 100;
  const auto draw = [&](double low, double high) { return ink.uniform(next++, low, high); };
  for (int panel = 0; panel < 4; ++panel) {
    const float left = 256.0F * static_cast<float>(panel % 2),
                top = 256.0F * static_cast<float>(panel / 2);
    const Tint ground = ink.pick(next++),
               letters =
                   blend(ground, draw(0, 1) < 0.5F ? Tint(245, 240, 230) : Tint(15, 15, 20), 0.85F);
    canvas.rectangle(left + 6, top + 6, 244, 244, ground);
    canvas.frame(left + 12, top + 12, 232, 232, 3, letters);
    for (float y = top + 24; y < top + 220;) {
      const float height = draw(10, 44);
      if (y + height > top + 236) break;
      for (float x = left + 24; x < left + 228 - height;) {
        for (int strokes = 0; strokes < 4; ++strokes) {
          const float x0 = std::floor(draw(0, 3)) / 3, y0 = std::floor(draw(0, 3)) / 2;
          const float x1 = std::floor(draw(0, 3)) / 3, y1 = std::floor(draw(0, 3)) / 2;
          canvas.line(x + x0 * height, y + y0 * height, x + x1 * height, y + y1 * height,
                      std::max(1.0F, height / 8), letters);
        }
        x += height * (draw(0, 1) < 0.15F ? 1.8F : 0.95F);
      }
      y += 1.5F * height;
    }
  }
  return sheet;
}

Sheet pebbles(const Ink& ink) {
  const int cells = ink.whole(0, 12, 30);
  const Voronoi stones = voronoi(kTexels, kTexels, cells, cells, 0.9F, ink.random.fork(1));
  const Field rough = clouds(ink, 2, 50, 3, 0.7F);
  return fill([&](int x, int y) {
    const float edge = stones.second(x, y) - stones.nearest(x, y);
    const float round = smoothstep(0.02F, 0.45F, edge);
    const auto id = static_cast<std::uint64_t>(stones.cell(x, y));
    const float shade = static_cast<float>(ink.random.fork(3).uniform(id, 0.6, 1.25));
    return ink.pick(id) * (round * shade * (1.0F + 0.25F * rough(x, y)) + 0.12F);
  });
}

/// Mirrored blots in a half-drop repeat, as on old wallpaper.
Sheet wallpaper(const Ink& ink) {
  const int columns = ink.whole(0, 3, 7);
  const int width = kTexels / columns;
  const Field blot = clouds(ink, 1, ink.whole(1, 9, 18), 4, 0.5F);
  return fill([&](int x, int y) {
    const int column = std::min(x / width, columns - 1);
    const int in_x = std::abs(x - column * width - width / 2);
    const int in_y = (y + (column % 2) * kTexels / (2 * columns)) % (kTexels / columns);
    const float value = blot(in_x, in_y);
    const Tint tint = value > 0.12F   ? ink.palette[1]
                      : value > 0.06F ? ink.palette[2]
                                      : ink.palette[0];
    return tint * (x % 4 == 0 ? 0.96F : 1.0F);
  });
}

Sheet circuit(const Ink& ink) {
  Sheet sheet(kTexels, kTexels, to_rgb8(ink.palette[0]));
  Canvas canvas(sheet);
  const float step = ink.uniform(0, 10, 22);
  std::uint64_t next = 100;
  for (int wire = 0; wire < 150; ++wire) {
    float x = step * std::floor(ink.uniform(next++, 0, kTexels / step));
    float y = step * std::floor(ink.uniform(next++, 0, kTexels / step));
    const Tint tint = ink.pick(next++);
    const float thickness = ink.uniform(next++, 1, 4);
    canvas.ellipse(x, y, 0.35F * step, 0.35F * step, 0, tint);
    for (int leg = 0; leg < 4; ++leg) {
      const float length = step * std::floor(ink.uniform(next++, -5, 6));
      const int way = ink.whole(next++, 0, 2);
      const float nx = way == 1 ? x : x + length, ny = way == 0 ? y : y + length;
      canvas.line(x, y, nx, ny, thickness, tint);
      x = nx;
      y = ny;
    }
    canvas.rectangle(x - 0.3F * step, y - 0.3F * step, 0.6F * step, 0.6F * step, tint);
  }
  return sheet;
}

Sheet crackle(const Ink& ink) {
  const int cells = ink.whole(0, 8, 26);
  const Voronoi shards = voronoi(kTexels, kTexels, cells, cells, 1.0F, ink.random.fork(1));
  const Field cloud = clouds(ink, 2, 5);
  return fill([&](int x, int y) {
    const float crack = smoothstep(0.06F, 0.0F, shards.second(x, y) - shards.nearest(x, y));
    return blend(ink.palette[0] * (1.0F + 0.3F * cloud(x, y)), ink.palette[1] * 0.4F, 0.8F * crack);
  });
}

/// Soft clouds with a few spatters: the nearly blank wall among the patterns.
Sheet wash(const Ink& ink) {
  const Field cloud = clouds(ink, 1, 3, 6);
  Sheet sheet = fill([&](int x, int y) { return ink.palette[0] * (1.0F + 0.18F * cloud(x, y)); });
  Canvas canvas(sheet);
  for (std::uint64_t i = 0; i < 60; ++i)
    canvas.ellipse(ink.uniform(9 * i, 0, kTexels), ink.uniform(9 * i + 1, 0, kTexels),
                   ink.uniform(9 * i + 2, 0.7, 5), ink.uniform(9 * i + 3, 0.7, 5), 0,
                   blend(ink.palette[0], ink.pick(i), 0.5F));
  return sheet;
}

struct Family {
  std::string_view name;
  Sheet (*paint)(const Ink&);
};

constexpr std::array kFamilies = {Family{"barcodes", barcodes},
                                  Family{"brick", brick},
                                  Family{"camouflage", camouflage},
                                  Family{"charts", charts},
                                  Family{"checks", checks},
                                  Family{"circuit", circuit},
                                  Family{"collage", collage},
                                  Family{"confetti", confetti},
                                  Family{"crackle", crackle},
                                  Family{"halftone", halftone},
                                  Family{"hexagons", hexagons},
                                  Family{"marble_veins", marble},
                                  Family{"mosaic", mosaic},
                                  Family{"pebbles", pebbles},
                                  Family{"rust", rust},
                                  Family{"scales", scales},
                                  Family{"scribbles", scribbles},
                                  Family{"signs", signs},
                                  Family{"stripes", stripes},
                                  Family{"terrazzo", terrazzo},
                                  Family{"truchet", truchet},
                                  Family{"wallpaper", wallpaper},
                                  Family{"wash", wash},
                                  Family{"wire_mesh", wire_mesh}};

constexpr auto kPatternNames = [] {
  std::array<std::string_view, kFamilies.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kFamilies[i].name;
  return names;
}();

}  // namespace

std::span<const std::string_view> training_patterns() {
  return kPatternNames;
}

Material make_training_pattern(std::string_view family, std::uint64_t seed) {
  const auto* const found = std::ranges::find(kFamilies, family, &Family::name);
  if (found == kFamilies.end())
    throw InputError(fmt::format("unknown training pattern: {}", family));
  const auto index = static_cast<std::uint64_t>(found - kFamilies.begin());
  Material material;
  material.name = fmt::format("training/{}", family);
  material.texture = found->paint(Ink(RandomStream(seed).fork(index)));
  material.tile_m = {kTile, kTile};
  return material;
}

}  // namespace mh
