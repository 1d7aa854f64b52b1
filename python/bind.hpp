// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "slam/config/slam.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"
#include "slam/core/sequence.hpp"
#include "slam/core/trajectory.hpp"

// What the parts of the Python module have in common. In Python, poses are 4 x 4 arrays, images are
// views of our memory, stamps are integers in nanoseconds.

PYBIND11_MAKE_OPAQUE(std::vector<mh::TimedPose>)  // a class of its own

namespace mh::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// A read-only view of an image, whose memory `owner` keeps alive.
template <class T>
py::array view_of(const Grid2d<T>& grid, py::handle owner) {
  const auto h = grid.height(), w = grid.width();
  py::array view;
  if constexpr (std::is_same_v<T, Rgb8>)
    view = py::array_t<std::uint8_t>(std::vector<py::ssize_t>{h, w, 3},
                                     reinterpret_cast<const std::uint8_t*>(grid.data()), owner);
  else
    view = py::array_t<T>(std::vector<py::ssize_t>{h, w}, grid.data(), owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

/// A read-only view that takes over the image and keeps it alive.
template <class T>
py::array array_of(Grid2d<T> grid) {
  auto held = std::make_unique<Grid2d<T>>(std::move(grid));
  const Grid2d<T>& image = *held;
  const py::capsule owner(held.release(), [](void* p) { delete static_cast<Grid2d<T>*>(p); });
  return view_of(image, owner);
}

/// Copies an array to a grid. @throws py::value_error naming the argument, its number of dimensions
/// and the shape that was expected
template <class T>
Grid2d<T> grid_of(const Array<T>& image, const char* what) {
  if (image.ndim() != 2)
    throw py::value_error(std::string(what) + ": expected (H, W), got " +
                          std::to_string(image.ndim()) + " dimensions");
  Grid2d<T> grid(static_cast<int>(image.shape(1)), static_cast<int>(image.shape(0)));
  std::copy_n(image.data(), image.size(), grid.data());
  return grid;
}
Grid2d<Rgb8> color_of(const Array<std::uint8_t>& image);

/// Converts a list or an array with numpy. @throws py::value_error if numpy cannot convert it
inline py::array array_of_numbers(const py::object& object, const char* what) {
  py::array array = py::array::ensure(object);
  if (!array) throw py::value_error(std::string(what) + ": is not an array");
  return array;
}

/// Largest accepted coordinate of a place, and largest accepted distance of a pose from the origin.
inline constexpr double kFarthest_m = 1e6;

/// 4 x 4.
Array<double> to_python(const SE3& pose);
py::object to_python(const std::optional<SE3>& pose);
/// @throws py::value_error unless it is 4 x 4, finite and rigid
SE3 to_pose(const Array<double>& matrix);
inline Array<double> rows_of(const std::vector<std::vector<double>>& rows, py::ssize_t columns) {
  Array<double> all(std::vector<py::ssize_t>{static_cast<py::ssize_t>(rows.size()), columns});
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy(rows[i].begin(), rows[i].end(), all.mutable_data(static_cast<py::ssize_t>(i), 0));
  return all;
}

/// A recording, with the settings in its calibration and the notes from opening it.
struct Recording {
  std::shared_ptr<const Sequence> frames;
  SlamConfig slam;
  std::vector<std::string> notes;
};

void bind_core(py::module_& m);
void bind_simulation(py::module_& m);
void bind_slam(py::module_& m);
void bind_semantics(py::module_& m);

}  // namespace mh::python
