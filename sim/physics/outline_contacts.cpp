// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/outline_contacts.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace mh {

void OutlineContacts::processCollision(const btCollisionObjectWrapper* a,
                                       const btCollisionObjectWrapper* b,
                                       const btDispatcherInfo& /*info*/, btManifoldResult* result) {
  const bool base_is_first = a->getCollisionShape()->getShapeType() == SPHERE_SHAPE_PROXYTYPE;
  const btCollisionObjectWrapper& base = base_is_first ? *a : *b;
  const btCollisionObjectWrapper& house = base_is_first ? *b : *a;
  const btVector3 center = base.getWorldTransform().getOrigin();
  const btScalar radius = static_cast<const btSphereShape*>(base.getCollisionShape())->getRadius();
  find_near(*static_cast<const btBvhTriangleMeshShape*>(house.getCollisionShape()), center,
            radius + kReach_m);
  manifold_->clearManifold();
  result->setPersistentManifold(manifold_);
  std::array<btVector3, MANIFOLD_CACHE_SIZE> directions;
  std::size_t kept = 0;
  for (const Near& near : near_) {
    if (kept == directions.size()) break;
    const btVector3 direction = (center - near.point) / near.distance_m;
    const auto alike = [&](const btVector3& other) { return other.dot(direction) > kSameWay; };
    if (std::any_of(directions.begin(), directions.begin() + kept, alike)) continue;
    directions[kept++] = direction;
    const btScalar gap_m = near.distance_m - radius;
    if (base_is_first) {
      result->setShapeIdentifiersB(0, near.triangle);
      result->addContactPoint(direction, near.point, gap_m);
    } else {
      result->setShapeIdentifiersA(0, near.triangle);
      result->addContactPoint(-direction, center - radius * direction, gap_m);
    }
  }
}

void OutlineContacts::find_near(const btBvhTriangleMeshShape& walls, const btVector3& center,
                                btScalar most_m) {
  struct Visitor final : btTriangleCallback {
    btVector3 center;
    btScalar most_m = 0;
    std::vector<Near>* near = nullptr;
    void processTriangle(btVector3* corners, int /*part*/, int triangle) override {
      if (triangle % 2 != 0) return;  // the other half of the same wall
      btVector3 a = corners[0], along = corners[1] - corners[0];
      a.setZ(center.z());
      const btScalar t =
          std::clamp((center - a).dot(along) / along.length2(), btScalar(0), btScalar(1));
      const btVector3 point = a + t * along;
      const btScalar distance_m = (center - point).length();
      if (distance_m < most_m && distance_m > 0) near->push_back({distance_m, triangle, point});
    }
  };
  near_.clear();
  Visitor visitor;
  visitor.center = center;
  visitor.most_m = most_m;
  visitor.near = &near_;
  const btVector3 reach(most_m, most_m, most_m);
  walls.processAllTriangles(&visitor, center - reach, center + reach);
  std::sort(near_.begin(), near_.end(), [](const Near& a, const Near& b) {
    return std::tie(a.distance_m, a.triangle) < std::tie(b.distance_m, b.triangle);
  });
}

}  // namespace mh
