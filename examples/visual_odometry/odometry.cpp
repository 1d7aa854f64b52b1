// SPDX-License-Identifier: Apache-2.0
#include "odometry.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/quaternion.hpp>
#include <opencv2/imgproc.hpp>

namespace example {
namespace {

constexpr int kMinFirst = 80;        // points with depth for a frame to become the origin
constexpr int kMinTracked = 20;      // inliers to accept a pose tracked from a keyframe
constexpr int kMinRelocalized = 30;  // inliers to accept a pose found by relocalization
constexpr int kCandidates = 5;       // keyframes tried in relocalization
constexpr int kVoters = 200;         // descriptors used to choose them
constexpr float kRatio = 0.75F;
constexpr double kReprojection_px = 2.5;
// A new keyframe after this much motion, or with fewer inliers.
constexpr double kKeyframeDistance_m = 0.15, kKeyframeAngle_rad = 0.2;
constexpr int kKeyframeInliers = 80;

/// The best match (query row, train row) of each query row that passes the ratio test.
std::vector<cv::DMatch> match(const cv::Mat& query, const cv::Mat& train) {
  std::vector<cv::DMatch> good;
  if (query.rows < 2 || train.rows < 2) return good;
  std::vector<std::vector<cv::DMatch>> best;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(query, train, best, 2);
  for (const auto& pair : best)
    if (pair.size() == 2 && pair[0].distance < kRatio * pair[1].distance) good.push_back(pair[0]);
  return good;
}

}  // namespace

Camera read_settings(const std::string& file) {
  const cv::FileStorage settings(file, cv::FileStorage::READ);
  if (!settings.isOpened()) CV_Error(cv::Error::StsError, file + ": cannot be read");
  const auto number = [&](const char* key) { return static_cast<double>(settings[key].real()); };
  Camera camera;
  camera.matrix = {number("Camera.fx"),
                   0,
                   number("Camera.cx"),
                   0,
                   number("Camera.fy"),
                   number("Camera.cy"),
                   0,
                   0,
                   1};
  for (const char* key : {"Camera.k1", "Camera.k2", "Camera.p1", "Camera.p2", "Camera.k3",
                          "Camera.k4", "Camera.k5", "Camera.k6"})
    camera.distortion.push_back(settings[key].empty() ? 0.0 : number(key));
  camera.depth_per_meter = number("DepthMapFactor");
  return camera;
}

cv::Affine3d pose_of(const std::array<double, 7>& v) {
  return {cv::Quatd(v[6], v[3], v[4], v[5]).toRotMat3x3(), cv::Vec3d(v[0], v[1], v[2])};
}

std::array<double, 7> pose_values(const cv::Affine3d& pose) {
  const cv::Vec3d t = pose.translation();
  const cv::Quatd q = cv::Quatd::createFromRotMat(pose.rotation());
  return {t[0], t[1], t[2], q.x, q.y, q.z, q.w};
}

std::string pose_numbers(const cv::Affine3d& pose, char separator) {
  std::string text;
  for (const double value : pose_values(pose)) {
    char number[32];
    std::snprintf(number, sizeof number, "%.17g", value);
    if (!text.empty()) text += separator;
    text += number;
  }
  return text;
}

VisualOdometry::VisualOdometry(Camera camera)
    : camera_(std::move(camera)), orb_(cv::ORB::create(800)) {
  cv::setNumThreads(1);
}

void VisualOdometry::forget_map() {
  keyframes_.clear();
  world_from_odom_.reset();
  lose();
}

View VisualOdometry::look(const cv::Mat& bgr, const cv::Mat& depth) const {
  cv::Mat gray, all;
  cv::cvtColor(bgr, gray, cv::COLOR_BGR2GRAY);
  std::vector<cv::KeyPoint> keypoints;
  orb_->detectAndCompute(gray, cv::noArray(), keypoints, all);
  View view;
  if (keypoints.empty()) return view;
  std::vector<cv::Point2f> pixels, rays;
  cv::KeyPoint::convert(keypoints, pixels);
  cv::undistortPoints(pixels, rays, camera_.matrix, camera_.distortion);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto units = depth.at<std::uint16_t>(cvRound(pixels[i].y), cvRound(pixels[i].x));
    if (units == 0) continue;
    const auto z = static_cast<float>(units / camera_.depth_per_meter);
    view.pixels.push_back(pixels[i]);
    view.points_in_camera.emplace_back(rays[i].x * z, rays[i].y * z, z);
    view.descriptors.push_back(all.row(static_cast<int>(i)));
  }
  return view;
}

