// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/depth_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "sim/sensors/normal_table.hpp"

namespace mh {
namespace {

// Coefficients of Nguyen, Izadi and Lovell 2012, section 3: m, 1/m, and px.
constexpr double kAxialFloor = 0.0012, kAxialSquare = 0.0019, kAxialNearest = 0.4;
constexpr double kAxialAngular = 0.0001;
constexpr double kLateralFloor = 0.8, kLateralAngular = 0.035;
enum FaultStream : std::uint64_t { kFaultNoise = 1, kFaultHoles = 2 };
constexpr double kSteepRad = std::numbers::pi / 3.0;  // their angular term starts here

/// theta^2 / (pi/2 - theta)^2 where the angular term applies, else 0.
double angular_term(double incidence_rad) {
  const double theta = std::min(incidence_rad, kMaxIncidenceRad);
  if (theta <= kSteepRad) return 0.0;
  const double ratio = theta / (std::numbers::pi / 2.0 - theta);
  return ratio * ratio;
}

/// Tables of what depends only on the incidence, indexed by its cosine.
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
  /// The angular part of axial sigma times the square root of the depth.
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
  float inverse_depth = 0;         // 1/m; 0 = nothing seen
  float slope_x = 0, slope_y = 0;  // 1/m per px
  float cosine = 0;                // cosine of the incidence
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
  std::vector<float> slopes_x(static_cast<std::size_t>(w), 0.0F), slopes_y(slopes_x),
      cosines(slopes_x);
  float *slope_x = slopes_x.data(), *slope_y = slopes_y.data(), *cosine = cosines.data();
  for (int y = 0; y < h; ++y) {
    const float* here = inverse.row(y).data();
    // In the outermost columns and rows the only available difference serves as both.
    const float* above = y > 0 ? here - w : here;
    const float* below = y + 1 < h ? here + w : here;
    if (w > 1) slope_x[0] = here[1] - here[0], slope_x[w - 1] = here[w - 1] - here[w - 2];
    for (int x = 1; x + 1 < w; ++x) slope_x[x] = gentler(here[x - 1], here[x], here[x + 1]);
    if (y == 0 || y + 1 == h)
      for (int x = 0; x < w; ++x) slope_y[x] = below[x] - above[x];
    else
      for (int x = 0; x < w; ++x) slope_y[x] = gentler(above[x], here[x], below[x]);
    // The plane n . X = 1 through X = z d, d = (a, b, 1), so that n . d = 1/z.
    const float b = (static_cast<float>(y) - cy) / fy;
    for (int x = 0; x < w; ++x) {
      const float a = (static_cast<float>(x) - cx) / fx;
      const float nx = slope_x[x] * fx, ny = slope_y[x] * fy, nz = here[x] - nx * a - ny * b;
      const float squares = (nx * nx + ny * ny + nz * nz) * (a * a + b * b + 1.0F);
      cosine[x] = here[x] / std::sqrt(squares + 1e-30F);
    }
    Surface* out = surfaces.row(y).data();
    for (int x = 0; x < w; ++x) out[x] = {here[x], slope_x[x], slope_y[x], cosine[x]};
  }
  return surfaces;
}

/// What is known about the pixels of a row: arrays, so that passes without table lookups are
/// vectorized.
struct Row {
  explicit Row(std::size_t width)
      : normal_x(width),
        normal_y(width),
        normal_z(width),
        seen(width),
        away_x(width),
        away_y(width),
        inverse_depth(width),
        slope_x(width),
        slope_y(width),
        cosine(width),
        by_incidence(width),
        disparity_px(width),
        column(width) {}
  std::vector<float> normal_x, normal_y, normal_z;  ///< random, for lateral and axial noise
  std::vector<int> seen;              ///< index of the pixel whose surface each pixel sees
  std::vector<float> away_x, away_y;  ///< offset from that pixel to this one, px
  std::vector<float> inverse_depth, slope_x, slope_y, cosine;  ///< of that surface
  std::vector<float> by_incidence;  ///< looked up: first the lateral sigma, then the angular part
  std::vector<float> disparity_px;  ///< between camera and projector
  std::vector<int> column;          ///< column in the projector's image
};

/// Processes an image row by row, with several passes over each row.
class DepthSensor {
 public:
  /// @param along, across  factors on the noise along the ray and perpendicular to it
  DepthSensor(const Grid2d<float>& depth_m, const Camera& camera, const DepthNoiseConfig& config,
              RandomStream stream, double along = 1, double across = 1)
      : depth_m_(depth_m),
        surfaces_(find_surfaces(depth_m, camera)),
        config_(config),
        stream_(stream),
        along_(static_cast<float>(along)),
        across_(static_cast<float>(across)),
        width_(depth_m.width()),
        steps_per_inverse_depth_(
            static_cast<float>(kDisparityStepsPerPx * camera.fx_px * camera.baseline_m)),
        row_(static_cast<std::size_t>(width_)) {}

