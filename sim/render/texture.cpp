// SPDX-License-Identifier: Apache-2.0
#include "sim/render/texture.hpp"

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

MipTexture::MipTexture(const Grid2d<Rgb8>& picture) {
  if (picture.empty()) return;
  Picture current(picture.width(), picture.height(), Eigen::Vector3f::Zero());
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) current(x, y) = srgb_to_linear(picture(x, y));
  while (true) {
    Level& level = level_[static_cast<std::size_t>(levels_++)];
    level.width = static_cast<float>(current.width());
    level.height = static_cast<float>(current.height());
    level.offset = static_cast<std::uint32_t>(texels_.size() / 4);
    level.stride = static_cast<std::uint32_t>(current.width() + 1);
    append_wrapped(texels_, current);
    const bool last = (current.width() == 1 && current.height() == 1) || levels_ == 16;
    if (last) break;
    current = halve(current);
  }
}

}  // namespace mh
