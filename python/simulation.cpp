// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <mutex>

#include <fmt/format.h>

#include "bench/protocol/episodes/starts.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/suite/cache.hpp"
#include "bench/suite/labels.hpp"
#include "bench/suite/shipped.hpp"
#include "python/bind.hpp"
#include "sim/simulation/simulation.hpp"
#include "slam/io/error.hpp"

namespace mh::python {
namespace {

LabelMode label_mode(const std::string& word) {
  for (const LabelMode mode : {LabelMode::kNone, LabelMode::kExact, LabelMode::kAnnotated,
                               LabelMode::kBoxes, LabelMode::kDetector})
    if (name(mode) == word) return mode;
  throw py::value_error(
      fmt::format("labels='{}' is not one of none, exact, annotated, boxes, detector", word));
}

/// What a step delivers, and the robot's equipment, which holds the sensors' names.
struct Observed {
  RobotObservation seen;
  std::shared_ptr<RgbdFrame> frame;  ///< or null
  std::shared_ptr<const Equipment> equipment;
};

/// x, y (m) and heading (rad).
using Place = std::array<double, 3>;

/// A scene, a robot and a level, loaded once; reset() starts over.
class PythonSimulation {
 public:
  PythonSimulation(const std::string& scene, const std::string& robot, const std::string& level,
                   std::uint64_t seed, const std::string& labels, int ticks_per_frame,
                   const std::string& cache)
      : robot_(load_robot(find_shipped(robot, Shipped::kRobot))),
        level_(load_sensor_config(find_shipped(level, Shipped::kLevel))),
        config_{.ticks_per_frame = ticks_per_frame, .labels = label_mode(labels), .seed = seed} {
    if (ticks_per_frame < 1 || ticks_per_frame > 60)
      throw InputError(fmt::format("ticks_per_frame={}: not in 1 to 60", ticks_per_frame));
    if (!robot_.equipment || robot_.wheels() == nullptr)
      throw InputError(fmt::format("robot '{}' has no wheels: it cannot drive", robot_.name));
    const py::gil_scoped_release others_run;
    const std::filesystem::path kept = cache == "none" ? std::filesystem::path()
                                       : cache.empty() ? Cache::default_folder()
                                                       : std::filesystem::absolute(cache);
    scene_ = load_simulated_scene(find_scene(scene), Cache(kept));
  }

  void reset(const std::optional<Place>& pose, const std::optional<std::uint64_t>& seed) {
    const py::gil_scoped_release others_run;
    const std::lock_guard lock(mutex_);
    begin(pose, seed);
  }

  std::shared_ptr<Observed> step(double vx, double vy, double wz, double dt_s) {
    if (!std::isfinite(vx) || !std::isfinite(vy) || !std::isfinite(wz))
      throw py::value_error("a velocity is not finite");
    if (!(dt_s > 0 && dt_s <= 60))
      throw py::value_error(fmt::format("dt={} s: not in (0, 60]", dt_s));
    const py::gil_scoped_release others_run;
    const std::lock_guard lock(mutex_);
    auto made = std::make_shared<Observed>();
    made->seen = running().step({vx, vy, wz}, dt_s);
    if (made->seen.frame) made->frame = std::make_shared<RgbdFrame>(std::move(*made->seen.frame));
    made->equipment = robot_.equipment;
    return made;
  }

  void carry_to(const Place& place) {
    const py::gil_scoped_release others_run;
    const std::lock_guard lock(mutex_);
    const StandingPlace at = placed(place);
    running().carry_to(at.place_m, at.heading_rad);
  }
  void switch_light(bool on) {
    const py::gil_scoped_release others_run;
    const std::lock_guard lock(mutex_);
    running().switch_light(on);
  }

