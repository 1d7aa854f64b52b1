// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/occupancy_mapper.hpp"

#include <cmath>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {
namespace {

/// The camera without distortion whose pixel (x, y) is pixel (stride x, stride y) of the given one.
Camera thin(Camera camera, int stride) {
  camera.width_px = (camera.width_px + stride - 1) / stride;
  camera.height_px = (camera.height_px + stride - 1) / stride;
  for (double* value : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px})
    *value /= stride;
  camera.distortion = {};
  return camera;
}

constexpr std::size_t kNoPixel = SIZE_MAX;

/// For each thinned, undistorted pixel, the pixel of a frame that shows the same point; kNoPixel if
/// that is outside the frame.
std::vector<std::size_t> pixels_behind(const Camera& camera, const Camera& thin) {
  std::vector<std::size_t> pixels;
  for (int v = 0; v < thin.height_px; ++v)
    for (int u = 0; u < thin.width_px; ++u) {
      const double x = (u - thin.cx_px) / thin.fx_px, y = (v - thin.cy_px) / thin.fy_px;
      const Eigen::Vector2d seen = camera.distortion.distorted(x, y);
      const long at_x = std::lround(camera.fx_px * seen.x() + camera.cx_px),
                 at_y = std::lround(camera.fy_px * seen.y() + camera.cy_px);
      const bool inside =
          at_x >= 0 && at_y >= 0 && at_x < camera.width_px && at_y < camera.height_px;
      pixels.push_back(inside ? static_cast<std::size_t>(at_y * camera.width_px + at_x) : kNoPixel);
    }
  return pixels;
}

Grid2d<float> thin_depth(const Grid2d<float>& depth_m, const Camera& thin,
                         const std::vector<std::size_t>& pixels) {
  Grid2d<float> small(thin.width_px, thin.height_px);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (pixels[i] != kNoPixel) small.data()[i] = depth_m.data()[pixels[i]];
  return small;
}

/// Empty if the frame has no labels.
PixelLabels thin_labels(const SemanticImage& semantics, const Camera& thin,
                        const std::vector<std::size_t>& pixels) {
  if (semantics.index.empty()) return {};
  std::vector<ClassId> of_palette;
  for (const ClassDistribution& entry : semantics.palette) {
    const ClassId best = entry.most_probable();
    of_palette.push_back(best == kBackground ? kVoid : best);
  }
  PixelLabels small{{thin.width_px, thin.height_px}, {thin.width_px, thin.height_px}};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (pixels[i] == kNoPixel) continue;
    const std::uint8_t entry = semantics.index.data()[pixels[i]];
    small.classes.data()[i] = of_palette[entry];
    small.detections.data()[i] = entry;
  }
  return small;
}

void require_within(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw InputError(
        fmt::format("occupancy: {} = {}, not within {} to {}", name, value, low, high));
}

const OccupancyConfig& checked(const OccupancyConfig& config) {
  const DepthModel& d = config.depth;
  require_within("resolution_m", d.resolution_m, 0.005, 1.0);
  require_within("max_range_m", d.max_range_m, d.resolution_m, 250 * d.resolution_m);
  require_within("min_range_m", d.min_range_m, 0.0, d.max_range_m);
  require_within("around_voxels", d.around_voxels, 0.0, 4.0);
  require_within("before_voxels", d.before_voxels, 0.0, 4.0);
  require_within("stride_px", config.stride_px, 1, 64);
  require_within("pose_step_m", config.pose_step_m, 1e-9, 1.0);
  require_within("pose_step_rad", config.pose_step_rad, 1e-9, 1.0);
  return config;
}

bool equal_bits(const SE3& a, const SE3& b) {
  return a.rotation() == b.rotation() && a.translation() == b.translation();
}

}  // namespace

OccupancyMapper::OccupancyMapper(const Camera& camera, const OccupancyConfig& config)
    : config_(checked(config)),
      width_px_(camera.width_px),
      height_px_(camera.height_px),
      camera_(thin(camera, config.stride_px)),
      pixel_(pixels_behind(camera, camera_)),
      map_(config.depth.resolution_m) {}

void OccupancyMapper::keep(const RgbdFrame& frame) {
  if (frame.depth_m.width() != width_px_ || frame.depth_m.height() != height_px_)
    throw InputError(fmt::format("occupancy: a depth image of {} x {} px, not {} x {}",
                                 frame.depth_m.width(), frame.depth_m.height(), width_px_,
                                 height_px_));
  Kept& kept = kept_[frame.stamp_ns];
  if (kept.pose) map_.replace(&kept.told, nullptr);
  kept = {smoothed_depth(thin_depth(frame.depth_m, camera_, pixel_)),
          thin_labels(frame.semantics, camera_, pixel_),
          std::nullopt,
          {}};
}

SE3 OccupancyMapper::rounded(const SE3& map_from_camera) const {
  const auto round_to = [](Eigen::Vector3d v, double step) {
    return ((v / step).array().round() * step).matrix().eval();
  };
  // Rotation vectors jump where the angle is pi. A rotation near pi may be rounded to either side
  // of the jump, but in both cases it changes by less than a step.
  return {so3_exp(round_to(so3_log(map_from_camera.rotation()), config_.pose_step_rad)),
          round_to(map_from_camera.translation(), config_.pose_step_m)};
}

OccupancyUpdate OccupancyMapper::update(const Trajectory& world_from_camera,
                                        const SE3& map_from_world) {
  OccupancyUpdate update;
  map_.set_detected({});
  auto pose = world_from_camera.begin();
  for (auto& [stamp_ns, kept] : kept_) {
    while (pose != world_from_camera.end() && pose->stamp_ns < stamp_ns) ++pose;
    if (pose == world_from_camera.end() || pose->stamp_ns != stamp_ns) {
      if (!kept.pose) continue;
      map_.replace(&kept.told, nullptr);
      kept.pose.reset();
      kept.told.clear();
      ++update.removed;
      continue;
    }
    const SE3 at = rounded(map_from_world * pose->world_from_camera);
    if (kept.pose && equal_bits(*kept.pose, at)) {
      ++update.kept;
      continue;
    }
    VoxelView told = look(kept.depth_m, kept.labels, camera_, at, config_.depth);
    map_.replace(kept.pose ? &kept.told : nullptr, &told);
    ++(kept.pose ? update.moved : update.added);
    kept.pose = at;
    kept.told = std::move(told);
  }
  return update;
}

void OccupancyMapper::associate_detections() {
  DetectionAssociation association;
  for (const auto& [stamp_ns, kept] : kept_) association.add(kept.told);
  map_.set_detected(association.objects(map_));
}

const Grid2d<float>* OccupancyMapper::depth_of(Stamp stamp_ns) const {
  const auto kept = kept_.find(stamp_ns);
  return kept == kept_.end() ? nullptr : &kept->second.depth_m;
}

const PixelLabels* OccupancyMapper::labels_of(Stamp stamp_ns) const {
  const auto kept = kept_.find(stamp_ns);
  return kept == kept_.end() ? nullptr : &kept->second.labels;
}

std::vector<Stamp> OccupancyMapper::stamps() const {
  std::vector<Stamp> stamps;
  for (const auto& [stamp_ns, kept] : kept_) stamps.push_back(stamp_ns);
  return stamps;
}

}  // namespace mh
