// SPDX-License-Identifier: Apache-2.0
#pragma once

// Serialization of a scene. One list of fields per type serves both for writing and for reading;
// its structured binding names every field, so the code does not compile if a newly added field is
// missing here.

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenes/scene.hpp"

namespace mh::scene_fields {

template <class T, class U>
concept MaybeConst = std::same_as<std::remove_const_t<T>, U>;

template <class Archive, MaybeConst<Material> T>
void fields(Archive& archive, T& material) {
  auto& [name, base_color, texture, opacity, tile_m, emission, transmission] = material;
  archive(name, base_color, texture, opacity, tile_m, emission, transmission);
}

template <class Archive, MaybeConst<Instance> T>
void fields(Archive& archive, T& instance) {
  auto& [id, class_id, name, min_m, max_m] = instance;
  archive(id, class_id, name, min_m, max_m);
}

template <class Archive, MaybeConst<Light> T>
void fields(Archive& archive, T& light) {
  auto& [kind, position_m, direction, radius_m, angular_radius_rad, color] = light;
  archive(kind, position_m, direction, radius_m, angular_radius_rad, color);
}

template <class Archive, MaybeConst<Room> T>
void fields(Archive& archive, T& room) {
  auto& [name, polygon_m, is_box] = room;
  archive(name, polygon_m, is_box);
}

template <class Archive, MaybeConst<Floor> T>
void fields(Archive& archive, T& floor) {
  auto& [middle_m, up, rough_m, area_m2] = floor;
  archive(middle_m, up, rough_m, area_m2);
}

template <class Archive, MaybeConst<Scene> T>
void fields(Archive& archive, T& scene) {
  auto& [name, positions_m, uvs, colors, light, triangles, material_of, class_of, instance_of,
         materials, instances, lights, rooms, floor] = scene;
  archive(name, positions_m, uvs, colors, light, triangles, material_of, class_of, instance_of,
          materials, instances, lights, rooms, floor);
}

/// Types that are stored as they are in memory; Eigen's vectors are not trivial types, but hold
/// plain numbers.
template <class T>
inline constexpr bool kPlain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;
template <class T, int N>
inline constexpr bool kPlain<Eigen::Matrix<T, N, 1>> = N > 0;

template <class T>
concept Sequence = requires(T items) {
  items.resize(std::size_t{1});
  items.data();
};

template <class T>
inline constexpr bool kIsGrid = false;
template <class T>
inline constexpr bool kIsGrid<Grid2d<T>> = true;

/// Shared images are sent once, in the order of first use.
template <class T>
inline constexpr bool kIsShared = false;
template <class T>
inline constexpr bool kIsShared<SharedGrid<T>> = true;
using KnownImages =
    std::tuple<std::vector<SharedGrid<Rgb8>>, std::vector<SharedGrid<std::uint8_t>>>;

/// Writes values to anything that has bytes(const void*, size).
template <class Out>
class Sender {
 public:
  explicit Sender(Out& out) : out_(out) {}

  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (kPlain<T>) {
      out_.bytes(&value, sizeof value);
    } else if constexpr (kIsShared<T>) {
      auto& known = std::get<std::vector<T>>(images_);
      const auto place = std::ranges::find(known, value.identity(), &T::identity);
      put(static_cast<std::uint64_t>(place - known.begin()));
      if (place != known.end()) return;
      known.push_back(value);
      put(value.grid());
    } else if constexpr (kIsGrid<T>) {
      (*this)(value.width(), value.height());
      out_.bytes(value.data(), value.size() * sizeof *value.data());
    } else if constexpr (Sequence<T>) {
      put(std::uint64_t{value.size()});
      if constexpr (kPlain<typename T::value_type>)
        out_.bytes(value.data(), value.size() * sizeof(typename T::value_type));
      else
        for (const auto& item : value) put(item);
    } else {
      fields(*this, value);
    }
  }

  Out& out_;
  KnownImages images_;
};

/// Reads values from anything that has bytes(void*, size), directly into their destination.
template <class In>
class Receiver {
 public:
  explicit Receiver(In& in) : in_(in) {}

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }

 private:
  template <class T>
  void get(T& value) {
    if constexpr (kPlain<T>) {
      in_.bytes(&value, sizeof value);
    } else if constexpr (kIsShared<T>) {
      auto& known = std::get<std::vector<T>>(images_);
      std::uint64_t place = 0;
      get(place);
      if (place >= known.size()) {
        std::remove_cvref_t<decltype(value.grid())> grid;
        get(grid);
        known.emplace_back(std::move(grid));
        place = known.size() - 1;
      }
      value = known[place];
    } else if constexpr (kIsGrid<T>) {
      int width = 0, height = 0;
      (*this)(width, height);
      value = T(width, height, Unfilled{});
      in_.bytes(value.data(), value.size() * sizeof *value.data());
    } else if constexpr (Sequence<T>) {
      std::uint64_t size = 0;
      get(size);
      value.resize(size);
      if constexpr (kPlain<typename T::value_type>)
        in_.bytes(value.data(), size * sizeof(typename T::value_type));
      else
        for (auto& item : value) get(item);
    } else {
      fields(*this, value);
    }
  }

  In& in_;
  KnownImages images_;
};

}  // namespace mh::scene_fields