  void read_row(int y, std::span<float> depth) {
    draw(y);
    if (config_.lateral)
      stray(y);
    else
      std::iota(row_.seen.begin(), row_.seen.end(), y * width_);
    fetch_surfaces();
    if (config_.lateral)
      follow_planes(depth);
    else
      std::copy_n(depth_m_.row(y).begin(), width_, depth.begin());
    if (config_.grazing_holes) punch_holes(depth);
    if (config_.projector_shadow) cast_shadow(y, depth);
    if (config_.axial) add_axial_noise(depth);
    if (config_.quantization) quantize(depth);
    const auto nearest = static_cast<float>(config_.min_range_m);
    const auto farthest = static_cast<float>(config_.max_range_m);
    for (float& z : depth) z = z >= nearest && z <= farthest ? z : 0.0F;
  }

 private:
  void draw(int y) {
    const auto first = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width_);
    for (int x = 0; x < width_; ++x) {
      const std::uint64_t bits = stream_.bits(first + static_cast<std::uint64_t>(x));
      row_.normal_x[x] = across_ * normals_[bits & kNormalMask];
      row_.normal_y[x] = across_ * normals_[(bits >> kNormalBits) & kNormalMask];
      row_.normal_z[x] = along_ * normals_[(bits >> (2 * kNormalBits)) & kNormalMask];
    }
  }

  /// Lateral noise: which pixel's surface each pixel sees.
  void stray(int y) {
    const int w = width_, h = depth_m_.height();
    const Surface* own = surfaces_.row(y).data();
    float* sigma = row_.by_incidence.data();
    for (int x = 0; x < w; ++x) sigma[x] = incidence_.lateral_px(own[x].cosine);
    const float *nx = row_.normal_x.data(), *ny = row_.normal_y.data();
    float *away_x = row_.away_x.data(), *away_y = row_.away_y.data();
    int* seen = row_.seen.data();
    for (int x = 0; x < w; ++x) {
      const int sx = std::clamp(x + round(sigma[x] * nx[x]), 0, w - 1);
      const int sy = std::clamp(y + round(sigma[x] * ny[x]), 0, h - 1);
      seen[x] = sy * w + sx;
      away_x[x] = static_cast<float>(x - sx);
      away_y[x] = static_cast<float>(y - sy);
    }
  }

  /// Rounds to the nearest integer, halves to even.
  static int round(float value) { return static_cast<int>(std::rint(value)); }

  void fetch_surfaces() {
    const Surface* surfaces = surfaces_.data();
    for (int x = 0; x < width_; ++x) {
      const Surface& s = surfaces[row_.seen[x]];
      row_.inverse_depth[x] = s.inverse_depth;
      row_.slope_x[x] = s.slope_x;
      row_.slope_y[x] = s.slope_y;
      row_.cosine[x] = s.cosine;
    }
  }

  /// Depth at each pixel, on the plane of the surface that it sees, which was measured some pixels
  /// away. Following these planes limits the lateral noise to edges; without it, lateral noise
  /// would duplicate the axial noise on slopes.
  void follow_planes(std::span<float> depth) const {
    const float *inverse = row_.inverse_depth.data(), *slope_x = row_.slope_x.data(),
                *slope_y = row_.slope_y.data(), *dx = row_.away_x.data(), *dy = row_.away_y.data();
    float* z = depth.data();
    for (int x = 0; x < width_; ++x) {
      const float w = inverse[x];
      const float moved = w + slope_x[x] * dx[x] + slope_y[x] * dy[x];
      // Limited, since the slopes on a thin object are not those of a plane.
      const float limited = std::min(std::max(moved, 0.8F * w), 1.25F * w);
      const float there = 1.0F / limited;
      z[x] = w > 0.0F ? there : 0.0F;
    }
  }

