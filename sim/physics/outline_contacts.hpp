// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <btBulletCollisionCommon.h>

namespace mh {

/// Contacts of the base (a sphere that represents a disc) with the outline. Replaces Bullet's own
/// sphere-mesh collision, in which a shallow contact can replace a deep one in the same direction:
/// furniture has many layers a few millimeters apart.
class OutlineContacts final : public btCollisionAlgorithm {
 public:
  struct Maker final : btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override {
      void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(OutlineContacts));
      return new (memory) OutlineContacts(info, a->getCollisionObject(), b->getCollisionObject());
    }
  };

  OutlineContacts(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObject* a,
                  const btCollisionObject* b)
      : btCollisionAlgorithm(info), manifold_(m_dispatcher->getNewManifold(a, b)) {}
  ~OutlineContacts() override { m_dispatcher->releaseManifold(manifold_); }

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* result) override;

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    manifolds.push_back(manifold_);
  }

 private:
  static constexpr btScalar kReach_m = 0.005F;  // more than the base moves in a step
  static constexpr btScalar kSameWay = 0.995F;  // within 6 deg, the deeper of two contacts suffices

  struct Near {
    btScalar distance_m;
    int triangle;
    btVector3 point;  // point of the wall at the height of the base's middle
  };

  /// Finds walls within a distance of the center, nearest first.
  void find_near(const btBvhTriangleMeshShape& walls, const btVector3& center, btScalar most_m);

  btPersistentManifold* manifold_;
  std::vector<Near> near_;
};

}  // namespace mh
