// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include <fmt/format.h>
#include <sdf/Box.hh>
#include <sdf/Capsule.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Ellipsoid.hh>
#include <sdf/Plane.hh>
#include <sdf/Sphere.hh>

#include "scenes/mesh_builder.hpp"

namespace mh::gazebo {
namespace {

using Eigen::Vector3f;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kAround = 32, kDown = 16;  // facets of round bodies

Vector3f vector_of(const ignition::math::Vector3d& v) {
  return Eigen::Vector3d(v.X(), v.Y(), v.Z()).cast<float>();
}

/// Surfaces of one material; the texture covers each of them once.
class Shape {
 public:
  explicit Shape(const Material& look) {
    builder_.scene().materials.push_back(look);
    builder_.begin_instance("shape", kVoid);
  }

  void sheet(int nu, int nv, const std::function<Vector3f(float u, float v)>& point) {
    builder_.sheet(0, point, nu, nv, {1.0F, 1.0F});
  }
  void parallelogram(const Vector3f& middle, const Vector3f& right, const Vector3f& down) {
    sheet(1, 1, [=](float u, float v) -> Vector3f {
      return middle + (u - 0.5F) * right + (v - 0.5F) * down;
    });
  }
  void disc(const Vector3f& middle, float radius) {
    sheet(kAround, 1, [=](float u, float v) -> Vector3f {
      const float around = std::copysign(2.0F * kPi * u, middle.z());
      return middle + v * radius * Vector3f(std::cos(around), std::sin(around), 0.0F);
    });
  }
  Scene finish() { return builder_.finish(); }

 private:
  MeshBuilder builder_;
};

void add_box(Shape& shape, const Vector3f& size) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0F, 1.0F}) {
      const Vector3f out = side * Vector3f::Unit(axis);
      const Vector3f down = axis == 2 ? Vector3f(0, -1, 0) : Vector3f(0, 0, -1);
      const Vector3f right = out.cross(down);
      shape.parallelogram(0.5F * size.cwiseProduct(out), size.cwiseProduct(right),
                          size.cwiseProduct(down));
    }
}

void add_cylinder(Shape& shape, float radius, float length) {
  shape.sheet(kAround, 1, [=](float u, float v) {
    const float around = 2.0F * kPi * u;
    return Vector3f(radius * std::cos(around), radius * std::sin(around), (0.5F - v) * length);
  });
  for (const float z : {-0.5F * length, 0.5F * length}) shape.disc({0, 0, z}, radius);
}

/// A sphere scaled along its axes, or one whose halves are pulled apart by `length`.
void add_ball(Shape& shape, const Vector3f& radii, float length = 0.0F) {
  shape.sheet(kAround, kDown, [=](float u, float v) {
    const float around = 2.0F * kPi * u, down = kPi * v;
    const Vector3f on_sphere(std::sin(down) * std::cos(around), std::sin(down) * std::sin(around),
                             std::cos(down));
    return Vector3f(radii.cwiseProduct(on_sphere) +
                    Vector3f(0, 0, v < 0.5F ? 0.5F * length : -0.5F * length));
  });
}

void add_plane(Shape& shape, const sdf::Plane& plane) {
  const Eigen::Matrix3f turned =
      Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitZ(), vector_of(plane.Normal()))
          .toRotationMatrix();
  shape.parallelogram(Vector3f::Zero(), turned.col(0) * static_cast<float>(plane.Size().X()),
                      turned.col(1) * static_cast<float>(-plane.Size().Y()));
}

}  // namespace

std::optional<std::string> fault_of(const sdf::Geometry& geometry) {
  const auto fault = [](const char* shape,
                        std::initializer_list<double> numbers) -> std::optional<std::string> {
    const auto sound = [](double v) { return std::isfinite(v) && v > 0.0; };
    if (std::ranges::all_of(numbers, sound)) return std::nullopt;
    return fmt::format("a {} of {}: its dimensions must be above 0", shape,
                       fmt::join(numbers, " x "));
  };
  if (const auto* box = geometry.BoxShape())
    return fault("box", {box->Size().X(), box->Size().Y(), box->Size().Z()});
  if (const auto* capsule = geometry.CapsuleShape())
    return fault("capsule", {capsule->Radius(), capsule->Length()});
  if (const auto* cylinder = geometry.CylinderShape())
    return fault("cylinder", {cylinder->Radius(), cylinder->Length()});
  if (const auto* ellipsoid = geometry.EllipsoidShape())
    return fault("ellipsoid",
                 {ellipsoid->Radii().X(), ellipsoid->Radii().Y(), ellipsoid->Radii().Z()});
  if (const auto* sphere = geometry.SphereShape()) return fault("sphere", {sphere->Radius()});
  if (const auto* plane = geometry.PlaneShape())
    return fault("plane", {plane->Size().X(), plane->Size().Y()});
  return std::nullopt;
}

std::optional<Scene> shape_of(const sdf::Geometry& geometry, const Material& look) {
  Shape shape(look);
  if (const auto* box = geometry.BoxShape()) {
    add_box(shape, vector_of(box->Size()));
  } else if (const auto* capsule = geometry.CapsuleShape()) {
    add_ball(shape, Vector3f::Constant(static_cast<float>(capsule->Radius())),
             static_cast<float>(capsule->Length()));
  } else if (const auto* cylinder = geometry.CylinderShape()) {
    add_cylinder(shape, static_cast<float>(cylinder->Radius()),
                 static_cast<float>(cylinder->Length()));
  } else if (const auto* ellipsoid = geometry.EllipsoidShape()) {
    add_ball(shape, vector_of(ellipsoid->Radii()));
  } else if (const auto* sphere = geometry.SphereShape()) {
    add_ball(shape, Vector3f::Constant(static_cast<float>(sphere->Radius())));
  } else if (const auto* plane = geometry.PlaneShape()) {
    add_plane(shape, *plane);
  } else {
    return std::nullopt;
  }
  return shape.finish();
}

}  // namespace mh::gazebo
