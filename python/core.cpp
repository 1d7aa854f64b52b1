// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include "bench/protocol/metrics/evaluate.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "bench/suite/shipped.hpp"
#include "python/bind.hpp"
#include "scenes/recordings/class_map.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/core/labels.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/features/undistort.hpp"
#include "slam/io/error.hpp"

namespace mh::python {

Grid2d<Rgb8> color_of(const Array<std::uint8_t>& image) {
  if (image.ndim() != 3 || image.shape(2) != 3) throw py::value_error("color: expected (H, W, 3)");
  Grid2d<Rgb8> color(static_cast<int>(image.shape(1)), static_cast<int>(image.shape(0)));
  std::memcpy(color.data(), image.data(), static_cast<std::size_t>(image.size()));
  return color;
}

Array<double> to_python(const SE3& pose) {
  Array<double> matrix(std::vector<py::ssize_t>{4, 4});
  auto m = matrix.mutable_unchecked<2>();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m(i, j) = pose.rotation()(i, j);
    m(i, 3) = pose.translation()(i);
    m(3, i) = 0;
  }
  m(3, 3) = 1;
  return matrix;
}

py::object to_python(const std::optional<SE3>& pose) {
  return pose ? py::object(to_python(*pose)) : py::none();
}

SE3 to_pose(const Array<double>& matrix) {
  if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
    throw py::value_error("a pose is a 4 x 4 matrix");
  const auto m = matrix.unchecked<2>();
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation_m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation(i, j) = m(i, j);
    translation_m(i) = m(i, 3);
  }
  constexpr double kRound = 1e-4;
  if (!(translation_m.norm() <= kFarthest_m))
    throw py::value_error(fmt::format("a pose is not within {:g} m", kFarthest_m));
  if (m(3, 0) != 0 || m(3, 1) != 0 || m(3, 2) != 0 || m(3, 3) != 1)
    throw py::value_error("not a rigid pose: its last row is not 0 0 0 1");
  if (!translation_m.allFinite() || !rotation.allFinite() ||
      (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm() > kRound ||
      rotation.determinant() < 0)
    throw py::value_error("not a rigid pose: its rotation is not valid, or a number is not finite");
  return {rotation, translation_m};
}

