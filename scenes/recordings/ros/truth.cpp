// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "scenes/recordings/ros/names.hpp"
#include "scenes/recordings/ros/topics.hpp"
#include "slam/core/interpolate.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// Sorts poses by stamp and keeps only the first pose with each stamp.
Trajectory ordered(std::vector<TimedPose> poses) {
  std::ranges::stable_sort(poses, {}, &TimedPose::stamp_ns);
  const auto is_same = [](const TimedPose& a, const TimedPose& b) {
    return a.stamp_ns == b.stamp_ns;
  };
  poses.erase(std::unique(poses.begin(), poses.end(), is_same), poses.end());
  return poses;
}

/// A frame and the edge of tf above it.
using Link = std::pair<std::string, const TfEdge*>;

/// The edges from a frame up to `top`, or as far as tf goes if `top` is empty.
std::vector<Link> way_up(const RosTopics& topics, std::string frame, const std::string& top = "") {
  std::vector<Link> way;
  std::set<std::string> seen;  // stops at a cycle
  for (auto edge = topics.tf.find(frame);
       frame != top && edge != topics.tf.end() && seen.insert(frame).second;
       edge = topics.tf.find(frame)) {
    way.emplace_back(frame, &edge->second);
    frame = edge->second.parent;
  }
  return way;
}

/// body_from_optical; nullopt if the edges do not lead from the optical frame to `body`, or if one
/// of them moves.
std::optional<SE3> fixed_from(const RosTopics& topics, const std::string& body,
                              const std::string& optical) {
  if (body.empty() || body == optical) return SE3();
  SE3 parent_from_optical;
  for (const auto& [frame, edge] : way_up(topics, optical, body)) {
    if (!edge->is_static && edge->poses.size() > 1) return std::nullopt;
    parent_from_optical = edge->poses.front().world_from_camera * parent_from_optical;
    if (edge->parent == body) return parent_from_optical;
  }
  return std::nullopt;
}

bool is_fixed(const TfEdge& edge) {
  return edge.is_static || edge.poses.size() == 1;
}

/// The trajectory of the optical frame in "world" or "map", from tf.
std::optional<Trajectory> by_tf(const RosTopics& topics, const ImageTopic& color) {
  std::vector<Link> way;
  for (const char* top : {"world", ros::kMapFrame}) {
    way = way_up(topics, color.frame, top);
    if (!way.empty() && way.back().second->parent == top) break;
    way.clear();
  }
  const auto moving =
      std::ranges::count_if(way, [](const Link& l) { return !is_fixed(*l.second); });
  if (moving == 0) return std::nullopt;
  // Poses by edge, sorted. If only one edge moves, the stamps of its poses are used, because then
  // no interpolation is needed.
  std::vector<Trajectory> edges;
  std::vector<Stamp> stamps;
  for (const StoredImage& image : color.images) stamps.push_back(image.stamp_ns);
  for (const auto& [frame, edge] : way) {
    edges.push_back(ordered(edge->poses));
    if (is_fixed(*edge) || moving > 1) continue;
    stamps.clear();
    for (const TimedPose& pose : edges.back()) stamps.push_back(pose.stamp_ns);
  }
  std::vector<TimedPose> truth;
  for (const Stamp stamp_ns : stamps) {
    std::optional<SE3> top_from_optical = SE3();
    for (std::size_t i = 0; i < edges.size() && top_from_optical; ++i) {
      const auto pose = is_fixed(*way[i].second)
                            ? edges[i].front().world_from_camera
                            : interpolated_pose(edges[i], stamp_ns, kMaxTruthGap_ns);
      top_from_optical = pose ? std::optional(*pose * *top_from_optical) : std::nullopt;
    }
    if (top_from_optical) truth.push_back({stamp_ns, top_from_optical->normalized()});
  }
  if (truth.empty()) return std::nullopt;
  return ordered(std::move(truth));
}

bool calls_itself_truth(const std::string& topic) {
  for (const char* mark : {"ground_truth", "groundtruth", "ground-truth"})
    if (topic.find(mark) != std::string::npos) return true;
  return false;
}

