// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "bench/audit/audit.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "slam/config/slam.hpp"
#include "tests/bench/audit/box_room_renderer.hpp"
#include "tests/slam/pipeline/box_room_slam.hpp"

namespace mh::testing_support {

inline constexpr int kTurn = 240;  // frames of a full turn; the tours see only a part of it

inline Trajectory tour(int first, int last,
                       const Eigen::Vector3d& moved_m = Eigen::Vector3d::Zero()) {
  Trajectory path;
  for (int i = first; i < last; ++i) {
    const SE3 pose = BoxRoom::round_trip(i, kTurn);
    path.push_back({i * kFrame_ns, SE3(pose.rotation(), pose.translation() + moved_m)});
  }
  return path;
}

/// A world whose room is mapped over a third of a turn. The second tour is a different path through
/// it, or through `elsewhere`.
inline World world(Trajectory second = tour(10, 70, {0.15, -0.1, 0.05}),
                   std::shared_ptr<const Renderer> elsewhere = nullptr,
                   const SensorConfig& sensors = exact_sensors()) {
  World made;
  SimulatedPlace& place = made.simulated.emplace();
  place.scene = std::make_shared<Scene>();
  place.renderer = std::make_shared<BoxRoomRenderer>();
  place.query_renderer = std::move(elsewhere);
  place.robot.camera = BoxRoom::camera();
  place.mapping.camera = tour(0, 80);
  place.query_tour.emplace().camera = std::move(second);
  place.sensors = sensors;
  made.vocabulary = testing_support::vocabulary();
  simulate(made, LabelMode::kExact);
  return made;
}

inline RunSpec spec(std::vector<SemanticConfig> points = {SemanticConfig{}}) {
  RunSpec made;
  made.name = "semantic-exact-room-0";
  made.environment.name = made.environment.category = "room";
  made.labels = LabelMode::kExact;
  made.seed = 3;
  made.slam = testing_support::box_room_settings(points.front());
  made.points = std::move(points);
  made.protocol.test_interval = 10;
  return made;
}

inline RunTools quick() {
  return {.occupancy = false};
}

struct Audited {
  SlamState frozen;
  RunResult run;
  RunAudit audit;
};

inline Audited audited(const RunSpec& of, const World& in) {
  Audited made;
  made.run = run_with_map(of, in, quick(), made.frozen);
  made.audit = audit_run(made.run, in, made.frozen);
  return made;
}

}  // namespace mh::testing_support
