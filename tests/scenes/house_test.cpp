// SPDX-License-Identifier: Apache-2.0
#include "scenes/house/house.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <set>

#include "scenes/furniture/furniture.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const std::string kFile = std::string(MH_SOURCE_DIR) + "/scenes/model_house/house.yaml";

const Scene& house() {
  static const Scene scene = load_house(kFile);
  return scene;
}

const Instance& instance(const std::string& name) {
  const auto found = std::ranges::find(house().instances, name, &Instance::name);
  if (found == house().instances.end()) throw std::runtime_error("no instance " + name);
  return *found;
}

std::array<Vector3d, 3> corners(const Scene& scene, std::size_t face) {
  std::array<Vector3d, 3> result;
  for (std::size_t k = 0; k < 3; ++k)
    result[k] = scene.positions_m[scene.triangles[face][k]].cast<double>();
  return result;
}

// ---- obstacles -------------------------------------------------------------------------------

/// The part of a triangle between two heights, seen from above; empty if there is none.
std::vector<Vector2d> slice(const std::array<Vector3d, 3>& triangle, double low, double high) {
  std::vector<Vector3d> polygon(triangle.begin(), triangle.end());
  for (const auto& [sign, limit] : {std::pair{1.0, low}, std::pair{-1.0, -high}}) {
    std::vector<Vector3d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double da = sign * a.z() - limit, db = sign * b.z() - limit;
      if (da >= 0) kept.push_back(a);
      if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + da / (da - db) * (b - a));
    }
    polygon = kept;
  }
  std::vector<Vector2d> flat;
  for (const Vector3d& p : polygon) flat.push_back(p.head<2>());
  return flat;
}

double distance(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const double length = (b - a).squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * (b - a)).norm();
}

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distance(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double ab_c = cross(b - a, c - a), ab_d = cross(b - a, d - a);
  const double cd_a = cross(d - c, a - c), cd_b = cross(d - c, b - c);
  if (ab_c * ab_d < 0 && cd_a * cd_b < 0) return 0.0;
  return std::min({distance(a, c, d), distance(b, c, d), distance(c, a, b), distance(d, a, b)});
}

/// Smallest distance from a path to anything in the house between 0.03 m (rugs, thresholds) and
/// 1.25 m (the robot's height), over the objects for which `counts` holds.
double clearance(const std::vector<Vector2d>& path,
                 const std::function<bool(const Instance&)>& counts, std::string* nearest) {
  double least = std::numeric_limits<double>::infinity();
  const Scene& scene = house();
  for (std::size_t f = 0; f < scene.triangles.size(); ++f) {
    if (scene.instance_of[f] == 0) continue;
    const Instance& object = scene.instances[scene.instance_of[f] - 1u];
    if (!counts(object)) continue;
    const std::vector<Vector2d> polygon = slice(corners(scene, f), 0.03, 1.25);
    for (std::size_t i = 0; i < polygon.size(); ++i)
      for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        const double d =
            distance(polygon[i], polygon[(i + 1) % polygon.size()], path[k], path[k + 1]);
        if (d < least) {
          least = d;
          *nearest = object.name;
        }
      }
  }
  return least;
}

const std::vector<std::vector<Vector2d>> kCorridors = {
    {{1.7, 3.6}, {1.7, 3.0}, {3.2, 2.6}, {4.6, 2.8}, {5.25, 2.8}},
    {{5.25, 2.8}, {6.2, 2.4}, {7.4, 2.1}, {8.05, 3.0}, {8.05, 3.95}},
    {{8.05, 3.95}, {8.05, 4.7}, {6.0, 4.75}, {4.6, 5.35}, {3.95, 5.35}},
    {{3.95, 5.35}, {2.6, 5.35}, {1.7, 4.8}, {1.7, 3.95}, {1.7, 3.6}}};

TEST(House, RobotPassesAllCorridorsAndDoors) {
  for (const auto& path : kCorridors) {
    std::string nearest;
    EXPECT_GT(clearance(
                  path, [](const Instance&) { return true; }, &nearest),
              0.30)
        << nearest;
  }
}

