// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/planar_world.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "sim/physics/obstacles.hpp"
#include "sim/physics/outline_contacts.hpp"

namespace mh {
namespace {

double limited(double value, double limit) {
  return std::clamp(value, -limit, limit);
}

Eigen::Vector2d limited(const Eigen::Vector2d& v, double limit) {
  const double norm = v.norm();
  return norm > limit ? Eigen::Vector2d(v * (limit / norm)) : v;
}

/// The change of velocity of a base whose wheels roll only forward and backward: the motors' limits
/// apply along its heading; perpendicular to it, the wheels' grip follows the command.
Eigen::Vector2d gripped_change(const BaseCommand& command, const BaseState& now,
                               double max_velocity_m_per_s, double max_change_m_per_s,
                               double step_s) {
  const double heading_rad = now.heading_rad + 0.5 * command.turn_rad_per_s * step_s;
  const Eigen::Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
  const Eigen::Vector2d change = command.velocity_m_per_s - now.velocity_m_per_s;
  const double speed = ahead.dot(now.velocity_m_per_s);
  const double asked = limited(ahead.dot(command.velocity_m_per_s), max_velocity_m_per_s) - speed;
  return change + (limited(asked, max_change_m_per_s) - ahead.dot(change)) * ahead;
}

}  // namespace

// Members are destroyed in reverse order: the world before what it refers to.
struct PlanarWorld::Impl {
  BaseLimits limits;
  bool grips;  // the wheels keep the base from moving sideways: see step()
  double radius_m, height_m;
  double step_s;
  std::unique_ptr<Obstacles> seen, felt;
  std::unique_ptr<btRigidBody> house;  // body of felt_obstacles; null if there is nothing to hit
  btSphereShape robot_shape;           // see felt_obstacles
  std::unique_ptr<btRigidBody> robot;
  struct Mover {
    MovingObstacle obstacle;
    std::unique_ptr<btCylinderShapeZ> shape;
    std::unique_ptr<btRigidBody> body;
  };
  std::vector<Mover> movers;
  long steps = 0;
  OutlineContacts::Maker outline_contacts;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};

  Impl(const Scene& scene, const Robot& model, const Eigen::Vector2d& start_m, double heading_rad,
       double step)
      : limits(model.limits),
        grips(model.differential() != nullptr),
        radius_m(model.footprint_radius_m),
        height_m(model.height_m),
        step_s(step),
        seen(seen_obstacles(scene, static_cast<float>(model.height_m))),
        felt(felt_obstacles(scene, static_cast<float>(model.height_m),
                            static_cast<float>(0.5 * model.height_m))),
        robot_shape(static_cast<btScalar>(model.footprint_radius_m)) {
    world.setGravity(btVector3(0, 0, 0));
    // Overlaps are resolved without leaving the body any velocity.
    world.getSolverInfo().m_splitImpulsePenetrationThreshold = 0;
    dispatcher.registerCollisionCreateFunc(SPHERE_SHAPE_PROXYTYPE, TRIANGLE_MESH_SHAPE_PROXYTYPE,
                                           &outline_contacts);
    dispatcher.registerCollisionCreateFunc(TRIANGLE_MESH_SHAPE_PROXYTYPE, SPHERE_SHAPE_PROXYTYPE,
                                           &outline_contacts);
    add_house();
    add_robot(model, start_m, heading_rad);
  }

  ~Impl() {
    world.removeRigidBody(robot.get());
    for (const Mover& mover : movers) world.removeRigidBody(mover.body.get());
    if (house) world.removeRigidBody(house.get());
  }

