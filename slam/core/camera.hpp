// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace mh {

/// Brown-Conrady ("plumb bob") lens distortion or, with k4 to k6, OpenCV's rational model;
/// coefficients in the order of OpenCV and ROS.
struct Distortion {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
  double k4 = 0, k5 = 0, k6 = 0;
  bool is_rational() const { return k4 != 0 || k5 != 0 || k6 != 0; }
  bool none() const {
    return k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0 && k3 == 0 && !is_rational();
  }
  /// Factor on the radius, as a function of its square: (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4
  /// r^2 + k5 r^4 + k6 r^6).
  double radial(double r2) const {
    return (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  }
  /// Applies the distortion to a point of the plane at unit depth.
  Eigen::Vector2d distorted(double x, double y) const {
    const double r2 = x * x + y * y, factor = radial(r2);
    return {x * factor + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * factor + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  }
  /// The inverse of distorted(), by Newton's method; NaN if the lens maps no point there.
  Eigen::Vector2d undistorted(double x, double y) const;
  friend bool operator==(const Distortion&, const Distortion&) = default;
};
/// "k1 0.1, k2 0, ...", with k4 to k6 only where they are not 0.
/// @param is  text between a name and its value
std::string text_of(const Distortion& distortion, const char* is = " ");
/// @param coefficients  k1 k2 p1 p2 [k3 [k4 k5 k6]], absent ones are 0
Distortion distortion_of(std::vector<double> coefficients);
/// The inverse of distortion_of(): five coefficients, or eight if k4 to k6 are not all 0.
std::vector<double> coefficients_of(const Distortion& distortion);

/// A pinhole RGB-D camera: x right, y down, z forward; pixel centers at integers.
struct Camera {
  int width_px = 640;
  int height_px = 480;
  double fx_px = 525.0, fy_px = 525.0;
  double cx_px = 319.5, cy_px = 239.5;
  Distortion distortion;
  double rate_hz = 30.0;
  /// Baseline b of the depth sensor's triangulation. A depth z has disparity fx * b / z; the error
  /// of this disparity determines how much the depth weighs. 0.075 m: Khoshelham and Elberink,
  /// Sensors 2012.
  double baseline_m = 0.075;
  /// Standard deviation of the disparity at a keypoint of octave 0; at higher octaves, it grows
  /// like the standard deviation of the keypoint's position, since the depth of a misplaced
  /// keypoint is read at the wrong pixel. If no value is given, SLAM begins with this default and
  /// learns the value (slam/optimize/depth_trust.hpp).
  double disparity_sigma_px = 0.3;
  bool disparity_sigma_is_given = false;

  /// Projects a point to its (undistorted) pixel. @pre z is positive.
  Eigen::Vector2d project(const Eigen::Vector3d& point_in_camera) const {
    const double inverse_z = 1.0 / point_in_camera.z();
    return {fx_px * point_in_camera.x() * inverse_z + cx_px,
            fy_px * point_in_camera.y() * inverse_z + cy_px};
  }
  /// Back-projects an undistorted pixel to the point at depth z (m).
  Eigen::Vector3d unproject(double u_px, double v_px, double depth_m) const {
    return {(u_px - cx_px) / fx_px * depth_m, (v_px - cy_px) / fy_px * depth_m, depth_m};
  }
  double disparity_px(double depth_m) const { return fx_px * baseline_m / depth_m; }
  bool in_image(double u_px, double v_px) const {
    return u_px >= 0 && v_px >= 0 && u_px <= width_px - 1 && v_px <= height_px - 1;
  }

  friend bool operator==(const Camera&, const Camera&) = default;
};

/// @throws InputError naming the first field that is out of range: sizes, rate, baseline and
/// disparity_sigma_px must be positive, the focal lengths plausible for the image's size, and the
/// principal point inside the image.
void validate(const Camera& camera);

/// The same camera with its image scaled to a different size.
Camera resized(Camera camera, int width_px, int height_px);

}  // namespace mh
