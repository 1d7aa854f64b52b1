// SPDX-License-Identifier: Apache-2.0
#include "slam/features/undistort.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include "slam/io/error.hpp"

namespace mh {
namespace {

cv::Matx33d matrix_of(const Camera& c) {
  return {c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1};
}

}  // namespace

void undistort(const Camera& camera, std::vector<Eigen::Vector2d>& points_px) {
  const cv::Mat points(static_cast<int>(points_px.size()), 1, CV_64FC2, points_px.data());
  const cv::Matx33d matrix = matrix_of(camera);
  // Stops at 1/1000 px, far below the accuracy of a corner.
  const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-3);
  cv::undistortPoints(points, points, matrix, coefficients_of(camera.distortion), cv::noArray(),
                      matrix, stop);
}

void require_undistortable(const Camera& camera) {
  if (camera.distortion.none()) return;
  constexpr int kSteps = 32;
  constexpr double kAstray_px = 0.1;
  std::vector<Eigen::Vector2d> pixels;
  for (int row = 0; row <= kSteps; ++row)
    for (int column = 0; column <= kSteps; ++column)
      pixels.emplace_back((camera.width_px - 1.0) * column / kSteps,
                          (camera.height_px - 1.0) * row / kSteps);
  std::vector<Eigen::Vector2d> undistorted = pixels;
  undistort(camera, undistorted);
  std::vector<cv::Point3d> rays;
  for (const Eigen::Vector2d& p : undistorted)
    rays.emplace_back((p.x() - camera.cx_px) / camera.fx_px, (p.y() - camera.cy_px) / camera.fy_px,
                      1);
  std::vector<cv::Point2d> back;
  cv::projectPoints(rays, cv::Vec3d(), cv::Vec3d(), matrix_of(camera),
                    coefficients_of(camera.distortion), back);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (!(std::hypot(back[i].x - pixels[i].x(), back[i].y - pixels[i].y()) <
          kAstray_px))  // NaN: diverged as well
      throw InputError(
          fmt::format("{}: the distortion cannot be inverted at pixel ({:.0f}, {:.0f})",
                      text_of(camera.distortion), pixels[i].x(), pixels[i].y()));
}

}  // namespace mh