  void punch_holes(std::span<float> depth) const {
    const auto least = static_cast<float>(std::cos(kMaxIncidenceRad));
    for (std::size_t x = 0; x < depth.size(); ++x)
      depth[x] = row_.cosine[x] < least ? 0.0F : depth[x];
  }

  /// Removes the pixels of a row that are in shadow: a pixel with disparity d is at column x - d of
  /// the projector's image, and where several fall on one column, only the nearest is lit.
  void cast_shadow(int y, std::span<float> depth) {
    constexpr float kStep = 1.0F;  // px of disparity; a smooth surface does not shade itself
    const float focal_base = steps_per_inverse_depth_ / static_cast<float>(kDisparityStepsPerPx);
    const int w = width_;
    const Surface* row = surfaces_.row(y).data();
    float* disparity = row_.disparity_px.data();
    int* column = row_.column.data();
    for (int x = 0; x < w; ++x) disparity[x] = focal_base * row[x].inverse_depth;
    const auto find_columns = [&](float shift) {
      for (int x = 0; x < w; ++x)
        column[x] = static_cast<int>(std::floor(static_cast<float>(x) - disparity[x] + shift));
    };
    // Columns left of the image matter too: the projector's image begins at -w. Where nothing
    // returns, the disparity is 0 and covers nothing.
    nearest_.assign(2 * static_cast<std::size_t>(w) + 1, 0.0F);
    float* nearest = nearest_.data() + w;
    find_columns(0.0F);
    for (int x = 0; x < w; ++x) {
      const int u = column[x];
      if (u < -w) continue;
      nearest[u] = std::max(nearest[u], disparity[x]);
      nearest[u + 1] = std::max(nearest[u + 1], disparity[x]);
    }
    find_columns(0.5F);
    for (int x = 0; x < w; ++x) {
      const int u = column[x];
      const bool shaded = u >= -w && nearest[std::max(u, -w)] > disparity[x] + kStep;
      depth[static_cast<std::size_t>(x)] = shaded ? 0.0F : depth[static_cast<std::size_t>(x)];
    }
  }

  void add_axial_noise(std::span<float> depth) {
    float* angular = row_.by_incidence.data();
    for (int x = 0; x < width_; ++x) angular[x] = incidence_.angular(row_.cosine[x]);
    const float* normal = row_.normal_z.data();
    for (std::size_t x = 0; x < depth.size(); ++x) {
      const float away = depth[x] - static_cast<float>(kAxialNearest);
      const float sigma = static_cast<float>(kAxialFloor) +
                          static_cast<float>(kAxialSquare) * away * away +
                          angular[x] / std::sqrt(std::max(depth[x], 1e-3F));
      const float noisy = depth[x] + sigma * normal[x];
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
  float along_, across_;
  int width_;
  float steps_per_inverse_depth_;
  Row row_;
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

Grid2d<float> faulty_depth(const Grid2d<float>& depth_m, const Camera& camera,
                           const DepthFaultsConfig& config, RandomStream stream) {
  Grid2d<float> read = depth_m;
  if (config.noise > 0 || config.edges > 0) {
    DepthNoiseConfig kinds = no_depth_noise();
    kinds.axial = config.noise > 0;
    kinds.lateral = config.edges > 0;
    DepthSensor sensor(depth_m, camera, kinds, stream.fork(kFaultNoise), config.noise,
                       config.edges);
    for (int y = 0; y < read.height(); ++y) sensor.read_row(y, read.row(y));
  }
  if (config.holes <= 0) return read;
  const RandomStream holes = stream.fork(kFaultHoles);
  constexpr int kPatch = 16;
  const int across = (read.width() + kPatch - 1) / kPatch;
  for (int y = 0; y < read.height(); ++y)
    for (int x = 0; x < read.width(); ++x) {
      const auto patch = static_cast<std::uint64_t>(y / kPatch * across + x / kPatch);
      if (holes.uniform(patch) < config.holes) read(x, y) = 0;
    }
  return read;
}

}  // namespace mh
