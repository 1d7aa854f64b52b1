// SPDX-License-Identifier: Apache-2.0
#pragma once

// Serialization of a map and its parts. One list of fields per type serves both directions; its
// structured binding names every field, so a newly added field that is missing here does not
// compile.

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/core/ids.hpp"
#include "slam/core/se3.hpp"
#include "slam/io/fields.hpp"
#include "slam/map/map.hpp"

namespace mh::archive {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they lie");

template <class T>
concept Number = std::is_arithmetic_v<T>;
/// Appends values to a byte string.
class Writer {
 public:
  static constexpr bool kReads = false;
  void bytes(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string take() { return std::move(bytes_); }

  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      put(static_cast<std::uint8_t>(value));
    } else if constexpr (Number<T> || std::is_same_v<T, Descriptor>) {
      bytes(&value, sizeof value);
    } else if constexpr (kIsVector<T> || std::is_same_v<T, std::string> ||
                         std::is_same_v<T, LandmarkTable>) {
      put(static_cast<std::uint64_t>(value.size()));
      for (const auto& element : value) put(element);
    } else if constexpr (kIsArray<T>) {
      for (const auto& element : value) put(element);
    } else if constexpr (kIsOptional<T>) {
      put(value.has_value());
      if (value) put(*value);
    } else {
      fields(*this, value);
    }
  }

  std::string bytes_;
};

/// Takes values from the front of a byte string. @throws InputError naming the file if it ends too
/// soon or a value is impossible.
class Reader {
 public:
  static constexpr bool kReads = true;
  Reader(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}
  bool at_end() const { return bytes_.empty(); }
  [[noreturn]] void fail(std::string_view what) const;
  void require(bool good, std::string_view what) const {
    if (!good) fail(what);
  }

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }

 private:
  void bytes(void* data, std::size_t size);

  template <class T>
  void get(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      get(byte);
      require(byte <= 1, "a boolean is neither 0 nor 1");
      value = byte == 1;
    } else if constexpr (Number<T> || std::is_same_v<T, Descriptor>) {
      bytes(&value, sizeof value);
      if constexpr (std::is_floating_point_v<T>)
        require(std::isfinite(value), "a number is not finite");
    } else if constexpr (kIsVector<T> || std::is_same_v<T, std::string>) {
      std::uint64_t size = 0;
      get(size);
      // Read one by one: if the size is wrong, the bytes run out before the memory does.
      value.clear();
      for (std::uint64_t i = 0; i < size; ++i) {
        typename T::value_type element{};
        get(element);
        value.push_back(std::move(element));
      }
      value.shrink_to_fit();
    } else if constexpr (kIsArray<T>) {
      for (auto& element : value) get(element);
    } else if constexpr (kIsOptional<T>) {
      bool there = false;
      get(there);
      if (there) get(value.emplace());
    } else {
      fields(*this, value);
    }
  }

  std::string_view bytes_;
  std::string name_;
};

