// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "bench/protocol/episodes/episode.hpp"

namespace mh {

/// Collects an episode as it happens, for its log and its image.
class EpisodeRecord {
 public:
  EpisodeRecord(RobotMap map, EpisodeStart start)
      : map_(std::move(map)), start_(std::move(start)) {}

  /// An EpisodeObserver: called at each step of the episode.
  void add(const EpisodeMoment& moment);

  /// A line for each decision, and one line per second in between: time, state, true and believed
  /// pose, and what the SLAM system answered. Places are in the world's frame, except those that
  /// the robot itself reports, which are in its map's frame.
  std::string log(const EpisodeScore& score) const;
  /// The same for an episode that did not finish.
  std::string log_so_far() const;
  /// A strip of frames in order and, below it, the robot's own map. The map shows, in its own
  /// frame, where the robot was put, where it drove, where it believed it was, and the paths that
  /// it planned.
  /// @param title  "semantic, start 3"
  cv::Mat strip(const std::string& title, const EpisodeScore& score) const;

 private:
  struct Shot {
    double time_s = 0;
    std::string caption;
    cv::Mat small;  ///< 8-bit BGR
    Pose2 world_from_base;
  };
  struct Step {
    double time_s = 0;
    Pose2 world_from_base;
    std::optional<Pose2> believed;
  };
  std::vector<const Shot*> chosen_shots() const;

  RobotMap map_;
  EpisodeStart start_;
  Pose2 world_from_map_;
  std::vector<Shot> shots_;
  std::vector<Step> steps_;
  std::vector<std::vector<Eigen::Vector2d>> plans_;  ///< map frame
  std::vector<std::string> lines_;
  double next_line_s_ = 0;
};

}  // namespace mh
