// SPDX-License-Identifier: Apache-2.0
#include "scenes/furniture/furniture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "slam/core/labels.hpp"
#include "slam/core/random.hpp"

namespace mh {
namespace {

class EveryKind : public testing::TestWithParam<FurnitureKind> {};

TEST_P(EveryKind, FitsItsSizeAndOverridesItsMaterials) {
  const FurnitureKind& kind = GetParam();
  ASSERT_TRUE(class_by_name(kind.class_name)) << kind.class_name;
  std::map<std::string, MaterialSpec> chosen;
  std::istringstream roles{std::string(kind.roles)};
  for (std::string role; roles >> role;)
    chosen[role] = {.name = "chosen_" + role, .kind = "plastic"};
  MeshBuilder mesh;
  mesh.begin_instance("piece", *class_by_name(kind.class_name));
  Piece piece(mesh, "piece", kind.size_m, chosen, RandomStream(3));
  kind.build(piece);
  const Scene scene = mesh.finish();
  EXPECT_GT(scene.triangles.size(), 50u);
  // 1.5 cm of tolerance: cloth and leaves may hang over a little; a pan's handle is not a
  // collision.
  for (const Eigen::Vector3f& p : scene.positions_m) {
    EXPECT_LT(std::abs(p.x()), kind.size_m.x() / 2 + 0.015F);
    EXPECT_LT(std::abs(p.y()), kind.size_m.y() / 2 + 0.015F);
    EXPECT_GT(p.z(), -0.015F);
    // Kinds with parts that stick out at the top: a tap, pan supports, a hat on its shelf.
    const bool open_above = kind.name == "kitchen_counter" || kind.name == "oven" ||
                            kind.name == "coat_rack" || kind.name == "bathtub" ||
                            kind.name == "washbasin";
    EXPECT_TRUE(open_above || p.z() < kind.size_m.z() + 0.015F) << p.z();
    if (HasFailure()) break;
  }
  for (const auto& [role, spec] : chosen)
    EXPECT_TRUE(std::ranges::any_of(scene.materials,
                                    [&](const Material& m) { return m.name == spec.name; }))
        << "role '" << role << "' is listed but never used";
}

INSTANTIATE_TEST_SUITE_P(Furniture, EveryKind,
                         testing::ValuesIn(furniture_kinds().begin(), furniture_kinds().end()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace mh
