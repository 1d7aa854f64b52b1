// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/planar_world.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <vector>

#include <btBulletDynamicsCommon.h>

namespace mh {
namespace {

constexpr float kBandBottom_m = 0.03F;  // lower things (rugs, thresholds) are driven over
// The cylinder reaches past the band of obstacles by this much at both ends, so that the shortest
// way out of any overlap is sideways, the only way a planar body can go.
constexpr float kOverhang_m = 1.0F;

using Polygon = std::vector<Eigen::Vector3f>;

/// The part of a convex polygon with sign * (z - height) >= 0 (Sutherland and Hodgman, 1974).
Polygon clip(const Polygon& polygon, float height_m, float sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3f& a = polygon[i];
    const Eigen::Vector3f& b = polygon[(i + 1) % polygon.size()];
    const float above_a = sign * (a.z() - height_m), above_b = sign * (b.z() - height_m);
    if (above_a >= 0) kept.push_back(a);
    if ((above_a > 0 && above_b < 0) || (above_a < 0 && above_b > 0))
      kept.push_back(a + (b - a) * (above_a / (above_a - above_b)));
  }
  return kept;
}

/// What can be run into: triangles, and for each of them the instance it belongs to.
struct Obstacles {
  btTriangleMesh mesh;
  std::vector<InstanceId> instance_of;
};

/// Triangles of the scene, cut to the band of heights in which they are obstacles.
std::unique_ptr<Obstacles> obstacles(const Scene& scene, float top_m) {
  auto result = std::make_unique<Obstacles>();
  const auto point = [](const Eigen::Vector3f& p) { return btVector3(p.x(), p.y(), p.z()); };
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    Polygon polygon;
    for (const std::uint32_t v : scene.triangles[face]) polygon.push_back(scene.positions_m[v]);
    const auto [low, high] = std::minmax({polygon[0].z(), polygon[1].z(), polygon[2].z()});
    if (high < kBandBottom_m || low > top_m) continue;
    if (low < kBandBottom_m) polygon = clip(polygon, kBandBottom_m, 1.0F);
    if (high > top_m) polygon = clip(polygon, top_m, -1.0F);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      result->mesh.addTriangle(point(polygon[0]), point(polygon[i - 1]), point(polygon[i]));
      result->instance_of.push_back(scene.instance_of[face]);
    }
  }
  return result;
}

double limited(double value, double limit) {
  return std::clamp(value, -limit, limit);
}

Eigen::Vector2d limited(const Eigen::Vector2d& v, double limit) {
  const double norm = v.norm();
  return norm > limit ? Eigen::Vector2d(v * (limit / norm)) : v;
}

}  // namespace