std::optional<Trajectory> by_topic(const RosTopics& topics, const PoseTopic& topic,
                                   const ImageTopic& color) {
  const auto body_from_optical = fixed_from(topics, topic.child, color.frame);
  if (!body_from_optical) return std::nullopt;
  std::vector<TimedPose> truth = topic.poses;
  if (!topic.child.empty() && topic.child != color.frame)
    for (TimedPose& pose : truth)
      pose.world_from_camera = pose.world_from_camera * *body_from_optical;
  return ordered(std::move(truth));
}

std::optional<Trajectory> find_truth(const RosTopics& topics, const TopicNames& names,
                                     const ImageTopic& color, std::vector<std::string>& notes,
                                     const std::string& file) {
  if (names.truth == "/tf") {
    auto truth = by_tf(topics, color);
    if (!truth)
      throw InputError(fmt::format(
          "{}: tf leads from neither 'world' nor 'map' to the camera's '{}'", file, color.frame));
    return truth;
  }
  if (!names.truth.empty()) {
    const auto named = topics.poses.find(names.truth);
    if (named == topics.poses.end())
      throw InputError(
          fmt::format("{}: topic '{}' holds no poses (PoseStamped, TransformStamped, "
                      "Odometry)",
                      file, names.truth));
    const auto truth = by_topic(topics, named->second, color);
    if (!truth)
      throw InputError(
          fmt::format("{}: topic '{}' is of '{}', from which no fixed transforms lead "
                      "to the camera's '{}'",
                      file, names.truth, named->second.child, color.frame));
    return truth;
  }
  if (const auto ours = topics.poses.find(ros::kCameraTruthTopic); ours != topics.poses.end())
    return by_topic(topics, ours->second, color);
  for (const auto& [name, topic] : topics.poses) {
    if (!calls_itself_truth(name)) continue;
    if (auto truth = by_topic(topics, topic, color)) {
      notes.push_back(
          fmt::format("{}: truth is taken from topic {}{}", file, name,
                      topic.child.empty() ? ", as poses of the camera's optical frame" : ""));
      return truth;
    }
  }
  auto truth = by_tf(topics, color);
  if (truth)
    notes.push_back(fmt::format("{}: truth is taken from tf, for '{}'", file, color.frame));
  return truth;
}

/// Whether tf always states the same transform for an edge.
bool never_moves(const TfEdge& edge) {
  return std::ranges::all_of(edge.poses, [&](const TimedPose& pose) {
    const SE3 &a = pose.world_from_camera, &b = edge.poses.front().world_from_camera;
    return a.rotation() == b.rotation() && a.translation() == b.translation();
  });
}

/// A frame and those above it, up to the first edge that moves; each with its transform
/// above_from_frame.
std::vector<std::pair<std::string, SE3>> fixed_way_up(const RosTopics& topics,
                                                      const std::string& frame) {
  std::vector<std::pair<std::string, SE3>> above{{frame, SE3()}};
  for (const auto& [child, edge] : way_up(topics, frame)) {
    if (!never_moves(*edge)) break;
    above.emplace_back(edge->parent, edge->poses.front().world_from_camera * above.back().second);
  }
  return above;
}

}  // namespace

std::optional<SE3> fixed_transform(const RosTopics& topics, const std::string& to,
                                   const std::string& from) {
  const auto above_to = fixed_way_up(topics, to);
  for (const auto& [frame, above_from_from] : fixed_way_up(topics, from))
    for (const auto& [other, above_from_to] : above_to)
      if (frame == other) return (above_from_to.inverse() * above_from_from).normalized();
  return std::nullopt;
}

std::optional<Trajectory> true_trajectory(const RosTopics& topics, const TopicNames& names,
                                          const ImageTopic& color, std::vector<std::string>& notes,
                                          const std::string& file) {
  auto truth = find_truth(topics, names, color, notes, file);
  if (!truth) return truth;
  const auto is_far = [](const TimedPose& pose) {
    return pose.world_from_camera.translation().cwiseAbs().maxCoeff() > kFarthestPose_m;
  };
  if (const std::size_t far = std::erase_if(*truth, is_far); far > 0)
    notes.push_back(
        fmt::format("{}: {} more than {:g} m from the origin and {} left out of the truth", file,
                    counted(far, "true pose lies", "true poses lie"), kFarthestPose_m,
                    far == 1 ? "is" : "are"));
  if (truth->empty()) return std::nullopt;
  return truth;
}

}  // namespace mh
