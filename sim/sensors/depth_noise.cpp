// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/depth_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/sensors/normal_table.hpp"

namespace mh {
namespace {

// Coefficients of Nguyen, Izadi and Lovell 2012, section 3: m, 1/m, and px.
constexpr double kAxialFloor = 0.0012, kAxialSquare = 0.0019, kAxialNearest = 0.4;
constexpr double kAxialAngular = 0.0001;
constexpr double kLateralFloor = 0.8, kLateralAngular = 0.035;
constexpr double kSteepRad = std::numbers::pi / 3.0;  // their angular term starts here

/// theta^2 / (pi/2 - theta)^2 where the angular term counts, else 0.
double angular_term(double incidence_rad) {
  const double theta = std::min(incidence_rad, kMaxIncidenceRad);
  if (theta <= kSteepRad) return 0.0;
  const double ratio = theta / (std::numbers::pi / 2.0 - theta);
  return ratio * ratio;
}

/// What depends on the incidence alone, by its cosine.
struct IncidenceTable {
  static constexpr int kSteps = 1024;
  std::array<float, kSteps + 1> lateral_px, axial_m_sqrt_m;
  float min_cosine;

  IncidenceTable() : min_cosine(static_cast<float>(std::cos(kMaxIncidenceRad))) {
    for (int i = 0; i <= kSteps; ++i) {
      const double incidence = std::acos(static_cast<double>(i) / kSteps);
      lateral_px[static_cast<std::size_t>(i)] = static_cast<float>(lateral_sigma_px(incidence));
      axial_m_sqrt_m[static_cast<std::size_t>(i)] =
          static_cast<float>(kAxialAngular * angular_term(incidence));
    }
  }
  static std::size_t step(float cosine) {
    return static_cast<std::size_t>(std::min(cosine, 1.0F) * kSteps + 0.5F);
  }
};

/// The surface behind a pixel as a plane: over pixels, the inverse depth of a plane is affine.
struct Surfaces {
  Grid2d<float> inverse_depth;     // 1/m; 0 = nothing there
  Grid2d<float> slope_x, slope_y;  // 1/m per px
  Grid2d<float> cosine;            // of the incidence
};

/// The smaller of the two one-sided differences: it does not reach across an edge of the object.
float gentler(float before, float here, float after) {
  const float forward = after - here, backward = here - before;
  return std::abs(forward) < std::abs(backward) ? forward : backward;
}

Surfaces find_surfaces(const Grid2d<float>& depth_m, const Camera& camera) {
  const int w = depth_m.width(), h = depth_m.height();
  Surfaces s{Grid2d<float>(w, h), Grid2d<float>(w, h), Grid2d<float>(w, h), Grid2d<float>(w, h)};
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const float z = depth_m.data()[i];
    s.inverse_depth.data()[i] = z > 0.0F ? 1.0F / z : 0.0F;
  }
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  for (int y = 0; y < h; ++y) {
    const float* row = s.inverse_depth.row(y).data();
    // At the border the difference that exists stands for both.
    const float* above = y > 0 ? row - w : nullptr;
    const float* below = y + 1 < h ? row + w : nullptr;
    float* slope_x = s.slope_x.row(y).data();
    float* slope_y = s.slope_y.row(y).data();
    float* cosine = s.cosine.row(y).data();
    for (int x = 1; x + 1 < w; ++x) slope_x[x] = gentler(row[x - 1], row[x], row[x + 1]);
    if (w > 1) slope_x[0] = row[1] - row[0], slope_x[w - 1] = row[w - 1] - row[w - 2];
    if (above && below) {
      for (int x = 0; x < w; ++x) slope_y[x] = gentler(above[x], row[x], below[x]);
    } else if (above || below) {
      for (int x = 0; x < w; ++x) slope_y[x] = above ? row[x] - above[x] : below[x] - row[x];
    }
    const float b = (static_cast<float>(y) - cy) / fy;
    for (int x = 0; x < w; ++x) {
      // The plane n . X = 1 through the point X = z d, d = (a, b, 1), so that n . d = 1/z.
      const float a = (static_cast<float>(x) - cx) / fx;
      const float nx = slope_x[x] * fx, ny = slope_y[x] * fy, nz = row[x] - nx * a - ny * b;
      const float squares = (nx * nx + ny * ny + nz * nz) * (a * a + b * b + 1.0F);
      cosine[x] = squares > 0.0F ? row[x] / std::sqrt(squares) : 1.0F;
    }
  }
  return s;
}

class DepthSensor {
 public:
  DepthSensor(const Grid2d<float>& depth_m, const Camera& camera, const DepthNoiseConfig& config,
              RandomStream stream)
      : depth_m_(depth_m),
        surfaces_(find_surfaces(depth_m, camera)),
        config_(config),
        stream_(stream),
        steps_per_inverse_depth_(
            static_cast<float>(kDisparityStepsPerPx * camera.fx_px * camera.baseline_m)) {}