namespace {

py::object stamps_of_poses(const Trajectory& poses) {
  Array<std::int64_t> stamps(static_cast<py::ssize_t>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i) stamps.mutable_data()[i] = poses[i].stamp_ns;
  return stamps;
}

py::object poses_of(const Trajectory& poses) {
  Array<double> all(std::vector<py::ssize_t>{static_cast<py::ssize_t>(poses.size()), 4, 4});
  for (std::size_t i = 0; i < poses.size(); ++i)
    std::copy_n(to_python(poses[i].world_from_camera).data(), 16,
                all.mutable_data(static_cast<py::ssize_t>(i), 0, 0));
  return all;
}

Trajectory make_trajectory(const Array<std::int64_t>& stamps_ns, const Array<double>& poses) {
  if (poses.ndim() != 3 || poses.shape(1) != 4 || poses.shape(2) != 4 || stamps_ns.ndim() != 1 ||
      poses.shape(0) != stamps_ns.shape(0))
    throw py::value_error("expected stamps (N,) and poses (N, 4, 4)");
  Trajectory made;
  for (py::ssize_t i = 0; i < stamps_ns.size(); ++i) {
    Array<double> one(std::vector<py::ssize_t>{4, 4}, poses.data(i, 0, 0));
    if (i > 0 && stamps_ns.data()[i] <= made.back().stamp_ns)
      throw py::value_error("stamps must increase");
    made.push_back({stamps_ns.data()[i], to_pose(one)});
  }
  return made;
}

Recording open_recording(const std::string& source, const std::string& settings, bool labels,
                         const std::string& topics) {
  Settings read;
  const RecordingConfig config =
      with_settings({.calibration = settings.empty() ? std::filesystem::path()
                                                     : find_shipped(settings, Shipped::kSettings),
                     .classes = {},
                     .labels = labels,
                     .topics = topics},
                    &read);
  OpenedRecording opened = open_sequence(source, config);
  require_undistortable(opened.sequence->camera());
  std::vector<std::string> notes = std::move(read.notes);
  notes.insert(notes.end(), opened.notes.begin(), opened.notes.end());
  return {std::move(opened.sequence), read.slam, std::move(notes)};
}

RgbdFrame frame_at(const Recording& recording, py::ssize_t i) {
  const auto size = static_cast<py::ssize_t>(recording.frames->size());
  if (i < -size || i >= size) throw py::index_error(fmt::format("frame {} of {}", i, size));
  const auto at = static_cast<std::size_t>(i < 0 ? i + size : i);
  const py::gil_scoped_release others_run;
  return recording.frames->frame(at, RandomStream(0).fork(at));
}

/// @throws py::value_error unless the image's numbers are of one of these kinds ("u", "i", "f"):
/// numbers of other kinds would be converted to something that was not meant
void require_kind(const py::array& image, const std::string& kinds, const char* what,
                  const char* expected) {
  if (kinds.find(image.dtype().kind()) == std::string::npos)
    throw py::value_error(fmt::format("{}: expected {}, got {}", what, expected,
                                      py::str(image.dtype()).cast<std::string>()));
}

RgbdFrame make_frame(const py::object& colors, const py::object& depths, Stamp stamp_ns,
                     const py::object& classes_of_pixels,
                     const std::optional<Array<double>>& odometry) {
  const py::array color = array_of_numbers(colors, "color"),
                  depth = array_of_numbers(depths, "depth");
  require_kind(color, "u", "color", "uint8");
  if (color.itemsize() != 1) throw py::value_error("color: expected uint8");
  require_kind(depth, "f", "depth", "meters as floating-point numbers");
  RgbdFrame frame{.stamp_ns = stamp_ns,
                  .color = color_of(Array<std::uint8_t>(color)),
                  .depth_m = grid_of(Array<float>(depth), "depth"),
                  .semantics = {}};
  for (const float depth_m : frame.depth_m)
    if (!(depth_m >= 0 && std::isfinite(depth_m)))
      throw py::value_error("depth: a value is negative or not finite (no return is 0)");
  const auto same_size = [&](int w, int h, const char* what) {
    if (w != frame.color.width() || h != frame.color.height())
      throw py::value_error(fmt::format("{} is {} x {}, color {} x {}", what, w, h,
                                        frame.color.width(), frame.color.height()));
  };
  same_size(frame.depth_m.width(), frame.depth_m.height(), "depth");
  if (!classes_of_pixels.is_none()) {
    const py::array labels = array_of_numbers(classes_of_pixels, "labels");
    require_kind(labels, "ui", "labels", "integers");
    const Grid2d<std::int64_t> given = grid_of(Array<std::int64_t>(labels), "labels");
    same_size(given.width(), given.height(), "labels");
    Grid2d<std::uint16_t> ids(given.width(), given.height());
    for (int y = 0; y < given.height(); ++y)
      for (int x = 0; x < given.width(); ++x) {
        if (given(x, y) < 0 || static_cast<std::size_t>(given(x, y)) >= classes().size())
          throw py::value_error(fmt::format("labels: {} is not a class", given(x, y)));
        ids(x, y) = static_cast<std::uint16_t>(given(x, y));
      }
    frame.semantics = one_hot(ids, nullptr);
  }
  if (odometry) frame.odom_from_camera = to_pose(*odometry);
  return frame;
}

Array<double> imu_rows(const std::vector<ImuReading>& readings) {
  std::vector<std::vector<double>> rows;
  for (const ImuReading& r : readings) {
    const auto &w = r.turn_rad_per_s, &a = r.specific_force_m_per_s2;
    rows.push_back(
        {1e-9 * static_cast<double>(r.stamp_ns), w.x(), w.y(), w.z(), a.x(), a.y(), a.z()});
  }
  return rows_of(rows, 7);
}

py::dict statistics(const ErrorStatistics& e) {
  py::dict d;
  d["rmse"] = e.rmse, d["mean"] = e.mean, d["median"] = e.median, d["std"] = e.std;
  d["min"] = e.min, d["max"] = e.max, d["count"] = e.count;
  return d;
}

py::dict evaluate_paths(const Trajectory& truth, const Trajectory& estimate,
                        const std::string& align) {
  EvaluationOptions options;
  constexpr std::pair<const char*, Alignment> kWords[] = {{"none", Alignment::kNone},
                                                          {"origin", Alignment::kOrigin},
                                                          {"se3", Alignment::kSe3},
                                                          {"sim3", Alignment::kSim3}};
  const auto* word = std::ranges::find_if(kWords, [&](const auto& w) { return align == w.first; });
  if (word == std::end(kWords))
    throw py::value_error(fmt::format("align='{}' is not one of none, origin, se3, sim3", align));
  options.alignment = word->second;
  const Evaluation e = evaluate(truth, estimate, options);
  if (e.pairs == 0) throw py::value_error("no pose of the estimate is within 10 ms of a true one");
  if (e.ape_translation_m.count == 0 || !std::isfinite(e.ape_translation_m.rmse))
    throw py::value_error(fmt::format(
        "the alignment '{}' is undetermined: fewer than three poses, all on a line, or no numbers",
        align));
  py::dict d;
  d["pairs"] = e.pairs;
  d["ate_m"] = statistics(e.ape_translation_m);
  d["ate_deg"] = statistics(e.ape_rotation_deg);
  for (const RelativeScore& r : e.rpe) {
    const char* per = r.delta.unit == DeltaUnit::kFrames ? "frame" : "s";
    d[fmt::format("rpe_{}_m", per).c_str()] = statistics(r.translation_m);
    d[fmt::format("rpe_{}_deg", per).c_str()] = statistics(r.rotation_deg);
  }
  if (e.truth_from_estimate) {
    const Similarity& s = *e.truth_from_estimate;
    d["truth_from_estimate"] = to_python(SE3(s.rotation, s.translation_m));
    d["scale"] = s.scale;
  }
  return d;
}

}  // namespace

