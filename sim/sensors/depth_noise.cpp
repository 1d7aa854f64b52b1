// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/depth_noise.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "sim/sensors/normal_table.hpp"

namespace mh {
namespace {

// Coefficients of Nguyen, Izadi and Lovell 2012, section 3: m, 1/m, and px.
constexpr double kAxialFloor = 0.0012, kAxialSquare = 0.0019, kAxialNearest = 0.4;
constexpr double kAxialAngular = 0.0001;
constexpr double kLateralFloor = 0.8, kLateralAngular = 0.035;
constexpr double kSteepRad = std::numbers::pi / 3.0;  // their angular term starts here

/// theta^2 / (pi/2 - theta)^2 where the angular term applies, else 0.
double angular_term(double incidence_rad) {
  const double theta = std::min(incidence_rad, kMaxIncidenceRad);
  if (theta <= kSteepRad) return 0.0;
  const double ratio = theta / (std::numbers::pi / 2.0 - theta);
  return ratio * ratio;
}

/// Tables of what depends only on the incidence, by its cosine.
class IncidenceTable {
 public:
  IncidenceTable() {
    for (std::size_t i = 0; i <= kSteps; ++i) {
      const double incidence = std::acos(static_cast<double>(i) / kSteps);
      lateral_px_[i] = static_cast<float>(lateral_sigma_px(incidence));
      angular_[i] = static_cast<float>(kAxialAngular * angular_term(incidence));
    }
  }
  float lateral_px(float cosine) const { return lateral_px_[step(cosine)]; }
  /// The angular part of axial sigma times the root of the depth.
  float angular(float cosine) const { return angular_[step(cosine)]; }

 private:
  static constexpr std::size_t kSteps = 1024;
  static std::size_t step(float cosine) {
    return static_cast<std::size_t>(static_cast<int>(std::min(cosine, 1.0F) * kSteps + 0.5F));
  }
  std::array<float, kSteps + 1> lateral_px_, angular_;
};

/// The surface seen at a pixel as a plane: over pixels, the inverse depth of a plane is affine.
struct Surface {
  float inverse_depth = 0;         // 1/m; 0 = nothing there
  float slope_x = 0, slope_y = 0;  // 1/m per px
  float cosine = 0;                // of the incidence
};

/// The smaller of the two one-sided differences: it does not cross an object's edge.
float gentler(float before, float here, float after) {
  const float forward = after - here, backward = here - before;
  return std::abs(forward) < std::abs(backward) ? forward : backward;
}

Grid2d<Surface> find_surfaces(const Grid2d<float>& depth_m, const Camera& camera) {
  const int w = depth_m.width(), h = depth_m.height();
  Grid2d<float> inverse(w, h);
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const float z = depth_m.data()[i], reciprocal = 1.0F / z;
    inverse.data()[i] = z > 0.0F ? reciprocal : 0.0F;
  }
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  Grid2d<Surface> surfaces(w, h);
  for (int y = 0; y < h; ++y) {
    const float* here = inverse.row(y).data();
    // In the outermost columns and rows the only available difference serves as both.
    const float* above = y > 0 ? here - w : here;
    const float* below = y + 1 < h ? here + w : here;
    const bool border = y == 0 || y + 1 == h;
    const float b = (static_cast<float>(y) - cy) / fy;
    Surface* out = surfaces.row(y).data();
    const auto fit = [&](int x, float slope_x) {
      const float slope_y = border ? below[x] - above[x] : gentler(above[x], here[x], below[x]);
      // The plane n . X = 1 through X = z d, d = (a, b, 1), so that n . d = 1/z.
      const float a = (static_cast<float>(x) - cx) / fx;
      const float nx = slope_x * fx, ny = slope_y * fy, nz = here[x] - nx * a - ny * b;
      const float squares = (nx * nx + ny * ny + nz * nz) * (a * a + b * b + 1.0F);
      out[x] = {here[x], slope_x, slope_y, here[x] / std::sqrt(squares + 1e-30F)};
    };
    for (int x = 1; x + 1 < w; ++x) fit(x, gentler(here[x - 1], here[x], here[x + 1]));
    fit(0, w > 1 ? here[1] - here[0] : 0.0F);
    if (w > 1) fit(w - 1, here[w - 1] - here[w - 2]);
  }
  return surfaces;
}

/// Processes an image row by row; the passes over a row are separate, so that those without table
/// lookups are vectorized.
class DepthSensor {
 public:
  DepthSensor(const Grid2d<float>& depth_m, const Camera& camera, const DepthNoiseConfig& config,
              RandomStream stream)
      : depth_m_(depth_m),
        surfaces_(find_surfaces(depth_m, camera)),
        config_(config),
        stream_(stream),
        steps_per_inverse_depth_(
            static_cast<float>(kDisparityStepsPerPx * camera.fx_px * camera.baseline_m)),
        row_(static_cast<std::size_t>(depth_m.width())) {}

  void read_row(int y, std::span<float> depth) {
    look(y, depth);
    if (config_.grazing_holes) punch_holes(depth);
    if (config_.projector_shadow) cast_shadow(y, depth);
    if (config_.axial) add_axial_noise(depth);
    if (config_.quantization) quantize(depth);
    const auto nearest = static_cast<float>(config_.min_range_m);
    const auto farthest = static_cast<float>(config_.max_range_m);
    for (float& z : depth) z = z >= nearest && z <= farthest ? z : 0.0F;
  }