TEST(House, FurnitureKeepsHalfAMeterFromCorridors) {
  const ClassId wall = *class_by_name("wall"), door = *class_by_name("door");
  for (const auto& path : kCorridors) {
    std::string nearest;
    const auto furniture = [&](const Instance& o) {
      return o.class_id != wall && o.class_id != door;
    };
    EXPECT_GT(clearance(path, furniture, &nearest), 0.49) << nearest;
  }
}

TEST(House, RobotDrivesARingInTheLivingRoom) {
  const std::vector<Vector2d> ring = {{1.5, 2.3}, {1.5, 0.52}, {3.6, 0.52}, {3.6, 2.3}, {1.5, 2.3}};
  std::string nearest;
  EXPECT_GT(clearance(
                ring, [](const Instance&) { return true; }, &nearest),
            0.28)
      << nearest;
}

// ---- contents --------------------------------------------------------------------------------

TEST(House, HasFourRoomsOfSixtySquareMeters) {
  ASSERT_EQ(house().rooms.size(), 4u);
  EXPECT_NEAR(house().floor_area_m2(), 60.72, 1e-9);
}

TEST(House, HoldsManyObjectsOfManyClasses) {
  const std::set<std::string_view> structure = {"wall", "floor", "ceiling", "otherstructure"};
  std::set<std::string_view> kinds;
  int objects = 0;
  for (const Instance& object : house().instances) {
    const std::string_view name = classes()[object.class_id].name;
    if (structure.contains(name)) continue;
    ++objects;
    kinds.insert(name);
  }
  EXPECT_GE(objects, 90);
  EXPECT_GE(kinds.size(), 25u);
  for (const auto* needed :
       {"bed", "sofa", "table", "chair", "television", "refridgerator", "sink", "oven", "cabinet",
        "shelves", "books", "lamp", "potted plant", "picture", "curtain", "door", "window"})
    EXPECT_TRUE(kinds.contains(needed)) << needed;
}

TEST(House, ObjectsAreNamedOnceAndMeasured) {
  std::set<std::string> names;
  for (const Instance& object : house().instances) {
    EXPECT_TRUE(names.insert(object.name).second) << object.name;
    EXPECT_GT((object.max_m - object.min_m).maxCoeff(), 0.005F) << object.name;
  }
  // The bed from house.yaml: 2.06 m deep, with its head at the east wall at x = 9.3.
  const Instance& bed = instance("bedroom/bed");
  EXPECT_NEAR(bed.max_m.x(), 9.29, 0.011);
  EXPECT_NEAR(bed.max_m.x() - bed.min_m.x(), 2.06, 0.03);
}

TEST(House, FurnitureStaysInsideTheHouse) {
  for (const Instance& object : house().instances) {
    if (object.name.starts_with("house/")) continue;
    // Doorways and windows extend outward through the walls by 0.1 m, plus their casing.
    EXPECT_GT(object.min_m.minCoeff(), -0.125F) << object.name;
    EXPECT_LT(object.max_m.x(), 9.425F) << object.name;
    EXPECT_LT(object.max_m.y(), 6.825F) << object.name;
    EXPECT_LE(object.max_m.z(), 2.51F) << object.name;
  }
}

TEST(House, LoadsTheSameTwice) {
  EXPECT_EQ(digest(load_house(kFile)), digest(house()));
}

