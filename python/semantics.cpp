// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <span>

#include <fmt/format.h>

#include "python/bind.hpp"
#include "slam/semantics/augmented_vector.hpp"
#include "slam/semantics/candidate_selection.hpp"
#include "slam/semantics/descriptor_distance.hpp"

namespace mh::python {
namespace {

/// Ids of labels or words. @throws py::value_error unless they are integers from 0 to 2^32 - 1
class Ids {
 public:
  Ids(const py::object& object, const char* what) {
    const py::array given = array_of_numbers(object, what);
    if (given.ndim() != 1) throw py::value_error(fmt::format("{}: expected (N,)", what));
    if (given.size() == 0) return;
    if (given.dtype().kind() != 'u' && given.dtype().kind() != 'i')
      throw py::value_error(fmt::format("{}: expected integers", what));
    const Array<std::int64_t> all(given);
    for (py::ssize_t i = 0; i < all.size(); ++i) {
      if (all.data()[i] < 0 || all.data()[i] > UINT32_MAX)
        throw py::value_error(fmt::format("{}: {} is not an id", what, all.data()[i]));
      ids_.push_back(static_cast<std::uint32_t>(all.data()[i]));
    }
  }
  operator std::span<const std::uint32_t>() const { return ids_; }
  std::uint32_t operator[](std::size_t i) const { return ids_[i]; }
  std::size_t size() const { return ids_.size(); }

 private:
  std::vector<std::uint32_t> ids_;
};

/// @throws py::value_error unless all numbers are finite and at least 0
void require_finite(const Array<double>& numbers, const char* what) {
  for (py::ssize_t i = 0; i < numbers.size(); ++i)
    if (!(numbers.data()[i] >= 0 && std::isfinite(numbers.data()[i])))
      throw py::value_error(
          fmt::format("{}: {} is negative or not finite", what, numbers.data()[i]));
}

VoidPolicy policy(bool void_is_a_label) {
  return void_is_a_label ? VoidPolicy::kIsALabel : VoidPolicy::kUnknown;
}

AugmentedVector make_vector(const py::object& labels, const py::object& words, double gamma,
                            const std::optional<Array<double>>& eta, bool void_is_a_label) {
  if (!(gamma >= 0 && gamma <= 1e6))
    throw py::value_error(fmt::format("gamma={}: not in 0 to 1e6", gamma));
  if (eta && eta->ndim() != 1) throw py::value_error("eta: expected (W,)");
  if (eta) require_finite(*eta, "eta");
  const auto weight = [&](std::uint32_t word) {
    if (!eta) return 1.0;
    if (word >= eta->size()) throw py::value_error(fmt::format("eta has no word {}", word));
    return eta->data()[word];
  };
  return augmented_vector(Ids(labels, "labels"), Ids(words, "words"), gamma, weight,
                          policy(void_is_a_label));
}

py::dict members(const std::vector<WeightedMember>& all) {
  py::dict d;
  for (const WeightedMember& member : all) d[py::int_(member.id)] = member.weight;
  return d;
}

py::array_t<float> distances(const Array<float>& distance, const py::object& labels_p,
                             const py::object& labels_q, float xi, bool void_is_a_label) {
  const Ids p(labels_p, "labels_p"), q(labels_q, "labels_q");
  const auto count = static_cast<std::size_t>(distance.size());
  if (!(xi >= 1)) throw py::value_error(fmt::format("xi={}: must be at least 1", xi));
  if (p.size() != count || q.size() != count)
    throw py::value_error("distances and labels differ in length");
  py::array_t<float> made(distance.size());
  for (std::size_t i = 0; i < count; ++i)
    made.mutable_data()[i] = semantic_distance(
        distance.data()[i], labels_disagree(p[i], q[i], policy(void_is_a_label)), xi);
  return made;
}

py::tuple select(const Array<int>& overlap, const std::vector<std::vector<int>>& neighbors,
                 const Array<double>& similarity, double alpha, double beta) {
  const auto count = static_cast<std::size_t>(overlap.size());
  if (neighbors.size() != count || static_cast<std::size_t>(similarity.size()) != count)
    throw py::value_error("overlap, neighbors and similarity differ in length");
  require_finite(similarity, "similarity");
  for (const double share : {alpha, beta})
    if (!(share >= 0 && share < 1))
      throw py::value_error(fmt::format("alpha and beta are in [0, 1), not {}", share));
  for (const auto& list : neighbors)
    for (const int k : list)
      if (k < 0 || static_cast<std::size_t>(k) >= count)
        throw py::value_error(fmt::format("a neighbor is keyframe {} of {}", k, count));
  std::vector<int> keyframes(count);
  for (std::size_t k = 0; k < count; ++k) keyframes[k] = static_cast<int>(k);
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  const auto made = select_candidates<int>(
      keyframes, [&](int k) { return overlap.data()[k]; },
      [&](int k) -> const std::vector<int>& { return neighbors[at(k)]; },
      [&](int k) { return similarity.data()[k]; }, alpha, beta);
  py::list candidates;
  for (const auto& candidate : made.candidates)
    candidates.append(py::make_tuple(candidate.keyframe, candidate.score));
  py::dict left;
  left["c1"] = made.c1, left["c2"] = made.c2, left["c3"] = made.c3;
  left["final"] = made.candidates.size();
  return py::make_tuple(candidates, left);
}

}  // namespace

void bind_semantics(py::module_& m) {
  py::module_ s = m.def_submodule("semantics", "Equations 1 to 6 of the paper on arrays.");
  py::class_<AugmentedVector>(s, "AugmentedVector", "Equation 1, L1-normalized.")
      .def_property_readonly(
          "labels", [](const AugmentedVector& v) { return members(v.labels); }, "id: share")
      .def_property_readonly(
          "words", [](const AugmentedVector& v) { return members(v.words); }, "id: share")
      .def_property_readonly("label_mass", &AugmentedVector::label_mass,
                             "share of the mass that comes from labels");
  s.def("augmented_vector", &make_vector, py::arg("labels"), py::arg("words"), py::arg("gamma"),
        py::arg("eta") = py::none(), py::arg("void_is_a_label") = false,
        "Equation 1 from one label and one word per keypoint, (N,) each. eta: factor of each word, "
        "(W,); None: all 1. Label 0 is void.");
  s.def("similarity", &l1_similarity, py::arg("f"), py::arg("k"),
        "1 - |f - k|_1 / 2, in [0, 1]: the paper's ||f, k||_1.");
  s.def("shared_labels", &shared_labels, py::arg("f"), py::arg("k"),
        "n of equation 3, over distinct labels.");
  s.def("shared_words", &shared_words, py::arg("f"), py::arg("k"),
        "n of equation 3, over distinct words.");
  s.def("distance", &distances, py::arg("distances"), py::arg("labels_p"), py::arg("labels_q"),
        py::arg("xi"), py::arg("void_is_a_label") = false,
        "Equation 2 over pairs, (N,) each: xi times the distance where labels disagree.");
  s.def("select_candidates", &select, py::arg("overlap"), py::arg("neighbors"),
        py::arg("similarity"), py::arg("alpha"), py::arg("beta"),
        "Equations 3 to 6 (Algorithm 1) over keyframes 0 to N - 1: overlap (N,) is n of equation "
        "3, neighbors lists each keyframe's neighborhood, itself included, similarity (N,) is that "
        "to the query. Returns [(keyframe, score), ...] and how many are left after each step: c1, "
        "c2, c3, final.");
}

}  // namespace mh::python
