// SPDX-License-Identifier: Apache-2.0
#include "sim/render/texture.hpp"

#include <cmath>
#include <limits>

#include "sim/render/color.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Image = Grid2d<Eigen::Vector3f>;

/// Weights of the texels that are averaged into each texel of a row of half the length; with an odd
/// length, three contribute to each.
struct Halved {
  explicit Halved(int length) : before(length), after(std::max(1, length / 2)) {}

  /// Calls add(place, share) for each texel that contributes to place `at` of the shorter row.
  template <class Add>
  void each(int at, const Add& add) const {
    const double step = static_cast<double>(before) / after;
    const double begin = at * step, end = begin + step;
    for (int from = static_cast<int>(begin); from < before && from < end; ++from) {
      const double covered = std::min<double>(end, from + 1) - std::max<double>(begin, from);
      add(from, static_cast<float>(covered / step));
    }
  }

  int before, after;
};

/// Halves the size of an image, given by `texel(x, y)`, by averaging over areas.
template <class Texel>
Image halve(int width, int height, const Texel& texel) {
  const Halved across(width), down(height);
  Image out(across.after, down.after, Eigen::Vector3f::Zero());
  std::vector<Eigen::Vector3f> row(static_cast<std::size_t>(across.after));
  for (int y = 0; y < down.after; ++y)
    down.each(y, [&](int from_y, float share_y) {
      for (int x = 0; x < across.after; ++x) {
        Eigen::Vector3f& sum = row[static_cast<std::size_t>(x)].setZero();
        across.each(x, [&](int from_x, float share) { sum += share * texel(from_x, from_y); });
      }
      for (int x = 0; x < across.after; ++x)
        out(x, y) += share_y * row[static_cast<std::size_t>(x)];
    });
  return out;
}

/// Visits every level below an image's own, finest first.
template <class Visit>
void for_each_coarser_level(const Grid2d<Rgb8>& image, const Visit& visit) {
  if (image.size() <= 1) return;
  Image level = halve(image.width(), image.height(),
                      [&](int x, int y) { return srgb_to_linear(image(x, y)); });
  for (int count = 2;; ++count) {
    visit(level);
    if (level.size() <= 1 || count == kMipLevels) return;
    level = halve(level.width(), level.height(),
                  [&](int x, int y) -> const Eigen::Vector3f& { return level(x, y); });
  }
}

std::uint16_t sixteen_bits(float linear) {
  return static_cast<std::uint16_t>(std::lround(linear * 65535.0F));
}

/// @param texel  texel(x, y) is the linear RGB there
template <class Texel>
void append_wrapped(std::vector<std::uint16_t>& texels, int width, int height, const Texel& texel) {
  for (int y = 0; y <= height; ++y)
    for (int x = 0; x <= width; ++x) {
      const Eigen::Vector3f& c = texel(x % width, y % height);
      for (int k = 0; k < 3; ++k) texels.push_back(sixteen_bits(c[k]));
    }
}

/// Texels that an image takes with all its levels.
std::size_t texels_of(const Grid2d<Rgb8>& image) {
  std::size_t sum = 0;
  int width = image.width(), height = image.height();
  for (int level = 0; level < kMipLevels; ++level) {
    sum += (static_cast<std::size_t>(width) + 1) * (static_cast<std::size_t>(height) + 1);
    if (width == 1 && height == 1) break;
    width = std::max(1, width / 2), height = std::max(1, height / 2);
  }
  return sum;
}

}  // namespace

Eigen::Vector3f mean_linear(const Grid2d<Rgb8>& image) {
  if (image.empty()) return Eigen::Vector3f::Ones();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Rgb8& texel : image) sum += srgb_to_linear(texel).cast<double>();
  return (sum / static_cast<double>(image.size())).cast<float>();
}

std::vector<Grid2d<Eigen::Vector3f>> mip_pyramid(const Grid2d<Rgb8>& image) {
  std::vector<Image> levels;
  if (image.empty()) return levels;
  levels.emplace_back(image.width(), image.height(), Eigen::Vector3f::Zero());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) levels[0](x, y) = srgb_to_linear(image(x, y));
  for_each_coarser_level(image, [&](const Image& level) { levels.push_back(level); });
  return levels;
}

void TextureTable::reserve(std::span<const Grid2d<Rgb8>* const> images) {
  std::size_t texels = texels_.size() / 3;
  for (const Grid2d<Rgb8>* image : images) texels += texels_of(*image);
  if (texels > std::numeric_limits<std::int32_t>::max())
    throw InputError("the scene's textures are too large: more than 2^31 texels");
  texels_.reserve(3 * texels + kBehind);
}