TEST(House, HasNoDegenerateTriangles) {
  const Scene& scene = house();
  ASSERT_GT(scene.triangles.size(), 200'000u);
  EXPECT_LT(scene.triangles.size(), 400'000u);
  std::size_t bad = 0;
  for (std::size_t f = 0; f < scene.triangles.size(); ++f) {
    const auto [a, b, c] = corners(scene, f);
    bad += !((b - a).cross(c - a).norm() > 1e-10);
  }
  EXPECT_EQ(bad, 0u);
}

// ---- closed walls ----------------------------------------------------------------------------

/// Distance along a ray to the nearest face; infinity if it leaves. Moeller and Trumbore, 1997.
std::pair<double, std::size_t> first_hit(const Scene& scene, const Vector3d& from,
                                         const Vector3d& way) {
  std::pair<double, std::size_t> best{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t f = 0; f < scene.triangles.size(); ++f) {
    const auto [a, b, c] = corners(scene, f);
    const Vector3d e = b - a, g = c - a, p = way.cross(g);
    const double det = e.dot(p);
    if (std::abs(det) < 1e-14) continue;
    const Vector3d s = (from - a) / det;
    const double u = s.dot(p);
    if (u < 0 || u > 1) continue;
    const Vector3d q = s.cross(e);
    const double v = way.dot(q), t = g.dot(q);
    if (v >= 0 && u + v <= 1 && t > 1e-6 && t < best.first) best = {t, f};
  }
  return best;
}

bool leaves_through_a_window(const Vector3d& from, const Vector3d& way) {
  for (const Instance& object : house().instances) {
    if (classes()[object.class_id].name != "window") continue;
    double enter = 0, leave = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double a = (object.min_m[k] - from[k]) / way[k],
                   b = (object.max_m[k] - from[k]) / way[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter <= leave) return true;
  }
  return false;
}

TEST(House, NoRayLeavesButThroughWindows) {
  const RandomStream random(5);
  int outside = 0, hull = 0;
  for (std::size_t r = 0; r < house().rooms.size(); ++r) {
    Vector2d center = Vector2d::Zero();
    for (const Vector2d& p : house().rooms[r].polygon_m) center += p / 4.0;
    const Vector3d from(center.x() + 0.013, center.y() + 0.017, 1.57);
    for (std::uint64_t i = 0; i < 120; ++i) {
      const RandomStream one = random.fork(r).fork(i);
      const Vector3d way = Vector3d(one.normal(0), one.normal(1), one.normal(2)).normalized();
      const auto [t, face] = first_hit(house(), from, way);
      const InstanceId id = house().instance_of[face];
      if (std::isinf(t) || id == 0) {
        ++outside;
        EXPECT_TRUE(leaves_through_a_window(from, way)) << house().rooms[r].name << " " << i;
      } else {
        hull += house().instances[id - 1u].name.starts_with("house/");
      }
    }
  }
  EXPECT_GT(outside, 0);  // otherwise there would be no windows
  EXPECT_EQ(hull, 0);     // no ray ends between the walls
}

// ---- lights ----------------------------------------------------------------------------------

TEST(House, HasSunSkyAndALampInEveryRoom) {
  int suns = 0, skies = 0;
  std::set<std::string> lit;
  for (const Light& light : house().lights) {
    suns += light.kind == Light::Kind::kSun;
    skies += light.kind == Light::Kind::kSky;
    if (light.kind != Light::Kind::kSphere) continue;
    for (const Room& room : house().rooms)
      if (light.position_m.x() > room.polygon_m[0].x() &&
          light.position_m.x() < room.polygon_m[2].x() &&
          light.position_m.y() > room.polygon_m[0].y() &&
          light.position_m.y() < room.polygon_m[2].y())
        lit.insert(room.name);
  }
  EXPECT_EQ(suns, 1);
  EXPECT_EQ(skies, 1);
  EXPECT_EQ(lit.size(), 4u);
}

// ---- bad input -------------------------------------------------------------------------------

struct BadInput {
  std::string name, from, to, says;
};

class BadHouse : public testing::TestWithParam<BadInput> {};

TEST_P(BadHouse, IsOneClearError) {
  std::string text = read_file(kFile);
  const std::size_t at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos) << "house.yaml no longer holds: " << GetParam().from;
  text.replace(at, GetParam().from.size(), GetParam().to);
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  try {
    build_house(text, "bad.yaml");
    FAIL() << "was accepted";
  } catch (const InputError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find(GetParam().says), std::string::npos) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    std::smatch place;
    ASSERT_TRUE(std::regex_search(what, place, std::regex("^bad\\.yaml:([0-9]+): "))) << what;
    // The reported place is that of the mistake, or of the entry (at most a few lines long) around
    // it.
    EXPECT_NEAR(std::stod(place[1]), static_cast<double>(line), 5.0) << what;
  }
}