void bind_core(py::module_& m) {
  py::register_exception<InputError>(m, "InputError", PyExc_ValueError);
  py::register_exception<MachineError>(m, "MachineError", PyExc_RuntimeError);

  py::class_<Camera>(m, "Camera", "A pinhole RGB-D camera; pixel centers at integers.")
      .def(py::init([](int width, int height, double fx, double fy, double cx, double cy,
                       const std::vector<double>& distortion, double fps, double baseline_m) {
             Camera c;
             c.width_px = width, c.height_px = height;
             c.fx_px = fx, c.fy_px = fy, c.cx_px = cx, c.cy_px = cy;
             if (distortion.size() > 8 ||
                 !std::ranges::all_of(distortion, [](double k) { return std::isfinite(k); }))
               throw py::value_error("distortion: expected at most 8 finite numbers");
             c.distortion = distortion_of(distortion);
             c.rate_hz = fps, c.baseline_m = baseline_m;
             validate(c);
             return c;
           }),
           py::arg("width"), py::arg("height"), py::arg("fx"), py::arg("fy"), py::arg("cx"),
           py::arg("cy"), py::arg("distortion") = std::vector<double>{}, py::arg("fps") = 30.0,
           py::arg("baseline_m") = 0.075)
      .def_readonly("width", &Camera::width_px, "px")
      .def_readonly("height", &Camera::height_px, "px")
      .def_readonly("fx", &Camera::fx_px, "px")
      .def_readonly("fy", &Camera::fy_px, "px")
      .def_readonly("cx", &Camera::cx_px, "px")
      .def_readonly("cy", &Camera::cy_px, "px")
      .def_readonly("fps", &Camera::rate_hz, "frames per second")
      .def_readonly("baseline_m", &Camera::baseline_m, "of the depth sensor's triangulation")
      .def_property_readonly(
          "distortion", [](const Camera& c) { return coefficients_of(c.distortion); },
          "k1 k2 p1 p2 k3, and k4 k5 k6 if they are not 0, as in OpenCV")
      .def("__repr__", [](const Camera& c) {
        return fmt::format("Camera({}, {}, fx={:.6g}, fy={:.6g}, cx={:.6g}, cy={:.6g}, fps={:g})",
                           c.width_px, c.height_px, c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.rate_hz);
      });

  py::class_<LaserScan>(m, "LaserScan", "A planar laser scan.")
      .def_readonly("name", &LaserScan::name, "name of the laser")
      .def_property_readonly(
          "camera_from_laser", [](const LaserScan& s) { return to_python(s.camera_from_laser); },
          "4 x 4, at the frame's stamp")
      .def_property_readonly(
          "angles",
          [](const LaserScan& s) {
            Array<double> angles(static_cast<py::ssize_t>(s.ranges_m.size()));
            for (std::size_t k = 0; k < s.ranges_m.size(); ++k)
              angles.mutable_data()[k] = s.first_rad + static_cast<double>(k) * s.step_rad;
            return angles;
          },
          "(N,) rad about the laser's z, from its x")
      .def_property_readonly(
          "ranges",
          [](const LaserScan& s) {
            return Array<float>(static_cast<py::ssize_t>(s.ranges_m.size()), s.ranges_m.data());
          },
          "(N,) m; 0 where nothing is in range");

  py::class_<RgbdFrame, std::shared_ptr<RgbdFrame>>(
      m, "Frame", "Everything that SLAM sees at one time. Images are read-only views.")
      .def(py::init(&make_frame), py::arg("color"), py::arg("depth"), py::arg("stamp_ns") = 0,
           py::arg("labels") = py::none(), py::arg("odometry") = py::none())
      .def_readonly("stamp_ns", &RgbdFrame::stamp_ns, "ns")
      .def_property_readonly(
          "color", [](py::object self) { return view_of(self.cast<RgbdFrame&>().color, self); },
          "(H, W, 3) uint8, red green blue")
      .def_property_readonly(
          "depth", [](py::object self) { return view_of(self.cast<RgbdFrame&>().depth_m, self); },
          "(H, W) float32, m along the optical axis; 0 where there is no return")
      .def_property_readonly(
          "labels",
          [](const RgbdFrame& f) -> py::object {
            if (f.semantics.index.empty()) return py::none();
            return array_of(class_image(f.semantics));
          },
          "(H, W) uint8, the most probable class of each pixel, 0 if unknown; None without labels")
      .def_property_readonly(
          "odometry", [](const RgbdFrame& f) { return to_python(f.odom_from_camera); },
          "4 x 4, where the wheels alone place the camera; None without odometry")
      .def_property_readonly(
          "imu", [](const RgbdFrame& f) { return imu_rows(f.imu); },
          "(N, 7): stamp (s), angular rate (rad/s), specific force (m/s^2), camera axes")
      .def_readonly("lasers", &RgbdFrame::lasers, "list of LaserScan");

  py::class_<Trajectory>(m, "Trajectory", "Camera poses in order of their stamps.")
      .def(py::init(&make_trajectory), py::arg("stamps_ns"), py::arg("poses"))
      .def("__len__", [](const Trajectory& t) { return t.size(); })
      .def_property_readonly("stamps_ns", &stamps_of_poses, "(N,) int64")
      .def_property_readonly("poses", &poses_of, "(N, 4, 4) world_from_camera")
      .def_property_readonly(
          "positions",
          [](const Trajectory& t) {
            std::vector<std::vector<double>> rows;
            for (const TimedPose& p : t) {
              const Eigen::Vector3d& at = p.world_from_camera.translation();
              rows.push_back({at.x(), at.y(), at.z()});
            }
            return rows_of(rows, 3);
          },
          "(N, 3) m, world")
      .def(
          "write", [](const Trajectory& t, const std::filesystem::path& f) { write_tum(f, t); },
          py::arg("file"), "Writes TUM's format.");
  m.def(
      "read_trajectory", [](const std::filesystem::path& f) { return read_trajectory(f); },
      py::arg("file"),
      "Reads a trajectory in TUM's or EuRoC's format (docs/formats.md). Raises InputError.");
  m.def("evaluate", &evaluate_paths, py::arg("truth"), py::arg("estimate"),
        py::arg("align") = "se3",
        "Errors of an estimate as evo defines them: a dict of `pairs`, `ate_m`, `ate_deg`, "
        "`rpe_frame_m`, `rpe_s_m` and so on, each with rmse, mean, median, std, min, max, count.\n"
        "align: none, origin, se3 or sim3. Poses are paired within 10 ms.");

  py::class_<Recording>(m, "Sequence", "A recording; frames are read on demand.")
      .def("__len__", [](const Recording& r) { return r.frames->size(); })
      .def("__getitem__", &frame_at, py::arg("index"))
      .def_property_readonly(
          "camera", [](const Recording& r) { return r.frames->camera(); }, "Its Camera")
      .def_property_readonly(
          "stamps_ns",
          [](const Recording& r) {
            const std::vector<Stamp> all = stamps_of(*r.frames);
            return Array<std::int64_t>(static_cast<py::ssize_t>(all.size()), all.data());
          },
          "(N,) int64")
      .def_property_readonly(
          "truth",
          [](const Recording& r) -> std::optional<Trajectory> {
            return r.frames->truth() ? std::optional(*r.frames->truth()) : std::nullopt;
          },
          "True camera poses, a Trajectory; None if unknown")
      .def_readonly("notes", &Recording::notes, "One line about each thing that could not be used");
  m.def(
      "open_sequence", &open_recording, py::arg("source"), py::arg("settings") = "",
      py::arg("labels") = true, py::arg("topics") = "",
      "Opens a recording of any layout that `modelhouse slam` reads: 'tum:FOLDER', a bag, an MCAP "
      "file, ... (docs/recordings.md).\nsettings: a calibration file, or the name of a shipped "
      "one. Raises InputError naming file and place.");

  py::list classes_by_id;
  for (const ClassInfo& info : classes()) classes_by_id.append(std::string(info.name));
  m.attr("classes") = classes_by_id;
}

}  // namespace mh::python