  py::dict truth() {
    SE3 world_from_base;
    std::optional<TimedPose> frame;
    py::dict d;
    {
      const std::unique_lock lock = locked();
      const CommandedBase& base = running().truth();
      world_from_base = base.world_from_base();
      frame = simulation_->truth_of_frame();
      d["touching"] = base.contact().touching;
      d["bumps"] = base.bumps().size();
      d["length_m"] = base.length_m();
      d["time_s"] = base.time_s();
    }
    d["world_from_base"] = to_python(world_from_base);
    d["world_from_camera"] = to_python(world_from_base * robot_.base_from_camera);
    d["frame_pose"] = frame ? py::object(to_python(frame->world_from_camera)) : py::none();
    return d;
  }

  py::dict render(const Array<double>& poses) const {
    const bool is_one = poses.ndim() == 2;
    if (!is_one && !(poses.ndim() == 3 && poses.shape(1) == 4 && poses.shape(2) == 4))
      throw py::value_error("expected a pose (4, 4), or (N, 4, 4)");
    const py::ssize_t count = is_one ? 1 : poses.shape(0);
    const py::ssize_t h = robot_.camera.height_px, w = robot_.camera.width_px;
    std::vector<SE3> at;
    for (py::ssize_t i = 0; i < count; ++i)
      at.push_back(to_pose(Array<double>(std::vector<py::ssize_t>{4, 4}, poses.data() + 16 * i)));
    std::vector<py::ssize_t> shape{h, w};
    if (!is_one) shape.insert(shape.begin(), count);
    std::vector<py::ssize_t> colored = shape;
    colored.push_back(3);
    py::array_t<std::uint8_t> color(colored), labels(shape);
    py::array_t<float> depth(shape);
    py::array_t<std::uint16_t> instances(shape);
    {
      auto* const c = color.mutable_data();
      auto* const l = labels.mutable_data();
      auto* const d = depth.mutable_data();
      auto* const n = instances.mutable_data();
      const py::gil_scoped_release others_run;
      const auto pixels = static_cast<std::size_t>(h * w);
      for (std::size_t i = 0; i < at.size(); ++i) {
        const RenderedFrame frame = scene_.renderer->render(robot_.camera, at[i]);
        std::memcpy(c + 3 * pixels * i, frame.color.data(), 3 * pixels);
        std::copy_n(frame.classes.data(), pixels, l + pixels * i);
        std::copy_n(frame.depth_m.data(), pixels, d + pixels * i);
        std::copy_n(frame.instances.data(), pixels, n + pixels * i);
      }
    }
    py::dict made;
    made["color"] = color, made["depth"] = depth;
    made["labels"] = labels, made["instances"] = instances;
    return made;
  }

  EpisodeStart draw_start(const std::vector<std::string>& goals, std::uint64_t seed,
                          double arrival_m) const {
    EpisodesSpec spec;
    spec.goals = goals;
    spec.starts = 1;
    spec.seed = seed;
    spec.arrival_m = arrival_m;
    return draw_starts(spec, *scene_.scene, robot_).front();
  }

  Camera camera() const { return with_lens(robot_.camera, level_); }
  std::vector<std::string> things() const {
    std::set<std::string> names;
    for (const Instance& instance : scene_.scene->instances)
      names.emplace(classes()[instance.class_id].name);
    return {names.begin(), names.end()};
  }

