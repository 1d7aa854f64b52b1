// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/affine.hpp>
#include <opencv2/features2d.hpp>

/// A small RGB-D visual odometry: each frame is matched to a keyframe (ORB, ratio test) and
/// localized by PnP or, where that fails, from wheel odometry, if available. No bundle adjustment,
/// no loop closing: an example of a user's own system, not a competitor.
namespace example {

struct Camera {
  cv::Matx33d matrix = cv::Matx33d::eye();
  std::vector<double> distortion;  ///< k1 k2 p1 p2 k3 k4 k5 k6
  double depth_per_meter = 5000;
};

/// Reads Camera.fx, ... from a settings file. @throws cv::Exception if it cannot be read.
Camera read_settings(const std::string& file);

/// The pose given as x, y, z, qx, qy, qz, qw.
cv::Affine3d pose_of(const std::array<double, 7>& values);
/// The pose as x, y, z, qx, qy, qz, qw.
std::array<double, 7> pose_values(const cv::Affine3d& pose);
/// The pose as text, with all digits that a double has.
std::string pose_numbers(const cv::Affine3d& pose, char separator);

/// The features of an image: keypoints with depth, as points in its camera's frame.
struct View {
  std::vector<cv::Point2f> pixels;
  std::vector<cv::Point3f> points_in_camera;
  cv::Mat descriptors;
};

struct Keyframe {
  View view;
  cv::Affine3d world_from_camera;
};

struct Found {
  std::optional<cv::Affine3d> world_from_camera;
  int inliers = 0;
  int keyframes = 0;   ///< number of keyframes in the map
  int candidates = 0;  ///< number of keyframes that a pose was estimated against
  bool keyframe_added = false;
};

class VisualOdometry {
 public:
  explicit VisualOdometry(Camera camera);

  /// Localizes the next frame and extends the map. The first frame is the origin.
  /// @param wheels  the camera's pose in the frame of wheel odometry, if known
  Found track(const cv::Mat& bgr, const cv::Mat& depth,
              const std::optional<cv::Affine3d>& wheels = {});
  /// Localizes a frame in the map without a prior pose. Changes nothing, so that the answer depends
  /// only on the map and the frame.
  Found relocalize(const cv::Mat& bgr, const cv::Mat& depth) const;
  /// Treats tracking as lost; keeps the map.
  void lose() { reference_.reset(); }
  void forget_map();

 private:
  View look(const cv::Mat& bgr, const cv::Mat& depth) const;
  Found place(const View& view, const Keyframe& keyframe, int needed) const;
  Found find(const View& view) const;
  void add_keyframe(View view, const cv::Affine3d& world_from_camera);

  Camera camera_;
  cv::Ptr<cv::ORB> orb_;
  std::vector<Keyframe> keyframes_;
  std::optional<std::size_t> reference_;         ///< the keyframe being tracked against; none: lost
  std::optional<cv::Affine3d> world_from_odom_;  ///< from the last frame localized by its image
};

}  // namespace example