const std::string kTable = "at: [2.5, 1.3], turn_deg: 90, size_m: [0.90, 0.60, 0.40]";

INSTANTIATE_TEST_SUITE_P(
    House, BadHouse,
    testing::Values(
        BadInput{"UnknownKey", "height_m: 2.5\n", "height_m: 2.5\nheigth_m: 3\n", "heigth_m"},
        BadInput{"UnknownKeyOfRoom", "floor: oak_floor", "flor: oak_floor", "floor"},
        BadInput{"UnknownKeyOfPiece", kTable, "color: red, " + kTable, "color"},
        BadInput{"WrongType", "height_m: 2.5\n", "height_m: tall\n", "tall"},
        BadInput{"WrongTypeOfPiece", kTable, "at: here", "at"},
        BadInput{"NegativeSize", kTable, "at: [2.5, 1.3], size_m: [0.90, -0.60, 0.40]", "-0.6"},
        BadInput{"HugeExtent", "extent_m: [0, 0, 9.3, 6.7]", "extent_m: [0, 0, 3676, 1945]",
                 "500 m is the most"},
        BadInput{"TurnedRoom", "rect_m: [0, 0, 5.2, 3.9]", "rect_m: [5.2, 0, 0, 3.9]", "size"},
        BadInput{"RoomOutside", "rect_m: [5.3, 0, 9.3, 3.9]", "rect_m: [5.3, 0, 9.9, 3.9]",
                 "outside the house"},
        BadInput{"RoomsOverlap", "rect_m: [5.3, 0, 9.3, 3.9]", "rect_m: [5.0, 0, 9.3, 3.9]",
                 "overlap"},
        BadInput{"NoRoomForWall", "rect_m: [5.3, 0, 9.3, 3.9]", "rect_m: [5.25, 0, 9.3, 3.9]",
                 "wall"},
        BadInput{"PieceInWall", kTable, "at: [0.3, 3.0], size_m: [0.90, 0.60, 0.40]",
                 "overlaps a wall"},
        BadInput{"TurnedPieceInWall", kTable,
                 "at: [2.5, 0.40], turn_deg: 45, size_m: [0.90, 0.60, 0.40]", "overlaps a wall"},
        BadInput{"PieceInOtherRoom", kTable, "at: [7.0, 2.0], size_m: [0.9, 0.6, 0.4]",
                 "lies in room 'kitchen'"},
        BadInput{"PieceOutside", kTable, "at: [12.0, 2.0], size_m: [0.9, 0.6, 0.4]",
                 "outside all rooms"},
        BadInput{"PiecesOverlap", kTable, "at: [1.0, 1.4], size_m: [0.9, 0.6, 0.4]",
                 "overlaps 'living/sofa'"},
        BadInput{"NotOnItsCarrier", "at: [0.34, 0.16], turn_deg: 40", "at: [0.64, 0.16]",
                 "is not on 'living/coffee_table'"},
        BadInput{"CarrierUnknown", "on: coffee_table", "on: nothing", "'nothing'"},
        BadInput{"UnknownFurniture", "kind: coffee_table", "kind: coffee_tabel", "coffee_tabel"},
        BadInput{"UnknownMaterial", "ceiling: ceiling_white", "ceiling: ceiling_wite",
                 "ceiling_wite"},
        BadInput{"UnknownKindOfMaterial", "kind: parquet", "kind: parkett", "parkett"},
        BadInput{"UnknownRole", "materials: {top: red_rug}", "materials: {tip: red_rug}", "tip"},
        BadInput{"NameTwice", "name: pillow_2", "name: pillow_1", "living/pillow_1"},
        BadInput{"NarrowDoorway", "span_m: [2.3, 3.3]", "span_m: [2.3, 2.85]", "narrower than 0.6"},
        BadInput{"DoorwayBesideWall", "span_m: [2.3, 3.3]", "span_m: [3.3, 4.3]",
                 "is not in the wall"},
        BadInput{"DoorwayInNoWall", "rooms: [living, kitchen]", "rooms: [kitchen, entrance]",
                 "is in no wall"},
        BadInput{"WindowInInnerWall", "room: living, side: west", "room: living, side: east",
                 "outer wall"},
        BadInput{"SunFromBelow", "direction: [0.42, 0.70, -0.58]", "direction: [0, 0, 1]",
                 "must point down"}),
    [](const auto& test) { return test.param.name; });

