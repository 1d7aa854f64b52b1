// SPDX-License-Identifier: Apache-2.0
#include "python/bind.hpp"

PYBIND11_MODULE(_core, m) {
  m.doc() = "Modelhouse: simulator, recordings, SLAM and its equations.";
  mh::python::bind_core(m);
  mh::python::bind_simulation(m);
  mh::python::bind_slam(m);
  mh::python::bind_semantics(m);
}