// Members are destroyed in reverse order: the world before what it refers to.
struct PlanarWorld::Impl {
  BaseLimits limits;
  double radius_m, height_m;
  double step_s;
  std::unique_ptr<Obstacles> obstacles_in_band;
  std::unique_ptr<btBvhTriangleMeshShape> house_shape;  // none if there is nothing to hit
  std::unique_ptr<btRigidBody> house;
  btCylinderShapeZ robot_shape;
  std::unique_ptr<btRigidBody> robot;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};

  Impl(const Scene& scene, const Robot& model, const Eigen::Vector2d& start_m, double heading_rad,
       double step)
      : limits(model.limits),
        radius_m(model.footprint_radius_m),
        height_m(model.height_m),
        step_s(step),
        obstacles_in_band(obstacles(scene, static_cast<float>(model.height_m))),
        robot_shape(btVector3(static_cast<btScalar>(model.footprint_radius_m),
                              static_cast<btScalar>(model.footprint_radius_m),
                              static_cast<btScalar>(0.5 * model.height_m) + kOverhang_m)) {
    world.setGravity(btVector3(0, 0, 0));
    add_house();
    add_robot(model, start_m, heading_rad);
  }

  ~Impl() {
    world.removeRigidBody(robot.get());
    if (house) world.removeRigidBody(house.get());
  }

  void add_house() {
    if (obstacles_in_band->instance_of.empty()) return;
    house_shape = std::make_unique<btBvhTriangleMeshShape>(&obstacles_in_band->mesh, true);
    house = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, nullptr, house_shape.get()));
    house->setFriction(0);
    world.addRigidBody(house.get());
  }

  void add_robot(const Robot& model, const Eigen::Vector2d& start_m, double heading_rad) {
    const auto mass = static_cast<btScalar>(model.mass_kg);
    btVector3 inertia;
    robot_shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &robot_shape, inertia);
    info.m_startWorldTransform = btTransform(
        btQuaternion(btVector3(0, 0, 1), static_cast<btScalar>(heading_rad)),
        btVector3(static_cast<btScalar>(start_m.x()), static_cast<btScalar>(start_m.y()),
                  static_cast<btScalar>(0.5 * model.height_m)));
    // Without friction and bounce a wall takes away speed and never adds any.
    info.m_friction = 0;
    info.m_restitution = 0;
    robot = std::make_unique<btRigidBody>(info);
    robot->setLinearFactor(btVector3(1, 1, 0));
    robot->setAngularFactor(btVector3(0, 0, 1));
    robot->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(robot.get());
  }

  /// What crosses the robot's axis, if anything: a mesh is hollow, so that a robot that stands in
  /// the middle of a bed touches none of its faces.
  std::optional<InstanceId> instance_on_axis() const {
    struct Hit : btCollisionWorld::ClosestRayResultCallback {
      using ClosestRayResultCallback::ClosestRayResultCallback;
      int face = -1;
      btScalar addSingleResult(btCollisionWorld::LocalRayResult& ray,
                               bool normal_is_world) override {
        if (ray.m_localShapeInfo != nullptr) face = ray.m_localShapeInfo->m_triangleIndex;
        return ClosestRayResultCallback::addSingleResult(ray, normal_is_world);
      }
    };
    if (!house) return std::nullopt;
    const btVector3& p = robot->getWorldTransform().getOrigin();
    const btVector3 top(p.x(), p.y(), static_cast<btScalar>(height_m)), bottom(p.x(), p.y(), 0);
    Hit hit(top, bottom);
    btCollisionWorld::rayTestSingle(btTransform(btQuaternion::getIdentity(), top),
                                    btTransform(btQuaternion::getIdentity(), bottom), house.get(),
                                    house_shape.get(), house->getWorldTransform(), hit);
    if (hit.face < 0) return std::nullopt;
    return obstacles_in_band->instance_of[static_cast<std::size_t>(hit.face)];
  }

  Contact deepest_contact() {
    Contact contact;
    double distance_m = kTouch_m;
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
      const btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(i);
      const bool robot_is_first = manifold->getBody0() == robot.get();
      for (int k = 0; k < manifold->getNumContacts(); ++k) {
        const btManifoldPoint& point = manifold->getContactPoint(k);
        if (point.getDistance() >= distance_m) continue;
        distance_m = point.getDistance();
        const int face = robot_is_first ? point.m_index1 : point.m_index0;
        contact = {.touching = true,
                   .penetration_m = std::max(0.0, -distance_m),
                   .instance = obstacles_in_band->instance_of[static_cast<std::size_t>(face)]};
      }
    }
    return contact;
  }
};

PlanarWorld::PlanarWorld(const Scene& scene, const Robot& robot, const Eigen::Vector2d& start_m,
                         double start_heading_rad, double step_s)
    : impl_(std::make_unique<Impl>(scene, robot, start_m, start_heading_rad, step_s)) {
  assert(step_s > 0);
}

PlanarWorld::~PlanarWorld() = default;

double PlanarWorld::step_s() const {
  return impl_->step_s;
}

BaseState PlanarWorld::state() const {
  const btRigidBody& body = *impl_->robot;
  const btVector3& p = body.getWorldTransform().getOrigin();
  const btQuaternion q = body.getOrientation();
  const btVector3& v = body.getLinearVelocity();
  return {.position_m = {p.x(), p.y()},
          .heading_rad = std::remainder(
              2.0 * std::atan2(static_cast<double>(q.z()), static_cast<double>(q.w())), 2.0 * M_PI),
          .velocity_m_per_s = {v.x(), v.y()},
          .turn_rad_per_s = body.getAngularVelocity().z()};
}

Contact PlanarWorld::step(const BaseCommand& command) {
  const BaseLimits& limits = impl_->limits;
  const BaseState now = state();
  const Eigen::Vector2d change_m_per_s =
      limited(limited(command.velocity_m_per_s, limits.max_velocity_m_per_s) - now.velocity_m_per_s,
              limits.max_acceleration_m_per_s2 * impl_->step_s);
  const double turn_change_rad_per_s =
      limited(limited(command.turn_rad_per_s, limits.max_turn_rad_per_s) - now.turn_rad_per_s,
              limits.max_turn_acceleration_rad_per_s2 * impl_->step_s);

  btRigidBody& body = *impl_->robot;
  const btScalar mass = 1 / body.getInvMass();
  const btScalar inertia_z = 1 / body.getInvInertiaDiagLocal().z();
  body.applyCentralImpulse(mass * btVector3(static_cast<btScalar>(change_m_per_s.x()),
                                            static_cast<btScalar>(change_m_per_s.y()), 0));
  body.applyTorqueImpulse(
      btVector3(0, 0, inertia_z * static_cast<btScalar>(turn_change_rad_per_s)));
  impl_->world.stepSimulation(static_cast<btScalar>(impl_->step_s), 0);
  return impl_->deepest_contact();
}

Contact PlanarWorld::contact() {
  impl_->world.performDiscreteCollisionDetection();
  if (const auto on_axis = impl_->instance_on_axis())
    return {.touching = true, .penetration_m = impl_->radius_m, .instance = *on_axis};
  return impl_->deepest_contact();
}

}  // namespace mh