template <class A, class Tag>
void fields(A& a, Id<Tag>& id) {
  a(id.value);
}
template <class A, class Tag>
void fields(A& a, const Id<Tag>& id) {
  a(id.value);
}
template <class A, MaybeConst<Eigen::Vector3d> T>
void fields(A& a, T& v) {
  a(v.x(), v.y(), v.z());
}
/// The elements of a matrix, row by row.
template <class A, class M>
void elements(A& a, M& m) {
  for (Eigen::Index i = 0; i < m.size(); ++i) a(m(i / m.cols(), i % m.cols()));
}
template <class A, MaybeConst<Matrix6d> T>
void fields(A& a, T& m) {
  elements(a, m);
}
template <class A, MaybeConst<Vector6d> T>
void fields(A& a, T& v) {
  for (int i = 0; i < 6; ++i) a(v[i]);
}
template <class A, MaybeConst<SE3> T>
void fields(A& a, T& pose) {
  Eigen::Matrix3d rotation = pose.rotation();
  Eigen::Vector3d translation = pose.translation();
  for (int i = 0; i < 9; ++i) a(rotation.data()[i]);
  a(translation);
  if constexpr (A::kReads) {
    const Eigen::Matrix3d off = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
    // This limit is far above the error that products of rotations accumulate, and far below that
    // of anything that is not a rotation.
    a.require(off.norm() < 1e-3 && rotation.determinant() > 0, "not a rotation");
    pose = SE3(rotation, translation);
  }
}
template <class A, MaybeConst<std::pair<std::uint32_t, std::uint32_t>> T>
void fields(A& a, T& pair) {
  a(pair.first, pair.second);
}
template <class A, MaybeConst<Keypoint> T>
void fields(A& a, T& keypoint) {
  auto& [u_px, v_px, depth_m, angle_rad, octave, label] = keypoint;
  a(u_px, v_px, depth_m, angle_rad, octave, label);
}
template <class A, MaybeConst<Features> T>
void fields(A& a, T& features) {
  auto& [keypoints, descriptors] = features;
  a(keypoints, descriptors);
  if constexpr (A::kReads)
    a.require(keypoints.size() == descriptors.size(), "keypoints and descriptors differ in number");
}
template <class A, MaybeConst<WeightedMember> T>
void fields(A& a, T& member) {
  auto& [id, weight] = member;
  a(id, weight);
}
template <class A, MaybeConst<AugmentedVector> T>
void fields(A& a, T& vector) {
  auto& [labels, words] = vector;
  a(labels, words);
}
template <class A, MaybeConst<WordIndex> T>
void fields(A& a, T& index) {
  auto& [vector, by_node] = index;
  a(vector, by_node);
}
template <class A, MaybeConst<Keyframe::Neighbor> T>
void fields(A& a, T& neighbor) {
  auto& [id, shared] = neighbor;
  a(id, shared);
}
template <class A, MaybeConst<Keyframe> T>
void fields(A& a, T& keyframe) {
  // The grid is rebuilt from the keypoints.
  auto& [id, origin, stamp_ns, camera_from_world, features, grid, words, landmarks, covisible,
         erased, odom_from_camera, parent, camera_from_parent] = keyframe;
  a(id, origin, stamp_ns, camera_from_world, features, words, landmarks, covisible, erased,
    odom_from_camera, parent, camera_from_parent);
}
template <class A, MaybeConst<Observation> T>
void fields(A& a, T& observation) {
  auto& [keyframe, feature] = observation;
  a(keyframe, feature);
}
template <class A, MaybeConst<Landmark> T>
void fields(A& a, T& landmark) {
  auto& [position_in_world, mean_direction, min_distance_m, max_distance_m, id, label, erased,
         described, descriptor, observations, first_keyframe, visible, found] = landmark;
  a(erased);
  if (erased) return;
  a(id, position_in_world, observations, descriptor, label, mean_direction, min_distance_m,
    max_distance_m, first_keyframe, visible, found);
}
template <class A, MaybeConst<Distortion> T>
void fields(A& a, T& distortion) {
  auto& [k1, k2, p1, p2, k3, k4, k5, k6] = distortion;
  a(k1, k2, p1, p2, k3, k4, k5, k6);
}
template <class A, MaybeConst<Camera> T>
void fields(A& a, T& camera) {
  auto& [width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion, rate_hz, baseline_m,
         disparity_sigma_px, disparity_sigma_is_given] = camera;
  a(width_px, height_px, fx_px, fy_px, cx_px, cy_px, distortion, rate_hz, baseline_m,
    disparity_sigma_px, disparity_sigma_is_given);
}

/// Writes the map itself.
void write_map(Writer& writer, const Map& map);
/// Reads a map.
/// @param levels  pyramid levels of its keypoints.
/// @param words  number of words in the vocabulary.
/// @throws InputError if the bytes are not a consistent map.
Map read_map(Reader& reader, const Camera& camera, int levels, std::size_t words);

}  // namespace mh::archive
