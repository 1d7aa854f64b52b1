// SPDX-License-Identifier: Apache-2.0
#include "scenes/materials/materials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scenes/materials/noise.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

double level(Rgb8 c) {
  return (c.r + c.g + c.b) / 3.0;
}

MaterialSpec spec_of(std::string_view kind) {
  return {.name = "m", .kind = std::string(kind), .seed = 4, .size_m = {0.5F, 0.4F}};
}

TEST(MakeMaterial, EveryKindFollowsFromItsSpecAlone) {
  ASSERT_GE(material_kinds().size(), 26U);
  ASSERT_TRUE(std::ranges::is_sorted(material_kinds()));
  for (const std::string_view kind : material_kinds()) {
    MaterialSpec spec = spec_of(kind);
    const Material first = make_material(spec);
    ASSERT_FALSE(first.texture.empty()) << kind;
    EXPECT_LE(std::max(first.texture.width(), first.texture.height()), 1024) << kind;
    EXPECT_EQ(first.texture, make_material(spec).texture) << kind;
    spec.seed = 5;
    EXPECT_NE(first.texture, make_material(spec).texture) << kind;
  }
}

TEST(MakeMaterial, TexelsAreSquareAndOneToFourMillimeters) {
  for (const std::string_view kind : material_kinds()) {
    const Material m = make_material(spec_of(kind));
    const float u = m.tile_m.x() / static_cast<float>(m.texture.width());
    const float v = m.tile_m.y() / static_cast<float>(m.texture.height());
    EXPECT_NEAR(u, v, 0.01F * u) << kind;
    EXPECT_GE(u, 0.00099F) << kind;
    EXPECT_LE(u, 0.00401F) << kind;
  }
}

TEST(MakeMaterial, ImagesCoverTheirSizeOnce) {
  for (const std::string_view kind : material_kinds()) {
    const Material m = make_material(spec_of(kind));
    EXPECT_EQ(is_image(kind), m.tile_m == Eigen::Vector2f(0.5F, 0.4F)) << kind;
  }
  EXPECT_TRUE(is_image("poster"));
  EXPECT_FALSE(is_image("wood_boards"));
}

/// Mean absolute step between two columns (or rows, for the transposed access).
template <class At>
double step_between(int a, int b, int count, const At& at) {
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += std::abs(level(at(a, i)) - level(at(b, i)));
  return sum / count;
}

/// Expects that the step across the seam is no larger than the largest step inside: no visible
/// seam.
template <class At>
void expect_no_seam(int size, int count, const At& at, std::string_view kind) {
  double largest = 0.0;
  for (int i = 0; i + 1 < size; ++i) largest = std::max(largest, step_between(i, i + 1, count, at));
  EXPECT_LE(step_between(size - 1, 0, count, at), largest * 1.05 + 0.2) << kind;
}

TEST(MakeMaterial, RepeatingKindsHaveNoSeam) {
  for (const std::string_view kind : material_kinds()) {
    if (is_image(kind)) continue;
    const Grid2d<Rgb8> t = make_material(spec_of(kind)).texture;
    expect_no_seam(
        t.width(), t.height(), [&](int x, int y) { return t(x, y); }, kind);
    expect_no_seam(
        t.height(), t.width(), [&](int y, int x) { return t(x, y); }, kind);
  }
}

TEST(MakeMaterial, RepeatingKindsKeepTheirToneOnAverage) {
  for (const std::string_view kind : material_kinds()) {
    if (is_image(kind) || kind == "curtain_fabric" || kind == "bark") continue;  // two tones
    const MaterialSpec spec = spec_of(kind);
    double r = 0, g = 0, b = 0;
    const Grid2d<Rgb8> t = make_material(spec).texture;
    for (const Rgb8& c : t) {
      r += c.r;
      g += c.g;
      b += c.b;
    }
    const auto n = static_cast<double>(t.size());
    EXPECT_NEAR(r / n, spec.tone.r, 18.0) << kind;
    EXPECT_NEAR(g / n, spec.tone.g, 18.0) << kind;
    EXPECT_NEAR(b / n, spec.tone.b, 18.0) << kind;
  }
}

