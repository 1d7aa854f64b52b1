// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// One row of a contact sheet.
struct View {
  std::string caption;
  Grid2d<Rgb8> color;
  Grid2d<float> depth_m;
  Grid2d<ClassId> classes;
};

/// Draws rows of color, depth in false color and labels in class colors, with a depth scale and the
/// names of the classes seen.
cv::Mat draw_contact_sheet(const std::string& title, const std::vector<View>& views);

/// Draws the color images of many views, `columns` per row, with or without their captions.
cv::Mat draw_gallery(const std::vector<View>& views, int columns, bool captions);

/// Renders exact images from a few poses spread evenly over a path.
std::vector<View> views_along(const Trajectory& path, const Renderer& renderer,
                              const Camera& camera, std::size_t count);

/// Renders exact images that show a scene to a person: each room from the two corners that show
/// most of its contents at eye height. A scene without a plan is shown from the most revealing
/// viewpoints (viewpoints()).
std::vector<View> views_of(const Scene& scene, const Renderer& renderer);

/// Returns the pose of an upright camera at `eye` that looks at `target`.
SE3 look_at(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m);

}  // namespace mh