 private:
  struct Draw {
    float normal;   // for the axial noise
    float cosine;   // of the incidence on the surface seen
    float angular;  // see IncidenceTable
  };

  /// Draws a row's random numbers and finds the surface that each pixel sees.
  void look(int y, std::span<float> depth) {
    const int w = depth_m_.width(), h = depth_m_.height();
    const auto first = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(w);
    std::copy_n(depth_m_.row(y).begin(), w, depth.begin());
    for (int x = 0; x < w; ++x) {
      const std::uint64_t bits = stream_.bits(first + static_cast<std::uint64_t>(x));
      const auto normal = [&](int k) {
        return normals_[(bits >> (kNormalBits * k)) & kNormalMask];
      };
      const Surface* seen = &surfaces_(x, y);
      if (config_.lateral) {
        const float sigma = incidence_.lateral_px(seen->cosine);
        const int sx = std::clamp(x + round(sigma * normal(0)), 0, w - 1);
        const int sy = std::clamp(y + round(sigma * normal(1)), 0, h - 1);
        seen = &surfaces_(sx, sy);
        depth[static_cast<std::size_t>(x)] = depth_of(*seen, x - sx, y - sy);
      }
      row_[static_cast<std::size_t>(x)] = {normal(2), seen->cosine,
                                           incidence_.angular(seen->cosine)};
    }
  }

  static int round(float value) { return _mm_cvt_ss2si(_mm_set_ss(value)); }

  /// Depth of a surface some pixels away from where it was seen. Following its plane limits the
  /// lateral noise to the edges: on a slope it would duplicate the axial noise.
  static float depth_of(const Surface& seen, int dx, int dy) {
    const float w = seen.inverse_depth;
    const float moved =
        w + seen.slope_x * static_cast<float>(dx) + seen.slope_y * static_cast<float>(dy);
    // A thin object has no plane to follow.
    const float limited = std::min(std::max(moved, 0.8F * w), 1.25F * w);
    const float z = 1.0F / limited;
    return w > 0.0F ? z : 0.0F;
  }

  void punch_holes(std::span<float> depth) const {
    const auto least = static_cast<float>(std::cos(kMaxIncidenceRad));
    for (std::size_t x = 0; x < depth.size(); ++x)
      depth[x] = row_[x].cosine < least ? 0.0F : depth[x];
  }

  /// What the projector sees of a row, nearest first: a pixel with disparity d is at column x - d
  /// of the projector's image. Pixels behind another are in its shadow.
  void cast_shadow(int y, std::span<float> depth) {
    constexpr float kNothing = 0.0F;
    constexpr float kStep = 1.0F;  // px of disparity; a smooth surface does not shade itself
    const float focal_base = steps_per_inverse_depth_ / static_cast<float>(kDisparityStepsPerPx);
    const int w = depth_m_.width();
    const Surface* row = surfaces_.row(y).data();
    const auto column = [&](int x) {
      return static_cast<float>(x) - focal_base * row[x].inverse_depth;
    };
    // Columns left of the image matter too: the projector's image begins at 1 - w.
    nearest_.assign(2 * static_cast<std::size_t>(w), kNothing);
    const auto cell = [&](int u) { return &nearest_[static_cast<std::size_t>(u + w)]; };
    for (int x = 0; x < w; ++x) {
      if (row[x].inverse_depth <= 0.0F) continue;
      const int u = static_cast<int>(std::floor(column(x)));
      if (u < -w) continue;
      for (int k = u; k <= std::min(u + 1, w - 1); ++k)
        *cell(k) = std::max(*cell(k), focal_base * row[x].inverse_depth);
    }
    for (int x = 0; x < w; ++x) {
      const int u = static_cast<int>(std::floor(column(x) + 0.5F));
      if (u >= -w && *cell(u) > focal_base * row[x].inverse_depth + kStep)
        depth[static_cast<std::size_t>(x)] = 0.0F;
    }
  }

  void add_axial_noise(std::span<float> depth) const {
    for (std::size_t x = 0; x < depth.size(); ++x) {
      const float away = depth[x] - static_cast<float>(kAxialNearest);
      const float sigma = static_cast<float>(kAxialFloor) +
                          static_cast<float>(kAxialSquare) * away * away +
                          row_[x].angular / std::sqrt(std::max(depth[x], 1e-3F));
      const float noisy = depth[x] + sigma * row_[x].normal;
      depth[x] = depth[x] > 0.0F ? noisy : 0.0F;
    }
  }

  void quantize(std::span<float> depth) const {
    for (float& z : depth) {
      const float steps = std::floor(steps_per_inverse_depth_ / z + 0.5F);
      const float quantized = steps_per_inverse_depth_ / steps;
      z = z > 0.0F && steps >= 1.0F ? quantized : 0.0F;
    }
  }

  const Grid2d<float>& depth_m_;
  Grid2d<Surface> surfaces_;
  DepthNoiseConfig config_;
  RandomStream stream_;
  float steps_per_inverse_depth_;
  std::vector<Draw> row_;
  std::vector<float> nearest_;  // disparity of what the projector sees, px
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
  DepthSensor sensor(depth_m, camera, config, stream);
  Grid2d<float> read(depth_m.width(), depth_m.height());
  for (int y = 0; y < read.height(); ++y) sensor.read_row(y, read.row(y));
  return read;
}

}  // namespace mh