double contrast(const Grid2d<Rgb8>& t) {
  double sum = 0, squares = 0;
  for (const Rgb8& c : t) {
    sum += level(c);
    squares += level(c) * level(c);
  }
  const auto n = static_cast<double>(t.size());
  return std::sqrt(std::max(0.0, squares / n - sum / n * sum / n));
}

TEST(MakeMaterial, BlankSurfacesStayBlankAndPatternsDoNot) {
  for (const std::string_view kind : {"plaster", "ceiling_paint", "plastic", "ceramic", "glass"})
    EXPECT_LT(contrast(make_material(spec_of(kind)).texture), 2.5) << kind;
  for (const std::string_view kind : {"wood_boards", "parquet", "stone", "book_spines", "poster",
                                      "painting", "rug_pattern", "screen", "garden_view"})
    EXPECT_GT(contrast(make_material(spec_of(kind)).texture), 9.0) << kind;
}

TEST(MakeMaterial, VariationScalesContrast) {
  for (const std::string_view kind : {"wood_grain", "fabric", "stone", "carpet", "plaster"}) {
    MaterialSpec spec = spec_of(kind);
    spec.variation = 0.1;
    const double faint = contrast(make_material(spec).texture);
    spec.variation = 1.0;
    EXPECT_GT(contrast(make_material(spec).texture), 2.0 * faint) << kind;
  }
}

TEST(MakeMaterial, RefusesBadSpecs) {
  EXPECT_THROW(make_material({.name = "x", .kind = "kryptonite"}), InputError);
  EXPECT_THROW(make_material({.name = "x", .kind = "tiles", .variation = 1.5}), InputError);
  EXPECT_THROW(make_material({.name = "x", .kind = "poster", .size_m = {0, 1}}), InputError);
  EXPECT_THROW(make_material({.name = "x", .kind = "poster", .size_m = {1, NAN}}), InputError);
  EXPECT_THROW(is_image(""), InputError);
  EXPECT_EQ(make_material({.name = "", .kind = "glass"}).name, "glass");
}

TEST(Noise, WhiteNoiseIsStandard) {
  const Field noise = white_noise(300, 300, RandomStream(1));
  double sum = 0, squares = 0;
  for (const float v : noise) {
    sum += v;
    squares += static_cast<double>(v) * v;
  }
  // 90,000 samples: the mean is known to 0.0033, the variance to 0.004 (one sigma).
  EXPECT_NEAR(sum / 90000, 0.0, 0.015);
  EXPECT_NEAR(squares / 90000, 1.0, 0.02);
}

TEST(Noise, VoronoiFindsTheNearestPoint) {
  const Voronoi v = voronoi(64, 48, 8, 6, 0.0F, RandomStream(3));  // points at cell centers
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      EXPECT_EQ(v.cell(x, y), y / 8 * 8 + x / 8);
      const float dx = (static_cast<float>(x % 8) + 0.5F) / 8 - 0.5F;
      const float dy = (static_cast<float>(y % 8) + 0.5F) / 8 - 0.5F;
      EXPECT_NEAR(v.nearest(x, y), std::hypot(dx, dy), 1e-5F);
      EXPECT_GE(v.second(x, y), v.nearest(x, y));
    }
}

TEST(Noise, SampleAgreesWithTexelsAndWrapsAround) {
  const Field f = value_noise(20, 10, 5, 5, RandomStream(2));
  EXPECT_FLOAT_EQ(sample(f, 3, 4), f(3, 4));
  EXPECT_FLOAT_EQ(sample(f, 23, -6), f(3, 4));
  EXPECT_FLOAT_EQ(sample(f, 19.5F, 2), 0.5F * (f(19, 2) + f(0, 2)));
}

}  // namespace
}  // namespace mh