  float read(int x, int y) const {
    const auto pixel =
        static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(depth_m_.width()) +
        static_cast<std::uint64_t>(x);
    const std::uint64_t bits = stream_.bits(pixel);
    const auto normal = [&](int k) { return normals_[(bits >> (kNormalBits * k)) & kNormalMask]; };
    int sx = x, sy = y;
    if (config_.lateral) stray(x, y, normal(0), normal(1), sx, sy);
    float depth = depth_seen(x, y, sx, sy);
    if (depth <= 0.0F) return 0.0F;
    const float cosine = surfaces_.cosine(sx, sy);
    if (config_.grazing_holes && cosine < incidence_.min_cosine) return 0.0F;
    if (config_.axial) depth += axial_sigma(depth, cosine) * normal(2);
    if (config_.quantisation) {
      const float steps = std::floor(steps_per_inverse_depth_ / depth + 0.5F);
      depth = steps >= 1.0F ? steps_per_inverse_depth_ / steps : 0.0F;
    }
    const bool in_range = depth >= static_cast<float>(config_.min_range_m) &&
                          depth <= static_cast<float>(config_.max_range_m);
    return in_range ? depth : 0.0F;
  }

 private:
  /// Where a pixel really looks: some pixels aside.
  void stray(int x, int y, float nx, float ny, int& sx, int& sy) const {
    const float sigma = incidence_.lateral_px[IncidenceTable::step(surfaces_.cosine(x, y))];
    sx = std::clamp(x + static_cast<int>(std::lrint(sigma * nx)), 0, depth_m_.width() - 1);
    sy = std::clamp(y + static_cast<int>(std::lrint(sigma * ny)), 0, depth_m_.height() - 1);
  }

  /// Depth, at pixel (x, y), of the surface seen at (sx, sy). Following its plane back keeps the
  /// lateral noise to the edges: on a slope it would else double what axial noise already is.
  float depth_seen(int x, int y, int sx, int sy) const {
    if (sx == x && sy == y) return depth_m_(x, y);
    const float w = surfaces_.inverse_depth(sx, sy);
    if (w <= 0.0F) return 0.0F;
    const float moved = w + surfaces_.slope_x(sx, sy) * static_cast<float>(x - sx) +
                        surfaces_.slope_y(sx, sy) * static_cast<float>(y - sy);
    return 1.0F / std::clamp(moved, 0.8F * w, 1.25F * w);  // a thin thing has no plane to follow
  }

  float axial_sigma(float depth, float cosine) const {
    const float z = depth - static_cast<float>(kAxialNearest);
    const float angular = incidence_.axial_m_sqrt_m[IncidenceTable::step(cosine)];
    return static_cast<float>(kAxialFloor) + static_cast<float>(kAxialSquare) * z * z +
           (angular > 0.0F ? angular / std::sqrt(depth) : 0.0F);
  }

  const Grid2d<float>& depth_m_;
  Surfaces surfaces_;
  DepthNoiseConfig config_;
  RandomStream stream_;
  float steps_per_inverse_depth_;
  const std::array<float, 1 << kNormalBits>& normals_ = normal_table();
  const IncidenceTable incidence_;
};

}  // namespace

double axial_sigma_m(double depth_m, double incidence_rad) {
  const double z = depth_m - kAxialNearest;
  return kAxialFloor + kAxialSquare * z * z +
         kAxialAngular / std::sqrt(depth_m) * angular_term(incidence_rad);
}

double lateral_sigma_px(double incidence_rad) {
  const double theta = std::min(incidence_rad, kMaxIncidenceRad);
  return kLateralFloor + kLateralAngular * theta / (std::numbers::pi / 2.0 - theta);
}

Grid2d<float> noisy_depth(const Grid2d<float>& depth_m, const Camera& camera,
                          const DepthNoiseConfig& config, RandomStream stream) {
  const DepthSensor sensor(depth_m, camera, config, stream);
  Grid2d<float> read(depth_m.width(), depth_m.height());
  for (int y = 0; y < read.height(); ++y)
    for (int x = 0; x < read.width(); ++x) read(x, y) = sensor.read(x, y);
  return read;
}

}  // namespace mh
