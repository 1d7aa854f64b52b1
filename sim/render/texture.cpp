// SPDX-License-Identifier: Apache-2.0
#include "sim/render/texture.hpp"

#include <span>

#include "sim/render/colour.hpp"

namespace mh {
namespace {

using Picture = Grid2d<Eigen::Vector3f>;

/// Halves the width by area averages; an odd width gives each result a share of three texels.
Picture halve_width(const Picture& in) {
  const int width = std::max(1, in.width() / 2);
  Picture out(width, in.height(), Eigen::Vector3f::Zero());
  const double step = static_cast<double>(in.width()) / width;
  for (int x = 0; x < width; ++x) {
    const double begin = x * step, end = begin + step;
    for (int sx = static_cast<int>(begin); sx < in.width() && sx < end; ++sx) {
      const double covered = std::min<double>(end, sx + 1) - std::max<double>(begin, sx);
      const float weight = static_cast<float>(covered / step);
      for (int y = 0; y < in.height(); ++y) out(x, y) += weight * in(sx, y);
    }
  }
  return out;
}

Picture transpose(const Picture& in) {
  Picture out(in.height(), in.width(), Eigen::Vector3f::Zero());
  for (int y = 0; y < in.height(); ++y)
    for (int x = 0; x < in.width(); ++x) out(y, x) = in(x, y);
  return out;
}

Picture halve(const Picture& in) {
  return transpose(halve_width(transpose(halve_width(in))));
}

void append_wrapped(std::vector<std::uint16_t>& texels, const Picture& picture) {
  for (int y = 0; y <= picture.height(); ++y)
    for (int x = 0; x <= picture.width(); ++x) {
      const Eigen::Vector3f& c = picture(x % picture.width(), y % picture.height());
      for (int k = 0; k < 3; ++k)
        texels.push_back(static_cast<std::uint16_t>(std::lround(c[k] * 65535.0F)));
      texels.push_back(0);
    }
}

}  // namespace

Eigen::Vector3f mean_linear(const Grid2d<Rgb8>& picture) {
  if (picture.empty()) return Eigen::Vector3f::Ones();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Rgb8& texel : picture) sum += srgb_to_linear(texel).cast<double>();
  return (sum / static_cast<double>(picture.size())).cast<float>();
}

std::vector<Grid2d<Eigen::Vector3f>> mip_pyramid(const Grid2d<Rgb8>& picture) {
  std::vector<Picture> levels;
  if (picture.empty()) return levels;
  levels.emplace_back(picture.width(), picture.height(), Eigen::Vector3f::Zero());
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) levels[0](x, y) = srgb_to_linear(picture(x, y));
  while (levels.back().size() > 1 && levels.size() < kMipLevels)
    levels.push_back(halve(levels.back()));
  return levels;
}

std::uint32_t TextureTable::add(const Grid2d<Rgb8>& picture) {
  const auto first = static_cast<std::uint32_t>(levels_.size());
  for (const Picture& level : mip_pyramid(picture)) {
    levels_.push_back({static_cast<float>(level.width()), static_cast<float>(level.height()),
                       static_cast<std::int32_t>(texels_.size() / 4), level.width() + 1});
    append_wrapped(texels_, level);
  }
  levels_.resize(first + kMipLevels + 1, levels_.back());
  return first;
}

TextureTable::Place TextureTable::place(Float8 first, Float8 u, Float8 v, Float8 texels) const {
  // Read as an integer, a float is its logarithm to base 2, near enough.
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
  if (all8(level == splat(static_cast<int>(place.level[0])))) {  // mostly
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
    Float8 right, down;  // shares of the neighbours
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
  // Cut towards zero, so that four shares of one never sum to more than it.
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
  // The coarser level's lower row is mostly near its upper one, or another lane's.
  for (const std::array<unsigned, 8>& places : std::span(lookup.texels).first(3))
    for (const unsigned at_texel : places)
      _mm_prefetch(reinterpret_cast<const char*>(texel(at_texel)), _MM_HINT_T0);
}

}  // namespace mh