  void add_house() {
    if (!felt->shape) return;
    house = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, nullptr, felt->shape.get()));
    house->setFriction(0);
    world.addRigidBody(house.get());
  }

  void add_robot(const Robot& model, const Eigen::Vector2d& start_m, double heading_rad) {
    const auto mass = static_cast<btScalar>(model.mass_kg);
    const btScalar r = robot_shape.getRadius();
    const btVector3 inertia = 0.5F * mass * r * r * btVector3(1, 1, 1);  // a cylinder's about z
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &robot_shape, inertia);
    info.m_startWorldTransform = btTransform(
        btQuaternion(btVector3(0, 0, 1), static_cast<btScalar>(heading_rad)),
        btVector3(static_cast<btScalar>(start_m.x()), static_cast<btScalar>(start_m.y()),
                  static_cast<btScalar>(0.5 * model.height_m)));
    // Without friction and restitution, a wall removes speed and never adds any.
    info.m_friction = 0;
    info.m_restitution = 0;
    robot = std::make_unique<btRigidBody>(info);
    robot->setLinearFactor(btVector3(1, 1, 0));
    robot->setAngularFactor(btVector3(0, 0, 1));
    robot->setActivationState(DISABLE_DEACTIVATION);
    // A body that turns only about a vertical axis has no gyroscopic torque; computing that zero
    // would cost the turn rate precision.
    robot->setFlags(0);
    world.addRigidBody(robot.get());
  }

  /// Returns what crosses the robot's axis, if anything: a mesh is hollow, so a robot in the middle
  /// of a bed touches none of its faces.
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
    if (!seen->shape) return std::nullopt;
    const btVector3& p = robot->getWorldTransform().getOrigin();
    const btVector3 top(p.x(), p.y(), static_cast<btScalar>(height_m)), bottom(p.x(), p.y(), 0);
    Hit hit(top, bottom);
    btCollisionWorld::rayTestSingle(btTransform(btQuaternion::getIdentity(), top),
                                    btTransform(btQuaternion::getIdentity(), bottom), house.get(),
                                    seen->shape.get(), house->getWorldTransform(), hit);
    if (hit.face < 0) return std::nullopt;
    return seen->instance_of[static_cast<std::size_t>(hit.face)];
  }

  InstanceId instance_of(const btCollisionObject* body, int face) const {
    for (const Mover& mover : movers)
      if (mover.body.get() == body) return mover.obstacle.instance;
    return felt->instance_of[static_cast<std::size_t>(face)];
  }

  btTransform pose_of(const MovingObstacle& obstacle, double time_s) const {
    const Eigen::Vector2d p = obstacle.path(time_s);
    return btTransform(btQuaternion::getIdentity(),
                       btVector3(static_cast<btScalar>(p.x()), static_cast<btScalar>(p.y()),
                                 static_cast<btScalar>(0.5 * obstacle.height_m)));
  }

  /// Moves the moving obstacles to their positions after the next step, with the corresponding
  /// velocity.
  void move_movers() {
    for (Mover& mover : movers) {
      const btTransform from = pose_of(mover.obstacle, static_cast<double>(steps) * step_s);
      const btTransform to = pose_of(mover.obstacle, static_cast<double>(steps + 1) * step_s);
      mover.body->setWorldTransform(to);
      mover.body->setInterpolationWorldTransform(from);
      mover.body->setLinearVelocity((to.getOrigin() - from.getOrigin()) /
                                    static_cast<btScalar>(step_s));
    }
    ++steps;
  }

  Contact deepest_contact() {
    Contact contact;
    double distance_m = kTouch_m;
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
      const btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(i);
      const bool robot_is_first = manifold->getBody0() == robot.get();
      for (int k = 0; k < manifold->getNumContacts(); ++k) {
        const btManifoldPoint& point = manifold->getContactPoint(k);
        // Distances are from before the step; an obstacle that pushed during the step counts as
        // reached.
        const double now_m = point.getAppliedImpulse() > 0
                                 ? std::min<double>(point.getDistance(), 0)
                                 : point.getDistance();
        if (now_m >= distance_m) continue;
        distance_m = now_m;
        const btCollisionObject* other =
            robot_is_first ? manifold->getBody1() : manifold->getBody0();
        const int face = robot_is_first ? point.m_index1 : point.m_index0;
        const btVector3 away =
            (robot_is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB()) -
            robot->getWorldTransform().getOrigin();
        contact = {.touching = true,
                   .penetration_m = std::max(0.0, -distance_m),
                   .instance = instance_of(other, face),
                   .direction = Eigen::Vector2d(away.x(), away.y()).stableNormalized()};
      }
    }
    return contact;
  }
};

