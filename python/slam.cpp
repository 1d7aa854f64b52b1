// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <mutex>

#include <fmt/format.h>

#include "bench/protocol/streams.hpp"
#include "bench/suite/shipped.hpp"
#include "python/bind.hpp"
#include "slam/config/by_name.hpp"
#include "slam/files/map_file.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/io/error.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh::python {
namespace {

/// The settings in a dict such as {"features.count": 1000}, or in a file.
/// @param base  values of all other settings
SlamConfig config_of(const py::object& settings, const SlamConfig& base) {
  if (settings.is_none()) return base;
  if (py::isinstance<py::str>(settings))
    return load_settings(find_shipped(settings.cast<std::string>(), Shipped::kSettings), base).slam;
  std::map<std::string, std::string> sections;
  for (const auto& [key, value] : settings.cast<py::dict>()) {
    if (!py::isinstance<py::str>(key))
      throw InputError(
          fmt::format("settings: {} is not a name", py::repr(key).cast<std::string>()));
    const auto full = key.cast<std::string>();
    if (!is_setting(full)) throw InputError(fmt::format("settings: '{}' is not a setting", full));
    const auto dot = full.find('.');
    const std::string text = py::isinstance<py::bool_>(value)
                                 ? (value.cast<bool>() ? "true" : "false")
                                 : py::str(value).cast<std::string>();
    sections[full.substr(0, dot)] += fmt::format("  {}: {}\n", full.substr(dot + 1), text);
  }
  std::string text;
  for (const auto& [section, lines] : sections) text += section + ":\n" + lines;
  return text.empty() ? base : parse_settings(text, "settings", base).slam;
}

std::shared_ptr<const Vocabulary> vocabulary_of(const std::string& name) {
  return std::make_shared<const Vocabulary>(
      Vocabulary::load(find_shipped(name, Shipped::kVocabulary)));
}

/// The random stream that `modelhouse slam` uses until the system is first restarted.
RandomStream draws_of(std::uint64_t seed) {
  RunSpec spec;
  spec.seed = seed;
  const std::uint64_t no_restart = 0;
  return mapping_stream(spec).fork(RunDraw::kSlam).fork(no_restart);
}

/// A SLAM system that maps frame by frame, with the random draws of `modelhouse slam`.
struct PythonSlam {
  SlamState state;
  std::uint64_t seed = 0;
  RandomStream draws = draws_of(seed);
  std::uint64_t frames = 0;
  /// Python threads may share one object.
  std::unique_ptr<std::mutex> mutex = std::make_unique<std::mutex>();

  StepReport step(const RgbdFrame& frame) {
    const std::lock_guard lock(*mutex);
    return mh::step(state, frame, draws.fork(frames++));
  }
  StepReport relocalize(const RgbdFrame& frame) const {
    const std::lock_guard lock(*mutex);
    Tracker lost;
    return localize(state, lost, frame, RandomStream(seed).fork(~std::uint64_t{0}));
  }
};

/// Takes the lock; other Python threads can run while this one waits for it.
std::unique_lock<std::mutex> locked(const PythonSlam& slam) {
  const py::gil_scoped_release others_run;
  return std::unique_lock(*slam.mutex);
}

py::object landmarks(const PythonSlam& slam, bool classes) {
  const auto lock = locked(slam);
  const Map& map = slam.state.map;
  std::vector<std::vector<double>> rows;
  std::vector<std::uint8_t> labels;
  for (const Landmark& landmark : map.landmarks()) {
    if (landmark.erased) continue;
    const Eigen::Vector3d& p = landmark.position_in_world;
    rows.push_back({p.x(), p.y(), p.z()});
    labels.push_back(landmark.label);
  }
  if (!classes) return rows_of(rows, 3);
  return Array<std::uint8_t>(static_cast<py::ssize_t>(labels.size()), labels.data());
}

Trajectory keyframes(const PythonSlam& slam) {
  const auto lock = locked(slam);
  Trajectory poses;
  for (const Keyframe& keyframe : slam.state.map.keyframes())
    if (!keyframe.erased)
      poses.push_back({keyframe.stamp_ns, keyframe.camera_from_world.inverse()});
  return poses;
}

}  // namespace