std::uint32_t TextureTable::add(const Grid2d<Rgb8>& image) {
  const auto first = static_cast<std::uint32_t>(levels_.size());
  const auto begin_level = [&](int width, int height) {
    levels_.push_back({static_cast<float>(width), static_cast<float>(height),
                       static_cast<std::int32_t>(texels_.size() / 3), width + 1});
  };
  if (!texels_.empty()) texels_.resize(texels_.size() - kBehind);
  begin_level(image.width(), image.height());
  append_wrapped(texels_, image.width(), image.height(),
                 [&](int x, int y) { return srgb_to_linear(image(x, y)); });
  for_each_coarser_level(image, [&](const Image& level) {
    begin_level(level.width(), level.height());
    append_wrapped(texels_, level.width(), level.height(),
                   [&](int x, int y) -> const Eigen::Vector3f& { return level(x, y); });
  });
  texels_.resize(texels_.size() + kBehind);
  levels_.resize(first + kMipLevels + 1, levels_.back());
  return first;
}

TextureTable::Place TextureTable::place(Float8 first, Float8 u, Float8 v, Float8 texels) const {
  // A float's bits, read as an integer, approximate its base-2 logarithm.
  const Float8 logarithm = to_float((Int8)texels) * 0x1.0p-23F - 127.0F;
  const Float8 level = clamp8(0.5F * logarithm, 0.0F, kMipLevels - 1);
  const Int8 whole = to_int(level);
  Place place{u - floor8(u), v - floor8(v), level - to_float(whole), {}};
  store8(place.level.data(), (Int8)first + whole);
  return place;
}

void TextureTable::look_up(const Place& place, Lookup& lookup) const {
  // Width, height, offset and stride of the finer level, then of the coarser one.
  std::array<std::array<Float8, 4>, 2> levels;
  const Int8 level = load8(place.level.data());
  const Level* first = &levels_[place.level[0]];
  if (all8(level == splat(static_cast<int>(place.level[0])))) {  // usually
    for (std::size_t i = 0; i < 2; ++i) levels[i] = spread_fields(&first[i].width);
  } else {
    for (std::size_t i = 0; i < 2; ++i) {
      std::array<const float*, 8> from;
      for (std::size_t k = 0; k < 8; ++k) from[k] = &levels_[place.level[k] + i].width;
      levels[i] = load_fields(from);
    }
  }

  struct Corner {
    Int8 texel, stride;
    Float8 right, down;  // shares of the neighbors
  };
  const auto corner = [&](const std::array<Float8, 4>& of) {
    const auto [width, height, offset, stride] = of;
    Float8 x = place.u * width - 0.5F, y = place.v * height - 0.5F;
    x = x < 0.0F ? x + width : x;
    y = y < 0.0F ? y + height : y;
    const Int8 x0 = to_int(x), y0 = to_int(y);
    return Corner{(Int8)offset + y0 * (Int8)stride + x0, (Int8)stride, x - to_float(x0),
                  y - to_float(y0)};
  };
  const Corner fine = corner(levels[0]), coarse = corner(levels[1]);
  // Truncated toward zero, so that the four shares, which should sum to 1, never sum to more.
  const auto share = [](Float8 part) { return to_int(part * kOne); };
  const auto two = [](Int8 low, Int8 high) { return low | high << 16; };
  const auto store = [](std::array<std::uint64_t, 8>& to, Int8 low, Int8 high) {
    const __m256i even = _mm256_unpacklo_epi32((__m256i)low, (__m256i)high);
    const __m256i odd = _mm256_unpackhi_epi32((__m256i)low, (__m256i)high);
    auto* out = reinterpret_cast<__m256i*>(to.data());
    _mm256_store_si256(out, _mm256_permute2x128_si256(even, odd, 0x20));
    _mm256_store_si256(out + 1, _mm256_permute2x128_si256(even, odd, 0x31));
  };
  store8(lookup.texels[0].data(), fine.texel);
  store8(lookup.texels[1].data(), fine.texel + fine.stride);
  store8(lookup.texels[2].data(), coarse.texel);
  store8(lookup.texels[3].data(), coarse.texel + coarse.stride);
  const Float8 blend = place.blend, of_fine = 1.0F - blend;
  store(lookup.across, two(share(of_fine * (1.0F - fine.right)), share(of_fine * fine.right)),
        two(share(blend * (1.0F - coarse.right)), share(blend * coarse.right)));
  store(lookup.down, two(share(1.0F - fine.down), share(fine.down)),
        two(share(1.0F - coarse.down), share(coarse.down)));
  // The coarser level's lower row is not prefetched: it is mostly near its upper row or near a row
  // of another lane.
  for (const std::array<unsigned, 8>& places : std::span(lookup.texels).first(3))
    for (const unsigned at_texel : places)
      _mm_prefetch(reinterpret_cast<const char*>(texel(at_texel)), _MM_HINT_T0);
}

}  // namespace mh
