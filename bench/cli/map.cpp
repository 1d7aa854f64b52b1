// SPDX-License-Identifier: Apache-2.0
// `modelhouse map grid|cost|objects|plan|messages`: what a robot gets from a saved octree.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/protocol/episodes/robot_map.hpp"
#include "bench/run/maps/map_messages.hpp"
#include "robots/navigation/grid.hpp"
#include "robots/navigation/plan.hpp"
#include "scenes/image_file.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/occupancy/cost_map.hpp"
#include "slam/occupancy/map_image.hpp"
#include "slam/occupancy/objects.hpp"
#include "slam/occupancy/obstacle_grid.hpp"

namespace mh::cli {
namespace {

using Eigen::Vector2d;

struct MapGridArguments {
  std::string map, out;
  ObstacleGridConfig band;
  bool raw = false;
};

struct MapCostArguments {
  std::string grid, out;
  CostMapConfig config;
};

struct MapObjectsArguments {
  std::string map, name, out;
};

struct MapMessagesArguments {
  std::string map, out;
  ObstacleGridConfig band;
};

struct MapPlanArguments {
  std::string map, thing, out;
  ObstacleGridConfig band;
  std::vector<double> from, to;
  double radius_m = 0.26, margin_m = 0.05;
};

void add_band(CLI::App& command, ObstacleGridConfig& band) {
  command
      .add_option("--height", band.robot_height_m,
                  "Height of the robot, m: anything higher is no obstacle")
      ->check(number_between(0.15, 10.0));
  command.add_option("--floor-z", band.floor_z_m, "Height of the floor in the map, m")
      ->check(number_between(-1000.0, 1000.0));
}

/// First line of a file that contains a robot's path.
constexpr std::string_view kPathHead = "x_m,y_m\n";

std::string place(const Vector2d& p) {
  return fmt::format("({:.2f}, {:.2f})", p.x(), p.y());
}

VoxelMap load_map(const std::string& file) {
  std::vector<std::string> notes;
  VoxelMap map = VoxelMap::load_octree(file, notes);
  for (const std::string& note : notes) fmt::print(stderr, "map: {}\n", note);
  return map;
}

/// @throws InputError if the map has no floor, or is empty between the ground and the robot's
/// height.
OccupancyGrid grid_of(const VoxelMap& map, const std::string& file,
                      const ObstacleGridConfig& band) {
  if (!map.on_floor())
    throw InputError(file + ": no floor was found for it: heights and a grid mean nothing in it");
  OccupancyGrid grid = obstacle_grid(map, band);
  if (grid.cells.empty())
    throw InputError(fmt::format("{}: knows nothing about heights from {} m to {} m", file,
                                 band.floor_z_m + band.ground_m,
                                 band.floor_z_m + band.robot_height_m));
  return grid;
}

/// Decodes an image to gray, the mean of a pixel's colors, as in map_server.
GrayImage decode_gray_image(const std::string& bytes) {
  cv::Mat decoded = decode_image(bytes);
  if (decoded.depth() != CV_8U && decoded.depth() != CV_16U)
    throw InputError("its pixels have neither 8 nor 16 bits");
  if (decoded.depth() == CV_16U) decoded.convertTo(decoded, CV_8U, 1.0 / 257);
  const int channels = decoded.channels(), colors = std::min(channels, 3);
  GrayImage image{Grid2d<std::uint8_t>(decoded.cols, decoded.rows), {}};
  for (int y = 0; y < decoded.rows; ++y)
    for (int x = 0; x < decoded.cols; ++x) {
      const std::uint8_t* pixel = decoded.ptr<std::uint8_t>(y) + channels * x;
      const int sum = std::accumulate(pixel, pixel + colors, 0);
      image.levels(x, y) = static_cast<std::uint8_t>((sum + colors / 2) / colors);
      if (channels == 4) image.clear.push_back(pixel[3] < 255);
    }
  return image;
}

/// Checks, before any work, that the two files of a map image can be written.
void require_writable_map_image(const std::string& stem,
                                const std::vector<std::filesystem::path>& read) {
  require_replaceable_map_image(stem);
  for (const std::filesystem::path& file : map_image_files(stem)) require_writable(file, read);
}

void run(const MapGridArguments& options) {
  const NewFolders made(std::filesystem::path(options.out).parent_path());
  require_writable_map_image(options.out, {options.map});
  const OccupancyGrid grid = grid_of(load_map(options.map), options.map, options.band);
  save_map_server(grid, options.out, options.raw ? GridMode::kRaw : GridMode::kTrinary);
  std::size_t free = 0, occupied = 0;
  for (const std::int8_t cell : grid.cells) {
    free += cell == kFreeCell ? 1 : 0;
    occupied += cell == kOccupiedCell ? 1 : 0;
  }
  const double cell_m2 = grid.resolution_m * grid.resolution_m;
  fmt::print("{} x {} cells of {} m: {:.2f} m2 free, {:.2f} m2 occupied\n", grid.cells.width(),
             grid.cells.height(), grid.resolution_m, static_cast<double>(free) * cell_m2,
             static_cast<double>(occupied) * cell_m2);
}

void run(const MapCostArguments& options) {
  const NewFolders made(std::filesystem::path(options.out).parent_path());
  const std::string published = options.out + "_published";
  if (options.config.inflation_radius_m < options.config.inscribed_radius_m)
    throw InputError(
        fmt::format("--inflation: {} m is less than the robot's radius, {} m (--radius)",
                    options.config.inflation_radius_m, options.config.inscribed_radius_m));
  std::vector<std::string> warnings;
  const OccupancyGrid grid = load_map_server(options.grid, &warnings, decode_gray_image);
  const std::vector<std::filesystem::path> read{options.grid, image_of_map(options.grid)};
  require_writable_map_image(options.out, read);
  require_writable_map_image(published, read);
  for (const std::string& warning : warnings) fmt::print(stderr, "map: warning: {}\n", warning);
  const CostMap costs = cost_map(grid, options.config);
  save_cost_map(costs, options.out);
  save_map_server(as_published(costs), published, GridMode::kRaw);
  fmt::print("{} x {} cells of {} m\n", costs.costs.width(), costs.costs.height(),
             costs.resolution_m);
}

void run(const MapObjectsArguments& options) {
  const NewFolders made(std::filesystem::path(options.out).parent_path());
  if (!options.out.empty())
    require_replaceable(options.out, "{\n  \"resolution_m\": ", "`modelhouse map`", {options.map});
  const VoxelMap map = load_map(options.map);
  const std::vector<MapObject> objects = find_objects(map);
  std::vector<std::size_t> shown;
  if (options.name.empty())
    for (std::size_t i = 0; i < objects.size(); ++i) shown.push_back(i);
  else
    shown = objects_named(objects, options.name);
  if (!options.out.empty())
    write_atomically(options.out, objects_json(objects, map.resolution_m()));
  fmt::print("{:<22}{:>7}  {:>24}  {:>20}\n", "object", "score", "center m", "size m");
  for (const std::size_t i : shown) {
    const MapObject& o = objects[i];
    const Eigen::Vector3d size_m = o.max_m - o.min_m;
    fmt::print("{:<22}{:>7.2f}  {:>8.2f}{:>8.2f}{:>8.2f}  {:>8.2f}{:>6.2f}{:>6.2f}\n", o.name,
               o.score, o.center_m.x(), o.center_m.y(), o.center_m.z(), size_m.x(), size_m.y(),
               size_m.z());
  }
}

void run(const MapMessagesArguments& options) {
  const NewFolders made(std::filesystem::path(options.out).parent_path());
  const std::string kind = std::filesystem::path(options.out).extension().string();
  if (kind != ".mcap" && kind != ".bag")
    throw InputError(options.out + ": its name ends neither in .mcap (ROS 2) nor in .bag (ROS 1)");
  if (is_there(options.out) && !holds_map_messages(options.out))
    throw InputError(
        options.out +
        ": already exists and was not written by `modelhouse map messages`: name another");
  const VoxelMap map = load_map(options.map);
  const MapStudy study{grid_of(map, options.map, options.band), find_objects(map)};
  write_map_messages(kind == ".mcap" ? *write_mcap(options.out) : *write_bag(options.out), map,
                     study);
  fmt::print("{} x {} cells, {}, {}\n", study.grid.cells.width(), study.grid.cells.height(),
             counted(study.objects.size(), "object"), counted(map.voxel_count(), "voxel"));
}

/// A goal next to a named object, at a place where a robot in an episode would stop. If several
/// objects match, the goal is next to the one with the best score that can be reached.
Vector2d place_beside(const std::string& name, const VoxelMap& map, const KnownMap& known,
                      const Vector2d& from_m, double clearance_m) {
  constexpr double kReach_m = 1.5;  // a place farther away is not at the object
  const std::vector<MapObject> objects = find_objects(map);
  std::vector<MapObject> meant;
  for (const std::size_t i : objects_named(objects, name)) meant.push_back(objects[i]);
  const std::vector<std::vector<Vector2d>> footprints_m = footprints_of(map, meant);
  for (std::size_t i = 0; i < meant.size(); ++i) {
    const Grid2d<float> away_m = distances_m(known, footprints_m[i], kReach_m);
    if (const auto found = place_before(known.grid, away_m, from_m, clearance_m, kReach_m)) {
      if (meant.size() > 1) fmt::print(stderr, "map: of '{}': {}\n", name, meant[i].name);
      return *found;
    }
  }
  throw InputError(
      fmt::format("goal '{}'{}: no free place within 1.5 m of it, without a wall between, can be "
                  "reached from {}",
                  meant.front().name,
                  meant.size() == 1 ? "" : fmt::format(", nor any of {} more", meant.size() - 1),
                  place(from_m)));
}

/// @throws InputError if a robot cannot stand at a place of the grid.
void require_clear(const char* what, const Vector2d& at, const OccupancyGrid& grid,
                   const FloorGrid& floor, double clearance_m) {
  const auto cell = grid.cell_of(at);
  if (!cell) throw InputError(fmt::format("{} {} is outside the map", what, place(at)));
  const std::int8_t state = grid.cells(cell->x(), cell->y());
  if (state == kUnknownCell)
    throw InputError(fmt::format("{} {} is in unknown space", what, place(at)));
  if (state == kOccupiedCell)
    throw InputError(fmt::format("{} {} is inside an obstacle", what, place(at)));
  if (const double has_m = floor.clearance_at(at); has_m < clearance_m)
    throw InputError(
        fmt::format("{} {} has {:.2f} m to the nearest obstacle or unknown space, "
                    "and the robot needs {:.2f} m",
                    what, place(at), has_m, clearance_m));
}

void run(const MapPlanArguments& options) {
  const NewFolders made(std::filesystem::path(options.out).parent_path());
  if (options.to.empty() == options.thing.empty())
    throw InputError("plan: give the goal by either --to or --to-object");
  if (!options.out.empty())
    require_replaceable(options.out, kPathHead, "`modelhouse map plan`", {options.map});
  const VoxelMap map = load_map(options.map);
  const OccupancyGrid grid = grid_of(map, options.map, options.band);
  const KnownMap known = known_map(map, grid);
  const FloorGrid& floor = known.grid;
  const double clearance_m = options.radius_m + options.margin_m;
  const Vector2d from(options.from[0], options.from[1]);
  require_clear("start", from, grid, floor, clearance_m);
  Vector2d to;
  if (!options.thing.empty()) {
    to = place_beside(options.thing, map, known, from, clearance_m);
  } else {
    to = {options.to[0], options.to[1]};
    require_clear("goal", to, grid, floor, clearance_m);
  }
  const auto way = plan_way(floor, from, to, clearance_m);
  if (!way)
    throw InputError(fmt::format("goal {}: no path leads there from {} that keeps {:.2f} m clear",
                                 place(to), place(from), clearance_m));
  double length_m = 0;
  std::string text(kPathHead);
  for (std::size_t i = 0; i < way->size(); ++i) {
    if (i > 0) length_m += ((*way)[i] - (*way)[i - 1]).norm();
    text += fmt::format("{:.3f},{:.3f}\n", (*way)[i].x(), (*way)[i].y());
  }
  if (!options.out.empty()) write_atomically(options.out, text);
  fmt::print("{}{}, {:.2f} m\n", options.out.empty() ? text : "", counted(way->size(), "corner"),
             length_m);
}

void add_grid(CLI::App& map) {
  auto options = std::make_shared<MapGridArguments>();
  CLI::App* command = map.add_subcommand(
      "grid", "Writes the part of a saved octree that obstructs a robot, as a grid.");
  command
      ->add_option("map", options->map,
                   "map.ot of `map build` or `bench`, or any OcTree (.ot, .bt)")
      ->required();
  command->add_option("--out", options->out, "Path without extension: .pgm and .yaml are written")
      ->required();
  add_band(*command, options->band);
  command->add_flag("--raw", options->raw, "map_server's mode raw instead of trinary");
  command->footer("Example:\n  modelhouse map grid out/map/map.ot --out out/grid");
  command->callback([options] { run(*options); });
}

void add_cost(CLI::App& map) {
  auto options = std::make_shared<MapCostArguments>();
  CLI::App* command =
      map.add_subcommand("cost", "Writes the costs of a grid, as Nav2 numbers them.");
  command->add_option("grid", options->grid, "YAML file of a grid for map_server")->required();
  command
      ->add_option("--out", options->out,
                   "Path without extension: costs as gray levels; with _published appended, the "
                   "values that Nav2 publishes")
      ->required();
  command
      ->add_option("--radius", options->config.inscribed_radius_m, "Radius of the robot's disc, m")
      ->check(number_between(0.0, 10.0));
  command
      ->add_option("--inflation", options->config.inflation_radius_m,
                   "Distance at which costs end, m")
      ->check(number_between(0.0, 10.0));
  command->add_option("--scaling", options->config.cost_scaling_factor, "Decay, 1/m")
      ->check(number_between(0.0, 1000.0));
  command->footer("Example:\n  modelhouse map cost out/map/grid.yaml --out out/cost");
  command->callback([options] { run(*options); });
}

void add_objects(CLI::App& map) {
  auto options = std::make_shared<MapObjectsArguments>();
  CLI::App* command = map.add_subcommand(
      "objects", "Lists the objects of a saved octree, or those with a given name.");
  command
      ->add_option("map", options->map,
                   "map.ot of `map build` or `bench`, or any OcTree (.ot, .bt)")
      ->required();
  command->add_option("name", options->name, "Class or object: refrigerator, \"chair 2\"")
      ->check(not_empty());
  command->add_option("--out", options->out, "JSON file of all objects")->check(not_empty());
  command->footer("Example:\n  modelhouse map objects out/map/map.ot refrigerator");
  command->callback([options] { run(*options); });
}

void add_messages(CLI::App& map) {
  auto options = std::make_shared<MapMessagesArguments>();
  CLI::App* command = map.add_subcommand(
      "messages", "Writes a saved octree for RViz: grid, costs, objects as markers, voxels.");
  command
      ->add_option("map", options->map,
                   "map.ot of `map build` or `bench`, or any OcTree (.ot, .bt)")
      ->required();
  command->add_option("--out", options->out, "File: NAME.mcap for ROS 2, NAME.bag for ROS 1")
      ->required();
  add_band(*command, options->band);
  command->footer("Example:\n  modelhouse map messages out/map/map.ot --out out/map.mcap");
  command->callback([options] { run(*options); });
}

void add_plan(CLI::App& map) {
  auto options = std::make_shared<MapPlanArguments>();
  CLI::App* command = map.add_subcommand("plan",
                                         "Plans a path over the floor of a saved octree: short, "
                                         "and away from obstacles where there is room.");
  command
      ->add_option("map", options->map,
                   "map.ot of `map build` or `bench`, or any OcTree (.ot, .bt)")
      ->required();
  command->add_option("--from", options->from, "Start: x y, m")
      ->expected(2)
      ->check(number_between(-1e6, 1e6))
      ->required();
  command->add_option("--to", options->to, "Goal: x y, m")
      ->expected(2)
      ->check(number_between(-1e6, 1e6));
  command
      ->add_option(
          "--to-object", options->thing,
          "Goal: next to this object, with no wall in between; a class, or an object's name")
      ->check(not_empty());
  command->add_option("--radius", options->radius_m, "Radius of the robot's disc, m")
      ->check(number_between(0.0, 10.0));
  command->add_option("--margin", options->margin_m, "Clearance beyond the radius, m")
      ->check(number_between(0.0, 10.0));
  command->add_option("--out", options->out, "CSV file of the path's corners")->check(not_empty());
  add_band(*command, options->band);
  command->footer(
      "Example:\n  modelhouse map plan out/map/map.ot --from 1.5 2.5 --to-object refrigerator");
  command->callback([options] { run(*options); });
}

}  // namespace

void add_map(CLI::App& app) {
  CLI::App* map = app.add_subcommand(
      "map", "Space, grids, costs, objects and paths from what a robot has mapped.");
  map->require_subcommand(1);
  add_map_build(*map);
  add_grid(*map);
  add_cost(*map);
  add_objects(*map);
  add_plan(*map);
  add_messages(*map);
}

}  // namespace mh::cli