void bind_slam(py::module_& m) {
  py::class_<StepReport>(m, "Step", "What SLAM reports about a frame.")
      .def_property_readonly(
          "status", [](const StepReport& r) { return std::string(name(r.status)); },
          "initialized, tracked, relocalized or lost")
      .def_property_readonly(
          "pose", [](const StepReport& r) { return to_python(r.world_from_camera); },
          "4 x 4 world_from_camera; None if lost")
      .def_readonly("keypoints", &StepReport::keypoints, "found in the image")
      .def_readonly("inliers", &StepReport::inliers, "landmarks that agree with the pose")
      .def_readonly("keyframe", &StepReport::keyframe_added, "whether the frame became a keyframe")
      .def_readonly("loop_closed", &StepReport::loop_closed, "whether a loop was closed")
      .def_property_readonly(
          "stage", [](const StepReport& r) { return std::string(name(r.relocalization)); },
          "where a relocalization ended: none, no_candidate, matches, pnp, inliers, verified")
      .def_property_readonly(
          "candidates",
          [](const StepReport& r) -> py::object {
            if (!r.candidates) return py::none();
            const CandidateCounts& c = *r.candidates;
            py::dict d;
            d["keyframes"] = c.keyframes;
            d["c1"] = c.c1, d["c2"] = c.c2, d["c3"] = c.c3, d["final"] = c.final;
            return d;
          },
          "keyframes left after each step of Algorithm 1: keyframes, c1, c2, c3, final; or None")
      .def("__repr__", [](const StepReport& r) {
        return fmt::format("Step({}, {} inliers of {} keypoints)", name(r.status), r.inliers,
                           r.keypoints);
      });

  py::class_<PythonSlam>(
      m, "Slam",
      "The semantic RGB-D SLAM system.\n\n"
      "of: the Camera of a Simulation, or a Sequence, whose calibration may hold settings. "
      "settings: a "
      "dict of full names ({'features.count': 500}; docs/reference/slam.md), or a file. Raises "
      "InputError.")
      .def(py::init([](const Camera& of, const py::object& settings, const std::string& vocabulary,
                       std::uint64_t seed) {
             return PythonSlam{make_slam(of, config_of(settings, {}), vocabulary_of(vocabulary)),
                               seed};
           }),
           py::arg("of"), py::arg("settings") = py::none(), py::arg("vocabulary") = "vocabulary",
           py::arg("seed") = 0)
      .def(py::init([](const Recording& of, const py::object& settings,
                       const std::string& vocabulary, std::uint64_t seed) {
             return PythonSlam{make_slam(of.frames->camera(), config_of(settings, of.slam),
                                         vocabulary_of(vocabulary)),
                               seed};
           }),
           py::arg("of"), py::arg("settings") = py::none(), py::arg("vocabulary") = "vocabulary",
           py::arg("seed") = 0)
      .def_static(
          "load",
          [](const std::filesystem::path& file, const std::string& vocabulary, std::uint64_t seed) {
            return PythonSlam{load_slam(file, vocabulary_of(vocabulary)), seed};
          },
          py::arg("file"), py::arg("vocabulary") = "vocabulary", py::arg("seed") = 0,
          "Loads a saved map file, to continue mapping or to localize in it.")
      .def("step", &PythonSlam::step, py::arg("frame"), py::call_guard<py::gil_scoped_release>(),
           "Tracks and maps the next Frame; its stamp must increase. Returns a Step.")
      .def("relocalize", &PythonSlam::relocalize, py::arg("frame"),
           py::call_guard<py::gil_scoped_release>(),
           "Localizes a Frame in the map as a lost system does; the map stays as it is. Returns a "
           "Step.")
      .def(
          "rewind",
          [](PythonSlam& s) {
            const auto lock = locked(s);
            rewind(s.state);
          },
          "The input jumps back in time: tracking is lost, the map is kept.")
      .def(
          "save",
          [](const PythonSlam& s, const std::filesystem::path& f) {
            const auto lock = locked(s);
            save_slam(f, s.state);
          },
          py::arg("file"), "Writes a map file.")
      .def(
          "trajectory",
          [](const PythonSlam& s) {
            const auto lock = locked(s);
            return trajectory(s.state);
          },
          "Each tracked frame once, with its pose in the map as it is now.")
      .def_property_readonly(
          "landmarks", [](const PythonSlam& s) { return landmarks(s, false); }, "(N, 3) m, world")
      .def_property_readonly(
          "landmark_labels", [](const PythonSlam& s) { return landmarks(s, true); },
          "(N,) class ids of the landmarks, 0 if unknown")
      .def_property_readonly(
          "keyframes", [](const PythonSlam& s) { return keyframes(s); },
          "Poses of the keyframes, a Trajectory");
}

}  // namespace mh::python
