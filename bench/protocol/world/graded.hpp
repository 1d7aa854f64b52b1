// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "bench/protocol/grade.hpp"
#include "bench/suite/graded_spec.hpp"
#include "bench/suite/place_facts.hpp"
#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/labels.hpp"
#include "sim/sensors/sense.hpp"
#include "slam/core/sequence.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// One graded query, with the motion around it (for blur, and for the lag of the exposure control).
struct GradedQuery {
  Trajectory clip;
  std::size_t at = 0;  ///< index of the query in the clip
  QueryGrade grade;
};

struct GradedQueries {
  std::vector<GradedQuery> list;  ///< ordered by cell, then by draw, then by speed
  std::vector<GradedCell> cells;  ///< ordered by distance, then by angle
};

/// What graded queries are drawn from.
struct GradedPlace {
  const Scene& queried;  ///< may differ from the scene that was mapped
  std::shared_ptr<const Renderer> mapped_renderer, queried_renderer;
  const Robot& robot;
  const Trajectory& offered;  ///< true poses of the frames offered for mapping
  bool handheld = false;      ///< the mapping was a handheld scan, not a drive
};

/// Draws queries until each cell is full, or until so many have been drawn that continuing is
/// pointless. For a robot: at rest on the floor that it can reach, in a random direction. For a
/// handheld scan: views of other scans, each played at every speed; at a higher speed, the same
/// poses pass in less time. Queries are at least 0.1 (m + rad) apart.
/// @throws InputError if there is no floor.
GradedQueries draw_graded(const GradedSpec& spec, const GradedPlace& place);

/// The distance and angle to the nearest mapped view by true poses; to find the nearest, 1 rad
/// counts as 1 m. Both are absent if nothing is mapped.
QueryGrade grade_of(const Trajectory& mapped, const SE3& world_from_camera);

/// The frames of graded queries, ten seconds apart.
class GradedSequence : public Sequence {
 public:
  GradedSequence(std::shared_ptr<const Renderer> renderer, const Camera& camera,
                 std::vector<GradedQuery> queries, const SensorConfig& sensors, LabelMode labels);
  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return queries_.size(); }
  Stamp stamp_ns(std::size_t i) const override { return truth_[i].stamp_ns; }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override;
  const Trajectory* truth() const override { return &truth_; }

 private:
  std::shared_ptr<const Renderer> renderer_;
  Camera camera_;
  std::vector<GradedQuery> queries_;
  SensorConfig sensors_;
  LabelMode labels_;
  Trajectory truth_;
};

}  // namespace mh
