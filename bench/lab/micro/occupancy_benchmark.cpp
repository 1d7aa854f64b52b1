// SPDX-License-Identifier: Apache-2.0
// Cost of mapping space from the keyframes of a house: integrating one keyframe, integrating all
// keyframes that a loop closure moved, the octree's memory, and a plan over the floor. For
// comparison, OctoMap's own insertPointCloud() gets the same points in the same run. CPU time of
// the process.
// Usage: occupancy_benchmark SCENE.yaml TOUR.yaml ROBOT.yaml LEVEL.yaml [every n-th frame = 15]

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <octomap/OcTree.h>
#include <opencv2/core/utility.hpp>

#include "bench/lab/micro/timing.hpp"
#include "robots/navigation/grid.hpp"
#include "robots/navigation/plan.hpp"
#include "scenes/load.hpp"
#include "sim/sensors/sense.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/io/error.hpp"
#include "slam/occupancy/objects.hpp"
#include "slam/occupancy/obstacle_grid.hpp"
#include "slam/occupancy/occupancy_mapper.hpp"

namespace mh {
namespace {

template <class Work>
double time_ms(const Work& work) {
  const double before = clock_ms(CLOCK_PROCESS_CPUTIME_ID);
  work();
  return clock_ms(CLOCK_PROCESS_CPUTIME_ID) - before;
}

/// The points of a keyframe that the mapper uses, in the camera frame.
octomap::Pointcloud points_of(const OccupancyMapper& mapper, Stamp stamp_ns) {
  octomap::Pointcloud cloud;
  const Grid2d<float>& depth_m = *mapper.depth_of(stamp_ns);
  for (int y = 0; y < depth_m.height(); ++y)
    for (int x = 0; x < depth_m.width(); ++x) {
      if (!(depth_m(x, y) > 0)) continue;
      const Eigen::Vector3d p =
          mapper.thin_camera().unproject(x, y, static_cast<double>(depth_m(x, y)));
      cloud.push_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                      static_cast<float>(p.z()));
    }
  return cloud;
}

octomap::pose6d pose_of(const SE3& pose) {
  const Eigen::Quaterniond q = pose.quaternion();
  const Eigen::Vector3f p = pose.translation().cast<float>();
  return {octomap::point3d(p.x(), p.y(), p.z()),
          octomath::Quaternion(static_cast<float>(q.w()), static_cast<float>(q.x()),
                               static_cast<float>(q.y()), static_cast<float>(q.z()))};
}

/// Changes a path like a loop closure: a drift of 1 % of its length is spread over it.
Trajectory closed(const Trajectory& poses) {
  Trajectory moved = poses;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(moved.size());
    Vector6d drift;
    drift << 0.30 * share, -0.15 * share, 0.0, 0.0, 0.0, 0.03 * share;
    moved[i].world_from_camera = SE3::exp(drift) * poses[i].world_from_camera;
  }
  return moved;
}

void print_row(const char* what, double ms, double limit_ms, double octomap_ms) {
  fmt::print("{:<44}{:>10.2f} ms  (limit {:>6.0f}){:>10.3f} of OctoMap's {:.2f} ms\n", what, ms,
             limit_ms, ms / octomap_ms, octomap_ms);
}

void plan_all(const OccupancyGrid& grid) {
  const FloorGrid floor =
      floor_grid_of(blocked_cells(grid), grid.resolution_m, grid.center_m(0, 0));
  const std::vector<Eigen::Vector2d> places =
      spread_places(floor, largest_region(floor, 0.31), 1.0, 12, 1);
  std::vector<double> times_ms;
  double longest_m = 0;
  for (const Eigen::Vector2d& from : places)
    for (const Eigen::Vector2d& to : places) {
      if (from == to) continue;
      std::optional<std::vector<Eigen::Vector2d>> way;
      times_ms.push_back(time_ms([&] { way = plan_way(floor, from, to, 0.31); }));
      double length_m = 0;
      for (std::size_t i = 1; way && i < way->size(); ++i)
        length_m += ((*way)[i] - (*way)[i - 1]).norm();
      longest_m = std::max(longest_m, length_m);
    }
  if (times_ms.empty()) return;
  fmt::print(
      "plan over the floor ({} ways, longest {:.1f} m): median {:.2f} ms, most {:.2f} ms "
      "(limit 10)\n",
      times_ms.size(), longest_m, median(times_ms), *std::ranges::max_element(times_ms));
}

int run(const std::string& scene_file, const std::string& tour, const std::string& robot_file,
        const std::string& level, std::size_t every) {
  cv::setNumThreads(1);
  const Scene scene = load_scene(scene_file);
  const Robot robot = load_robot(robot_file);
  Trajectory poses;
  const DrivenPath path = travel(scene, robot, tour);
  for (std::size_t i = 0; i < path.camera.size(); i += every) poses.push_back(path.camera[i]);
  const SimulatedSequence frames(make_embree_renderer(scene), robot.camera, poses,
                                 load_sensor_config(level), LabelMode::kExact);
  OccupancyMapper mapper(robot.camera);
  octomap::OcTree octree(0.05);
  std::vector<double> ours_ms, theirs_ms;
  Trajectory so_far;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RgbdFrame frame = frames.frame(i, RandomStream(1).fork(i));
    so_far.push_back(poses[i]);
    ours_ms.push_back(time_ms([&] {
      mapper.keep(frame);
      mapper.update(so_far);
    }));
    const octomap::Pointcloud cloud = points_of(mapper, poses[i].stamp_ns);
    theirs_ms.push_back(time_ms([&] {
      octree.insertPointCloud(cloud, octomap::point3d(0, 0, 0), pose_of(poses[i].world_from_camera),
                              4.0, true, true);
    }));
  }
  double theirs_all_ms = 0;
  for (const double ms : theirs_ms) theirs_all_ms += ms;
  fmt::print("{} keyframes, {} voxels; OctoMap's tree has {} nodes\n", poses.size(),
             mapper.map().voxel_count(), octree.size());
  print_row("integration of a keyframe, median", median(ours_ms), 25, median(theirs_ms));
  print_row("integration of a keyframe, most", *std::ranges::max_element(ours_ms), 25,
            *std::ranges::max_element(theirs_ms));
  OccupancyUpdate update;
  const double loop_ms = time_ms([&] { update = mapper.update(closed(poses)); });
  print_row(fmt::format("a loop moves {} keyframes", update.moved).c_str(), loop_ms, 2000,
            theirs_all_ms);
  mapper.update(poses);
  fmt::print("octree: {:.1f} MB (limit 60); OctoMap's, unpruned, without classes: {:.1f} MB\n",
             static_cast<double>(mapper.map().memory_bytes()) * 1e-6,
             static_cast<double>(octree.memoryUsage()) * 1e-6);
  OccupancyGrid grid;
  fmt::print("grid: {:.1f} ms; ", time_ms([&] { grid = obstacle_grid(mapper.map()); }));
  fmt::print("detections associated: {:.1f} ms; ", time_ms([&] { mapper.associate_detections(); }));
  fmt::print("objects: {:.1f} ms\n", time_ms([&] { find_objects(mapper.map()); }));
  plan_all(grid);
  return 0;
}

}  // namespace
}  // namespace mh

int main(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr, "usage: occupancy_benchmark SCENE TOUR ROBOT LEVEL [every n-th frame]\n");
    return 2;
  }
  try {
    return mh::run(argv[1], argv[2], argv[3], argv[4], argc > 5 ? std::stoul(argv[5]) : 15);
  } catch (const mh::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