BaseLimits commandable(BaseLimits limits) {
  for (double* velocity : {&limits.max_velocity_m_per_s, &limits.max_turn_rad_per_s})
    *velocity *= 0.9995;
  for (double* change :
       {&limits.max_acceleration_m_per_s2, &limits.max_turn_acceleration_rad_per_s2})
    *change *= 0.99;
  for (std::optional<double>* jerk : {&limits.max_jerk_m_per_s3, &limits.max_turn_jerk_rad_per_s3})
    if (*jerk) **jerk *= 0.95;
  return limits;
}

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
  const double most_m_per_s = limits.max_acceleration_m_per_s2 * impl_->step_s;
  const Eigen::Vector2d change_m_per_s =
      impl_->grips
          ? gripped_change(command, now, limits.max_velocity_m_per_s, most_m_per_s, impl_->step_s)
          : limited(limited(command.velocity_m_per_s, limits.max_velocity_m_per_s) -
                        now.velocity_m_per_s,
                    most_m_per_s);
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
  impl_->move_movers();
  impl_->world.stepSimulation(static_cast<btScalar>(impl_->step_s), 0);
  return impl_->deepest_contact();
}

Contact PlanarWorld::contact() {
  impl_->world.performDiscreteCollisionDetection();
  if (const auto on_axis = impl_->instance_on_axis())
    return {.touching = true, .penetration_m = impl_->radius_m, .instance = *on_axis};
  return impl_->deepest_contact();
}

void PlanarWorld::place(const Eigen::Vector2d& position_m, double heading_rad) {
  btRigidBody& body = *impl_->robot;
  const btTransform pose(
      btQuaternion(btVector3(0, 0, 1), static_cast<btScalar>(heading_rad)),
      btVector3(static_cast<btScalar>(position_m.x()), static_cast<btScalar>(position_m.y()),
                body.getWorldTransform().getOrigin().z()));
  body.setWorldTransform(pose);
  body.setInterpolationWorldTransform(pose);
  body.setLinearVelocity(btVector3(0, 0, 0));
  body.setAngularVelocity(btVector3(0, 0, 0));
  body.clearForces();
  // Contacts at the old place would still push at the new one.
  impl_->broadphase.getOverlappingPairCache()->cleanProxyFromPairs(body.getBroadphaseHandle(),
                                                                   &impl_->dispatcher);
}

void PlanarWorld::add(MovingObstacle obstacle) {
  assert(obstacle.path && obstacle.radius_m > 0 && obstacle.height_m > 0);
  Impl::Mover mover;
  const auto r = static_cast<btScalar>(obstacle.radius_m);
  mover.shape = std::make_unique<btCylinderShapeZ>(
      btVector3(r, r, static_cast<btScalar>(0.5 * obstacle.height_m) + kOverhang_m));
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, mover.shape.get());
  info.m_startWorldTransform =
      impl_->pose_of(obstacle, static_cast<double>(impl_->steps) * impl_->step_s);
  info.m_friction = 0;
  mover.body = std::make_unique<btRigidBody>(info);
  mover.body->setCollisionFlags(mover.body->getCollisionFlags() |
                                btCollisionObject::CF_KINEMATIC_OBJECT);
  mover.body->setActivationState(DISABLE_DEACTIVATION);
  mover.obstacle = std::move(obstacle);
  impl_->world.addRigidBody(mover.body.get());
  impl_->movers.push_back(std::move(mover));
}

void PlanarWorld::show_at(double time_s) {
  impl_->steps = std::lround(time_s / impl_->step_s);
  for (Impl::Mover& mover : impl_->movers)
    mover.body->setWorldTransform(
        impl_->pose_of(mover.obstacle, static_cast<double>(impl_->steps) * impl_->step_s));
}

std::optional<double> PlanarWorld::cast(const Eigen::Vector3d& from_m,
                                        const Eigen::Vector3d& direction, double range_m) const {
  const auto point = [](const Eigen::Vector3d& p) {
    return btVector3(static_cast<btScalar>(p.x()), static_cast<btScalar>(p.y()),
                     static_cast<btScalar>(p.z()));
  };
  const btVector3 from = point(from_m), to = point(from_m + range_m * direction);
  btCollisionWorld::ClosestRayResultCallback hit(from, to);
  const auto try_shape = [&](btRigidBody& body, const btCollisionShape& shape) {
    btCollisionWorld::rayTestSingle(btTransform(btQuaternion::getIdentity(), from),
                                    btTransform(btQuaternion::getIdentity(), to), &body, &shape,
                                    body.getWorldTransform(), hit);
  };
  if (impl_->house) try_shape(*impl_->house, *impl_->seen->shape);
  for (const Impl::Mover& mover : impl_->movers) try_shape(*mover.body, *mover.shape);
  if (!hit.hasHit()) return std::nullopt;
  return static_cast<double>(hit.m_closestHitFraction) * range_m;
}

}  // namespace mh