Found VisualOdometry::place(const View& view, const Keyframe& keyframe, int needed) const {
  Found found;
  std::vector<cv::Point3f> points;
  std::vector<cv::Point2f> pixels;
  for (const cv::DMatch& m : match(view.descriptors, keyframe.view.descriptors)) {
    points.push_back(keyframe.view.points_in_camera[static_cast<std::size_t>(m.trainIdx)]);
    pixels.push_back(view.pixels[static_cast<std::size_t>(m.queryIdx)]);
  }
  if (static_cast<int>(points.size()) < needed) return found;
  cv::Vec3d turn, shift;
  std::vector<int> inliers;
  if (!cv::solvePnPRansac(points, pixels, camera_.matrix, camera_.distortion, turn, shift, false,
                          300, static_cast<float>(kReprojection_px), 0.999, inliers,
                          cv::SOLVEPNP_AP3P) ||
      static_cast<int>(inliers.size()) < needed)
    return found;
  std::vector<cv::Point3f> inlier_points;
  std::vector<cv::Point2f> inlier_pixels;
  for (const int i : inliers) {
    inlier_points.push_back(points[static_cast<std::size_t>(i)]);
    inlier_pixels.push_back(pixels[static_cast<std::size_t>(i)]);
  }
  cv::solvePnPRefineLM(inlier_points, inlier_pixels, camera_.matrix, camera_.distortion, turn,
                       shift);
  const cv::Affine3d camera_from_keyframe(turn, shift);
  found.world_from_camera = keyframe.world_from_camera * camera_from_keyframe.inv();
  found.inliers = static_cast<int>(inliers.size());
  return found;
}

Found VisualOdometry::find(const View& view) const {
  Found best;
  best.keyframes = static_cast<int>(keyframes_.size());
  if (view.descriptors.rows < kMinRelocalized) return best;
  const cv::Mat voters = view.descriptors.rowRange(0, std::min(kVoters, view.descriptors.rows));
  std::vector<std::pair<int, std::size_t>> votes;  // (negative number of matches, keyframe)
  for (std::size_t k = 0; k < keyframes_.size(); ++k)
    votes.emplace_back(-static_cast<int>(match(voters, keyframes_[k].view.descriptors).size()), k);
  std::sort(votes.begin(), votes.end());
  votes.resize(std::min<std::size_t>(votes.size(), kCandidates));
  for (const auto& [matches, k] : votes) {
    const Found found = place(view, keyframes_[k], kMinRelocalized);
    ++best.candidates;
    if (found.inliers <= best.inliers) continue;
    best.world_from_camera = found.world_from_camera;
    best.inliers = found.inliers;
  }
  return best;
}

void VisualOdometry::add_keyframe(View view, const cv::Affine3d& world_from_camera) {
  reference_ = keyframes_.size();
  keyframes_.push_back({std::move(view), world_from_camera});
}

Found VisualOdometry::track(const cv::Mat& bgr, const cv::Mat& depth,
                            const std::optional<cv::Affine3d>& wheels) {
  View view = look(bgr, depth);
  Found found;
  if (keyframes_.empty()) {
    if (view.descriptors.rows < kMinFirst) return found;
    found.world_from_camera = cv::Affine3d::Identity();
    found.keyframe_added = true;
    add_keyframe(std::move(view), *found.world_from_camera);
    if (wheels) world_from_odom_ = *found.world_from_camera * wheels->inv();
    return found;
  }
  if (reference_) found = place(view, keyframes_[*reference_], kMinTracked);
  if (!found.world_from_camera) found = find(view);
  if (!found.world_from_camera) {
    lose();
    if (wheels && world_from_odom_) found.world_from_camera = *world_from_odom_ * *wheels;
    return found;
  }
  if (wheels) world_from_odom_ = *found.world_from_camera * wheels->inv();
  const auto moved = [&](const Keyframe& keyframe) {
    const cv::Affine3d motion = keyframe.world_from_camera.inv() * *found.world_from_camera;
    return cv::norm(motion.translation()) > kKeyframeDistance_m ||
           cv::norm(motion.rvec()) > kKeyframeAngle_rad;
  };
  // If the pose came from relocalization, a keyframe other than the reference may be near.
  const bool new_ground = std::all_of(keyframes_.begin(), keyframes_.end(), moved);
  if (new_ground || found.inliers < kKeyframeInliers) {
    found.keyframe_added = true;
    add_keyframe(std::move(view), *found.world_from_camera);
  } else if (!reference_ || moved(keyframes_[*reference_])) {
    const auto near = std::find_if_not(keyframes_.rbegin(), keyframes_.rend(), moved);
    reference_ = static_cast<std::size_t>(keyframes_.rend() - near) - 1;
  }
  return found;
}

Found VisualOdometry::relocalize(const cv::Mat& bgr, const cv::Mat& depth) const {
  return find(look(bgr, depth));
}

}  // namespace example
