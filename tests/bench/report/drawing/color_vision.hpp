// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Matrices from linear RGB to linear RGB as a dichromat sees it: severity 1 in Machado, Oliveira
/// and Fernandes, A Physiologically-based Model for Simulation of Color Vision Deficiency, IEEE
/// TVCG 15(6), 2009. The first one is normal color vision.
inline std::array<Eigen::Matrix3d, 4> color_visions() {
  Eigen::Matrix3d usual = Eigen::Matrix3d::Identity(), protanopia, deuteranopia, tritanopia;
  protanopia << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
      1.051998;
  deuteranopia << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
      0.968881;
  tritanopia << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367,
      0.303900;
  return {usual, protanopia, deuteranopia, tritanopia};
}

/// L*a*b* under D65 of an sRGB color, as seen with this color vision.
inline Eigen::Vector3d seen_lab(Rgb8 color, const Eigen::Matrix3d& vision) {
  const auto linear = [](std::uint8_t value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const Eigen::Vector3d rgb =
      (vision * Eigen::Vector3d(linear(color.r), linear(color.g), linear(color.b)))
          .cwiseMax(0.0)
          .cwiseMin(1.0);
  Eigen::Matrix3d xyz_from_rgb;
  xyz_from_rgb << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339,
      0.1191920, 0.9503041;
  const Eigen::Vector3d xyz =
      (xyz_from_rgb * rgb).cwiseQuotient(Eigen::Vector3d(0.95047, 1, 1.08883));
  const auto f = [](double t) {
    return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  };
  return {116 * f(xyz.y()) - 16, 500 * (f(xyz.x()) - f(xyz.y())), 200 * (f(xyz.y()) - f(xyz.z()))};
}

/// CIEDE2000 as in Sharma, Wu and Dalal, The CIEDE2000 Color-Difference Formula, Color Research and
/// Application 30(1), 2005.
inline double ciede2000(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  constexpr double kDegree = std::numbers::pi / 180;
  const auto seventh = [](double c) {
    return std::sqrt(std::pow(c, 7) / (std::pow(c, 7) + std::pow(25.0, 7)));
  };
  const double mean_chroma = 0.5 * (first.tail<2>().norm() + second.tail<2>().norm());
  const double stretch = 1 + 0.5 * (1 - seventh(mean_chroma));
  const auto chroma = [&](const Eigen::Vector3d& lab) {
    return std::hypot(stretch * lab[1], lab[2]);
  };
  const auto hue = [&](const Eigen::Vector3d& lab) {
    const double h = std::atan2(lab[2], stretch * lab[1]) / kDegree;
    return h < 0 ? h + 360 : h;
  };
  const double c1 = chroma(first), c2 = chroma(second), h1 = hue(first), h2 = hue(second);
  const bool gray = c1 * c2 == 0;
  double turn = gray ? 0 : h2 - h1;
  if (turn > 180) turn -= 360;
  if (turn < -180) turn += 360;
  double h = h1 + h2;
  if (!gray && std::abs(h1 - h2) > 180) h += h < 360 ? 360 : -360;
  if (!gray) h /= 2;
  const double l = 0.5 * (first[0] + second[0]), c = 0.5 * (c1 + c2);
  const auto cosine = [&](double times, double shift) {
    return std::cos((times * h + shift) * kDegree);
  };
  const double t =
      1 - 0.17 * cosine(1, -30) + 0.24 * cosine(2, 0) + 0.32 * cosine(3, 6) - 0.20 * cosine(4, -63);
  const double sl = 1 + 0.015 * (l - 50) * (l - 50) / std::sqrt(20 + (l - 50) * (l - 50));
  const double dl = (second[0] - first[0]) / sl, dc = (c2 - c1) / (1 + 0.045 * c);
  const double dh = 2 * std::sqrt(c1 * c2) * std::sin(turn / 2 * kDegree) / (1 + 0.015 * c * t);
  const double blue =
      -2 * seventh(c) * std::sin(60 * std::exp(-((h - 275) / 25) * ((h - 275) / 25)) * kDegree);
  return std::sqrt(dl * dl + dc * dc + dh * dh + blue * dc * dh);
}

/// The difference between two colors under the color vision that separates them least.
inline double least_difference(Rgb8 a, Rgb8 b) {
  double least = 1e9;
  for (const Eigen::Matrix3d& vision : color_visions())
    least = std::min(least, ciede2000(seen_lab(a, vision), seen_lab(b, vision)));
  return least;
}

}  // namespace mh