TEST(House, MissingFileIsNamed) {
  try {
    load_house("/nowhere/house.yaml");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("/nowhere/house.yaml"), std::string::npos);
  }
}

// ---- the builder and the furniture -----------------------------------------------------------

double signed_volume(const Scene& scene) {
  double volume = 0;
  for (std::size_t f = 0; f < scene.triangles.size(); ++f) {
    const auto [a, b, c] = corners(scene, f);
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

/// Whether every edge of a shape is used exactly once in each direction (points are compared by
/// position, since faces do not share vertices across creases).
bool is_closed(const Scene& scene) {
  std::map<std::array<float, 6>, int> edges;
  for (const auto& triangle : scene.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f &a = scene.positions_m[triangle[k]],
                            &b = scene.positions_m[triangle[(k + 1) % 3]];
      ++edges[{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}];
      --edges[{b.x(), b.y(), b.z(), a.x(), a.y(), a.z()}];
    }
  return std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 0; });
}

TEST(MeshBuilder, ShapesAreClosedAndFaceOutwards) {
  const auto measure = [](const std::function<void(MeshBuilder&, MaterialId)>& build) {
    MeshBuilder mesh;
    build(mesh, mesh.material({.name = "", .kind = "plastic"}));
    const Scene scene = mesh.finish();
    EXPECT_TRUE(is_closed(scene));
    return signed_volume(scene);
  };
  EXPECT_NEAR(measure([](MeshBuilder& m, MaterialId k) {
                m.box(k, {0, 0, 0}, {1, 2, 0.5F}, {.bevel_m = 0.0F});
              }),
              1.0, 1e-5);
  // A chamfer r removes r^2/2 along each edge (4 each of lengths 1, 2 and 0.5, less the shared
  // corners).
  EXPECT_NEAR(measure([](MeshBuilder& m, MaterialId k) {
                m.box(k, {0, 0, 0}, {1, 2, 0.5F}, {.bevel_m = 0.01F});
              }),
              1.0 - 4 * 3.5 * 0.01 * 0.01 / 2, 1e-4);
  // A regular 64-gon has 0.9984 of the area of its circle.
  EXPECT_NEAR(measure([](MeshBuilder& m, MaterialId k) {
                m.cylinder(k, {0, 0, 0}, {0, 0, 1}, {0.5F, 0.5F}, 64);
              }),
              0.25 * M_PI * 0.9984, 1e-3);
  EXPECT_NEAR(measure([](MeshBuilder& m, MaterialId k) {
                m.prism(k, std::array<Eigen::Vector2f, 3>{{{0, 0}, {1, 0}, {0, 1}}}, 0.0F, 2.0F);
              }),
              1.0, 1e-5);
  const double soft = measure([](MeshBuilder& m, MaterialId k) {
    m.cushion(k, {0, 0, 0}, {1, 1, 1}, 0.2F);
  });
  EXPECT_GT(soft,
            0.89);  // a cube with round edges has 0.9077; the chords of the mesh cut off a little
  EXPECT_LT(soft, 0.9077);
}

TEST(MeshBuilder, TexturesKeepTheirPhysicalSize) {
  MeshBuilder mesh;
  const MaterialId wood = mesh.material({.name = "", .kind = "wood_grain"});
  mesh.image(wood, {0, 0, 1}, {1.5F, 0, 0}, {0, 0, -1});
  const Scene scene = mesh.finish();
  const Eigen::Vector2f tile = scene.materials[wood].tile_m;
  EXPECT_NEAR(scene.uvs.back().x(), 1.5F / tile.x(), 1e-5);
  EXPECT_NEAR(scene.uvs.back().y(), 1.0F / tile.y(), 1e-5);
}

}  // namespace
}  // namespace mh