 private:
  // Callers of the following functions hold the lock.
  Simulation& running() {
    if (!simulation_) begin({}, {});
    return *simulation_;
  }
  void begin(const std::optional<Place>& pose, const std::optional<std::uint64_t>& seed) {
    SimulationConfig config = config_;
    if (seed) config.seed = *seed;
    const StandingPlace start =
        pose ? placed(*pose)
             : draw_place(*scene_.scene, robot_, RandomStream(config.seed).fork(0x706c616365));
    config.start_m = start.place_m;
    config.start_heading_rad = start.heading_rad;
    simulation_ = std::make_unique<Simulation>(scene_, robot_, level_, config);
    config_ = config;
  }
  static StandingPlace placed(const Place& place) {
    for (const double number : place)
      if (!(std::abs(number) <= kFarthest_m))
        throw InputError(
            fmt::format("pose ({}, {}, {}): is not a valid place", place[0], place[1], place[2]));
    return {{place[0], place[1]}, place[2]};
  }
  /// Takes the lock; other Python threads can run while this one waits for it.
  std::unique_lock<std::mutex> locked() {
    const py::gil_scoped_release others_run;
    return std::unique_lock(mutex_);
  }
  Robot robot_;
  SensorConfig level_;
  SimulationConfig config_;
  SimulatedScene scene_;
  std::unique_ptr<Simulation> simulation_;
  std::mutex mutex_;  ///< guards simulation_ and config_: Python threads may share an object
};

template <class Sensors, class Value>
py::dict by_name(const Sensors& sensors, const Value& value) {
  py::dict d;
  for (std::size_t k = 0; k < sensors.size(); ++k) d[sensors[k].name.c_str()] = value(k);
  return d;
}

template <class Read>
auto of_frame(Read read) {
  return [read](const Observed& o) -> py::object {
    if (!o.frame) return py::none();
    return py::cast(o.frame).attr(read);
  };
}

}  // namespace

void bind_simulation(py::module_& m) {
  py::class_<Observed, std::shared_ptr<Observed>>(
      m, "Observation", "What the robot's sensors deliver at the end of a step.")
      .def_property_readonly(
          "stamp", [](const Observed& o) { return 1e-9 * static_cast<double>(o.seen.stamp_ns); },
          "s")
      .def_property_readonly(
          "stamp_ns", [](const Observed& o) { return o.seen.stamp_ns; }, "ns")
      .def_property_readonly(
          "frame", [](const Observed& o) { return o.frame; },
          "The Frame that was due during the step, stamped one tick of the camera before it ends; "
          "None if none was due")
      .def_property_readonly("color", of_frame("color"), "(H, W, 3) uint8 of that frame, or None")
      .def_property_readonly("depth", of_frame("depth"), "(H, W) float32, m, or None")
      .def_property_readonly("labels", of_frame("labels"), "(H, W) uint8 class ids, or None")
      .def_property_readonly(
          "instances",
          [](py::object self) -> py::object {
            const Observed& o = self.cast<Observed&>();
            if (o.seen.instances.empty()) return py::none();
            return view_of(o.seen.instances, self);
          },
          "(H, W) id of the object that each pixel shows, 0 for none: the truth, for training; or "
          "None")
      .def_property_readonly(
          "odometry", [](const Observed& o) { return to_python(o.seen.odom_from_base); },
          "4 x 4, where the wheels alone place the base; drifts")
      .def_property_readonly(
          "imu",
          [](const Observed& o) {
            Array<double> six(6);
            for (int k = 0; k < 3; ++k) {
              six.mutable_data()[k] = o.seen.reading.turn_rad_per_s(k);
              six.mutable_data()[3 + k] = o.seen.reading.specific_force_m_per_s2(k);
            }
            return six;
          },
          "(6,) angular rate (rad/s) and specific force (m/s^2) of the base's IMU one tick ago; 0 "
          "without an IMU")
      .def_property_readonly(
          "lasers",
          [](const Observed& o) {
            return by_name(o.equipment->lasers, [&](std::size_t k) {
              const std::vector<float>& m = o.seen.reading.lasers_m[k];
              return Array<float>(static_cast<py::ssize_t>(m.size()), m.data());
            });
          },
          "For each laser by name: (N,) m, right to left; 0 where nothing is in range")
      .def_property_readonly(
          "sonars",
          [](const Observed& o) {
            return by_name(o.equipment->sonars,
                           [&](std::size_t k) { return o.seen.reading.sonars_m[k]; });
          },
          "For each sonar by name: m; 0 if nothing is in range")
      .def_property_readonly(
          "bumpers",
          [](const Observed& o) {
            py::dict d;
            for (std::size_t k = 0; k < o.equipment->bumpers.size(); ++k)
              d[o.equipment->bumpers[k].c_str()] = static_cast<bool>(o.seen.reading.bumpers[k]);
            return d;
          },
          "For each bumper by name: whether it was pressed during the step");

  py::class_<EpisodeStart>(m, "SearchStart", "Where a robot starts, and what it must find.")
      .def_property_readonly(
          "pose",
          [](const EpisodeStart& s) {
            return Place{s.place_m.x(), s.place_m.y(), s.heading_rad};
          },
          "x, y (m) and heading (rad)")
      .def_readonly("goal", &EpisodeStart::goal, "class")
      .def_readonly("shortest_m", &EpisodeStart::shortest_m, "length of the shortest path to it")
      .def(
          "is_arrival",
          [](const EpisodeStart& s, double x, double y, double arrival_m) {
            return is_arrival(s, {x, y}, arrival_m);
          },
          py::arg("x"), py::arg("y"), py::arg("arrival_m") = 1.0,
          "Whether a position is within arrival_m of one of the goal's objects, with no wall in "
          "between.");

  py::class_<PythonSimulation>(
      m, "Simulation",
      "A robot in a scene that obeys velocity commands. The same commands give the same bits, also "
      "in `modelhouse drive` and `render`.\n\n"
      "scene: a shipped name, a file, 'generated:CATEGORY:SEED'. robot, level: a shipped name or a "
      "file. labels: none, exact, annotated, boxes or detector. ticks_per_frame: number of camera "
      "ticks from one frame to the next. cache: the folder that keeps baked light; '' means the "
      "usual one, 'none' keeps nothing. Raises InputError.")
      .def(py::init<const std::string&, const std::string&, const std::string&, std::uint64_t,
                    const std::string&, int, const std::string&>(),
           py::arg("scene"), py::arg("robot") = "pepper", py::arg("level") = "handheld",
           py::arg("seed") = 0, py::arg("labels") = "exact", py::arg("ticks_per_frame") = 3,
           py::arg("cache") = "")
      .def("reset", &PythonSimulation::reset, py::arg("pose") = py::none(),
           py::arg("seed") = py::none(),
           "Starts over at a pose (x, y in m, heading in rad), or where the seed places the robot. "
           "Raises InputError if the robot cannot stand there.")
      .def(
          "step", &PythonSimulation::step, py::arg("vx"), py::arg("vy"), py::arg("wz"),
          py::arg("dt") = 0.1,
          "Drives with a velocity (m/s, rad/s, base frame) for dt seconds, rounded to ticks of the "
          "camera, within the robot's limits; returns an Observation. A differential base does not "
          "obey vy.")
      .def("carry_to", &PythonSimulation::carry_to, py::arg("pose"),
           "Carries the robot to another pose; its wheels do not turn.")
      .def("switch_light", &PythonSimulation::switch_light, py::arg("on"),
           "While the light is off, frames are blank.")
      .def("truth", &PythonSimulation::truth,
           "The truth, which no system may see: the current world_from_base and world_from_camera, "
           "frame_pose (world_from_camera at the last frame, or None), touching, bumps, length_m, "
           "time_s.")
      .def("render", &PythonSimulation::render, py::arg("poses"),
           "The exact view from world_from_camera (4, 4), or from N of them: a dict of color, "
           "depth, "
           "labels, instances, without noise or lens.")
      .def("draw_start", &PythonSimulation::draw_start, py::arg("goals"), py::arg("seed") = 0,
           py::arg("arrival_m") = 1.0,
           "A SearchStart for one of the goals (classes), as suites with `episodes` draw them.")
      .def_property_readonly("camera", &PythonSimulation::camera,
                             "the Camera as SLAM should know it")
      .def_property_readonly("things", &PythonSimulation::things,
                             "classes of the objects in the scene");
}

}  // namespace mh::python
