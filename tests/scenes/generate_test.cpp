// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/generate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>

#include <fmt/format.h>

#include "scenes/generate/grammar.hpp"
#include "scenes/house/house.hpp"
#include "scenes/house/plan_file.hpp"
#include "scenes/load.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// The first environment of each category, or one for each type of room if there are several types.
std::vector<GeneratedReference> sample() {
  std::vector<GeneratedReference> list;
  for (const Category& category : categories())
    for (std::size_t i = 0; i < category.rooms.size(); ++i) list.push_back({category.name, i});
  return list;
}

TEST(Generate, HasAsManyEnvironmentsAsThePapersTable1) {
  const std::vector<std::pair<std::string, int>> wanted = {
      {"bathroom", 27},        {"bedroom", 25},       {"bookstore", 10}, {"classroom", 7},
      {"conference_room", 13}, {"copy_mail_room", 7}, {"hallway", 8},    {"kitchen", 16},
      {"living_room", 34},     {"lobby", 8},          {"office", 22},    {"misc", 24}};
  std::vector<std::pair<std::string, int>> found;
  for (const Category& category : categories()) found.emplace_back(category.name, category.count);
  EXPECT_EQ(found, wanted);
}

/// The plans of all environments, made once for the process.
const std::vector<GeneratedPlan>& all_plans() {
  static const std::vector<GeneratedPlan> plans = [] {
    std::vector<GeneratedPlan> made;
    for (const Category& category : categories())
      for (int i = 0; i < category.count; ++i)
        made.push_back(generate_plan({category.name, static_cast<std::uint64_t>(i)}));
    return made;
  }();
  return plans;
}

TEST(Generate, AllDensityGroupsAreThereAndNoTwoPlansAlike) {
  std::array<int, kDensityGroups> groups{};
  std::set<std::string> texts;
  for (const GeneratedPlan& plan : all_plans()) {
    ++groups[static_cast<std::size_t>(density_group(plan.objects_per_10_m2()))];
    texts.insert(plan.yaml().substr(plan.yaml().find("extent_m")));
  }
  EXPECT_EQ(texts.size(), 201U);
  for (int g = 0; g < kDensityGroups; ++g)
    EXPECT_GE(groups[static_cast<std::size_t>(g)], 8) << density_group_name(g);
}

TEST(Generate, EveryEnvironmentCanBeBuilt) {
  for (const GeneratedPlan& plan : all_plans())
    EXPECT_NO_THROW(count_triangles(plan.yaml(), plan.name)) << plan.name;
}

TEST(Generate, SameSeedSameBytes) {
  for (const GeneratedReference& reference : sample())
    EXPECT_EQ(generate_plan(reference).yaml(), generate_plan(reference).yaml())
        << to_string(reference);
  EXPECT_EQ(digest(generate_scene({"bathroom", 5})), digest(generate_scene({"bathroom", 5})));
  EXPECT_NE(generate_plan({"bathroom", 5}).yaml(), generate_plan({"bathroom", 6}).yaml());
}

/// Distance of a point from the footprint of a rotated box, m.
double distance_m(const Eigen::Vector2d& p, const ItemPlan& item) {
  const Eigen::Vector2d d = p - item.position_m.head<2>();
  const double c = std::cos(item.turn_rad), s = std::sin(item.turn_rad);
  const double u = std::abs(c * d.x() + s * d.y()) - item.size_m.x() / 2;
  const double v = std::abs(c * d.y() - s * d.x()) - item.size_m.y() / 2;
  return std::hypot(std::max(u, 0.0), std::max(v, 0.0));
}

/// Areas of the connected parts of the floor where the center of a disk fits, computed from exact
/// boxes.
std::vector<double> parts_m2(const HousePlan& house, double radius_m) {
  constexpr double kCell = 0.02;
  const RoomPlan& room = house.rooms[0];
  const int w = static_cast<int>((room.rect.x1 - room.rect.x0) / kCell),
            h = static_cast<int>((room.rect.y1 - room.rect.y0) / kCell);
  cv::Mat free(h, w, CV_8UC1, cv::Scalar(255));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const Eigen::Vector2d p(room.rect.x0 + (x + 0.5) * kCell, room.rect.y0 + (y + 0.5) * kCell);
      double room_m = std::min(
          {p.x() - room.rect.x0, room.rect.x1 - p.x(), p.y() - room.rect.y0, room.rect.y1 - p.y()});
      if (room.cut)
        room_m = std::min(room_m,
                          std::hypot(std::max({room.cut->x0 - p.x(), p.x() - room.cut->x1, 0.0}),
                                     std::max({room.cut->y0 - p.y(), p.y() - room.cut->y1, 0.0})));
      for (const ItemPlan& item : house.items)
        if (!item.on && item.size_m.z() > 0.03 && item.position_m.z() < 1.25)
          room_m = std::min(room_m, distance_m(p, item));
      if (room_m < radius_m) free.at<std::uint8_t>(y, x) = 0;
    }
  cv::Mat labels, facts, centers;
  const int count = cv::connectedComponentsWithStats(free, labels, facts, centers, 4);
  std::vector<double> areas;
  for (int k = 1; k < count; ++k)
    areas.push_back(facts.at<int>(k, cv::CC_STAT_AREA) * kCell * kCell);
  return areas;
}

// Bedroom 5 once had 0.14 m2 behind its bed where the robot fitted but which it could not reach.
TEST(Generate, WhereverTheRobotFitsItCanCome) {
  for (const GeneratedPlan& plan : all_plans()) {
    const HousePlan house = read_house_plan(YamlReader::parse(plan.yaml(), plan.name));
    EXPECT_EQ(parts_m2(house, 0.26).size(), 1U) << plan.name;
    EXPECT_EQ(parts_m2(house, 0.29).size(), 1U) << plan.name << " with play";
  }
}

/// Distance from a point of the floor to the nearest ceiling lamp that shines on it, m.
double lamp_m(const HousePlan& house, const Eigen::Vector2d& p) {
  const std::optional<FloorRect>& cut = house.rooms[0].cut;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const ItemPlan& item : house.items) {
    if (item.kind->mount != Mount::kCeiling || !item.glow) continue;
    const Eigen::Vector2d way = item.position_m.head<2>() - p;
    bool hidden = false;
    for (int k = 0; cut && k <= 50; ++k) hidden |= cut->contains(p + way * (k / 50.0));
    if (!hidden) nearest_m = std::min(nearest_m, way.norm());
  }
  return nearest_m;
}

// Hallway 1 once had a 5 m long arm without a lamp: half of the arm's lamp grid was in a wall.
// Hallway 45 is too small for a second grid position.
TEST(Generate, LampsLightBothArmsOfLShapedRooms) {
  std::vector<GeneratedPlan> plans = all_plans();
  plans.push_back(generate_plan({"hallway", 45}));
  int rooms = 0;
  for (const GeneratedPlan& plan : plans) {
    const HousePlan house = read_house_plan(YamlReader::parse(plan.yaml(), plan.name));
    const RoomPlan& room = house.rooms[0];
    if (!room.cut) continue;
    ++rooms;
    for (double y = room.rect.y0 + 0.1; y < room.rect.y1; y += 0.2)
      for (double x = room.rect.x0 + 0.1; x < room.rect.x1; x += 0.2)
        if (!room.cut->contains({x, y})) {
          ASSERT_LT(lamp_m(house, {x, y}), 4.0) << plan.name << " at " << x << ", " << y;
        }
  }
  EXPECT_GE(rooms, 20);
}

TEST(Generate, PicturesOfOneRuleDiffer) {
  const GeneratedPlan plan = generate_plan({"hallway", 0});
  const HousePlan house = read_house_plan(YamlReader::parse(plan.yaml(), plan.name));
  std::set<double> widths;
  std::set<std::uint64_t> images;
  std::size_t pictures = 0;
  for (const ItemPlan& item : house.items) {
    if (item.kind->name != "picture") continue;
    ++pictures;
    widths.insert(item.size_m.x());
    images.insert(item.materials.at("image").seed);
  }
  EXPECT_GE(pictures, 3U);
  EXPECT_EQ(widths.size(), pictures);
  EXPECT_EQ(images.size(), pictures);
}

// The cells where the robot's center can be, found from the triangles alone: whatever is higher
// than a rug and lower than the robot's head is farther away than the robot's radius.
cv::Mat free_floor(const Scene& scene, double radius_m, double cell_m) {
  Eigen::Vector2d high(0, 0);
  for (const Eigen::Vector2d& p : scene.rooms[0].polygon_m) high = high.cwiseMax(p);
  const int w = static_cast<int>(high.x() / cell_m), h = static_cast<int>(high.y() / cell_m);
  cv::Mat open(h, w, CV_8UC1, cv::Scalar(0));
  std::vector<cv::Point> outline;
  for (const Eigen::Vector2d& p : scene.rooms[0].polygon_m)
    outline.emplace_back(static_cast<int>(p.x() / cell_m), static_cast<int>(p.y() / cell_m));
  cv::fillPoly(open, std::vector{outline}, cv::Scalar(255));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (x == 0 || y == 0 || x == w - 1 || y == h - 1) open.at<std::uint8_t>(y, x) = 0;
  for (const auto& t : scene.triangles) {
    const Eigen::Vector3f &a = scene.positions_m[t[0]], &b = scene.positions_m[t[1]],
                          &c = scene.positions_m[t[2]];
    if (std::max({a.z(), b.z(), c.z()}) < 0.03F || std::min({a.z(), b.z(), c.z()}) > 1.25F)
      continue;
    const double edge = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
    const int n = std::max(1, static_cast<int>(std::ceil(edge / cell_m)));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const Eigen::Vector3f p = a + (b - a) * (static_cast<float>(i) / static_cast<float>(n)) +
                                  (c - a) * (static_cast<float>(j) / static_cast<float>(n));
        if (p.z() < 0.03F || p.z() > 1.25F) continue;
        const int x = static_cast<int>(std::floor(p.x() / cell_m)),
                  y = static_cast<int>(std::floor(p.y() / cell_m));
        if (x >= 0 && y >= 0 && x < w && y < h) open.at<std::uint8_t>(y, x) = 0;
      }
  }
  cv::Mat distance, free;
  cv::distanceTransform(open, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::compare(distance, radius_m / cell_m, free, cv::CMP_GT);
  return free;
}

class GeneratedScene : public testing::TestWithParam<GeneratedReference> {};

TEST_P(GeneratedScene, IsWholeAndCanBeWalked) {
  const GeneratedPlan plan = generate_plan(GetParam());
  const std::string text = with_detail(plan);
  const Scene scene = build_house(text, plan.name);
  EXPECT_GE(scene.triangles.size(), 100'000U);
  EXPECT_LE(scene.triangles.size(), 600'000U);
  EXPECT_NEAR(scene.floor_area_m2(), plan.floor_area_m2, 1e-6);

  // Exact boxes: reading a plan rejects overlaps of more than 1 cm; here there must be no overlap
  // at all.
  const HousePlan house = read_house_plan(YamlReader::parse(text, plan.name));
  EXPECT_EQ(static_cast<int>(house.items.size() + house.doorways.size() + house.windows.size()),
            plan.objects + plan.fittings);
  for (std::size_t i = 0; i < house.items.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const ItemPlan &a = house.items[i], &b = house.items[k];
      // An object may touch what carries it, and a chair's box may overlap things on its table.
      const auto carries = [&](std::size_t below, std::size_t above) {
        for (auto on = house.items[above].on; on; on = house.items[*on].on)
          if (*on == below) return true;
        return false;
      };
      if (carries(k, i) || a.under == k || (a.under && a.under == b.on) ||
          (b.under && b.under == a.on))
        continue;
      if ((a.kind->name == "rug") != (b.kind->name == "rug")) continue;
      const double low = std::max(a.position_m.z(), b.position_m.z());
      const double high =
          std::min(a.position_m.z() + a.size_m.z(), b.position_m.z() + b.size_m.z());
      if (high - low <= 1e-6) continue;
      EXPECT_LE(overlap_m(a.footprint(), b.footprint()), 0.0) << a.name << ", " << b.name;
    }

  // The largest free part of the floor covers nearly all of the free area and includes each door.
  constexpr double kCell = 0.025;
  const cv::Mat free = free_floor(scene, 0.26, kCell);
  cv::Mat labels, facts, centers;
  const int parts = cv::connectedComponentsWithStats(free, labels, facts, centers, 4);
  // Closed furniture is free inside, but that is not floor. The area under a table or beside legs
  // is floor: a part is skipped only if most of it is within footprints.
  std::vector<int> inside(static_cast<std::size_t>(parts), 0);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const int k = labels.at<int>(y, x);
      const Eigen::Vector2d p((x + 0.5) * kCell, (y + 0.5) * kCell);
      const auto holds = [&](const ItemPlan& item) {
        const Eigen::Vector2d d = p - item.position_m.head<2>();
        const double c = std::cos(item.turn_rad), s = std::sin(item.turn_rad);
        return !item.on && item.position_m.z() < 0.1 && item.size_m.z() > 0.1 &&
               std::abs(c * d.x() + s * d.y()) < item.size_m.x() / 2 &&
               std::abs(c * d.y() - s * d.x()) < item.size_m.y() / 2;
      };
      if (k > 0 && std::ranges::any_of(house.items, holds)) ++inside[static_cast<std::size_t>(k)];
    }
  double largest = 0, all = 0;
  int best = 0;
  for (int k = 1; k < parts; ++k) {
    if (2 * inside[static_cast<std::size_t>(k)] > facts.at<int>(k, cv::CC_STAT_AREA)) continue;
    const double area = facts.at<int>(k, cv::CC_STAT_AREA) * kCell * kCell;
    all += area;
    if (area > largest) largest = area, best = k;
  }
  EXPECT_GT(largest, 0.05 * plan.floor_area_m2);
  // A place where the robot fits with less than the planned 3 cm of play may be cut off.
  EXPECT_LT(all - largest, 0.03);
  for (const OpeningPlan& door : house.doorways) {
    const double middle = 0.5 * (door.from_m + door.to_m), in = 0.5;
    const FloorRect& r = house.rooms[0].rect;
    const Eigen::Vector2d at = door.side == Side::kSouth   ? Eigen::Vector2d(middle, r.y0 + in)
                               : door.side == Side::kNorth ? Eigen::Vector2d(middle, r.y1 - in)
                               : door.side == Side::kWest  ? Eigen::Vector2d(r.x0 + in, middle)
                                                           : Eigen::Vector2d(r.x1 - in, middle);
    EXPECT_EQ(labels.at<int>(static_cast<int>(at.y() / kCell), static_cast<int>(at.x() / kCell)),
              best)
        << door.name;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryCategory, GeneratedScene, testing::ValuesIn(sample()),
                         [](const auto& test) {
                           return test.param.category + "_" + std::to_string(test.param.seed);
                         });

TEST(Generate, DrawsFromManyMaterialsOfWhichNoneTrainedTheVocabulary) {
  // A plan cannot name the material kinds of scenes/vocabulary_rooms at all.
  for (const auto& [name, list] : palettes().lists)
    for (const PaletteEntry& entry : list)
      EXPECT_NE(std::ranges::find(material_kinds(), entry.kind), material_kinds().end()) << name;
  const HousePlan house =
      read_house_plan(YamlReader::parse(generate_plan({"living_room", 0}).yaml(), "living_room"));
  std::set<std::uint64_t> seeds;
  for (const ItemPlan& item : house.items)
    for (const auto& [role, spec] : item.materials) seeds.insert(spec.seed);
  EXPECT_GE(seeds.size(), 8U);
}

TEST(Generate, IsLoadedByName) {
  const Scene scene = load_scene("generated:bathroom:2");
  EXPECT_EQ(scene.name, "bathroom-2");
  EXPECT_TRUE(std::ranges::any_of(
      scene.instances, [](const Instance& i) { return classes()[i.class_id].name == "toilet"; }));
}

std::string error_of(const std::string& reference) {
  try {
    load_scene(reference);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Generate, RefusesUnknownNames) {
  EXPECT_NE(error_of("generated:cellar:2").find("'cellar' is not a category; there are: bathroom"),
            std::string::npos);
  for (const char* bad : {"generated:bathroom", "generated:bathroom:", "generated:bathroom:x",
                          "generated:bathroom:-1", "generated::2"})
    EXPECT_FALSE(error_of(bad).empty()) << bad;
}

TEST(Generate, ACutCornerMustBeOneAndLeaveAWay) {
  const std::string plan = generate_plan({"hallway", 1}).yaml();
  const std::size_t at = plan.find("    cut: {"), end = plan.find('\n', at);
  const auto error = [&](const std::string& cut) -> std::string {
    try {
      build_house(plan.substr(0, at) + "    cut: {" + cut + "}" + plan.substr(end), "plan.yaml");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(error("corner: north, size_m: [1, 1]").find("'north' is not a corner"),
            std::string::npos);
  EXPECT_NE(error("corner: north_west, size_m: [99, 1]").find("[99, 1] does not leave"),
            std::string::npos);
}

TEST(Generate, CutCornerMakesAnLShapedRoom) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const GeneratedPlan plan = generate_plan({"hallway", 2 * seed + 1});
    const HousePlan house = read_house_plan(YamlReader::parse(plan.yaml(), "hallway"));
    ASSERT_TRUE(house.rooms[0].cut);
    const auto outline = house.rooms[0].outline_m();
    ASSERT_EQ(outline.size(), 6U);
    double twice = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % 6];
      twice += a.x() * b.y() - a.y() * b.x();
      EXPECT_TRUE(a.x() == b.x() || a.y() == b.y());
    }
    EXPECT_NEAR(0.5 * twice, plan.floor_area_m2, 1e-9);  // counter-clockwise
    if (seed > 8) break;
  }
}

std::vector<GeneratedReference> sample_floors() {
  std::vector<GeneratedReference> list;
  for (const FloorGrammar& floor : floors())
    for (std::uint64_t seed = 0; seed < 4; ++seed) list.push_back({floor.name, seed});
  return list;
}

TEST(GenerateFloor, EveryRoomHasTheSameFurnitureAndThingsOfItsOwn) {
  for (const GeneratedReference& reference : sample_floors()) {
    const GeneratedPlan plan = generate_plan(reference);
    EXPECT_EQ(plan.yaml(), generate_plan(reference).yaml());
    const std::vector<RoomEntry>& rooms = plan.house.rooms;
    ASSERT_GE(rooms.size(), 7U) << plan.name;
    EXPECT_EQ(rooms.front().name, "corridor");
    const RoomEntry& first = rooms[1];
    std::size_t common = 0, own = 0;
    for (std::size_t k = 2; k < rooms.size(); ++k) {
      EXPECT_EQ(rooms[k].floor, first.floor);
      EXPECT_EQ(rooms[k].walls, first.walls);
      EXPECT_NEAR(rooms[k].rect.x1 - rooms[k].rect.x0, first.rect.x1 - first.rect.x0, 1e-9);
      const bool turned = rooms[k].rect.y0 < rooms.front().rect.y0;
      bool same = true;  // rooms have the same pieces up to the first piece that only one room has
      for (std::size_t i = 0; i < std::min(rooms[k].items.size(), first.items.size()); ++i) {
        const ItemEntry &a = first.items[i], &b = rooms[k].items[i];
        same = same && a.name == b.name && a.size_m == b.size_m && a.materials == b.materials;
        if (!same) {
          ++own;
          continue;
        }
        ++common;
        if (!a.on.empty()) continue;
        const Eigen::Vector2d in_first = a.at_m - Eigen::Vector2d(first.rect.x0, first.rect.y0);
        const Eigen::Vector2d here =
            turned ? Eigen::Vector2d(rooms[k].rect.x1, rooms[k].rect.y1) - b.at_m
                   : b.at_m - Eigen::Vector2d(rooms[k].rect.x0, rooms[k].rect.y0);
        EXPECT_LT((in_first - here).norm(), 0.0015) << plan.name << " " << b.name;
      }
    }
    EXPECT_GT(common, 10 * (rooms.size() - 2)) << plan.name;
    EXPECT_GT(own, 0U) << plan.name;
  }
  EXPECT_NE(generate_plan({"hotel", 0}).yaml(), generate_plan({"hotel", 1}).yaml());
}

TEST(GenerateFloor, CountsAreThoseOfThePlan) {
  for (const GeneratedReference& reference : sample_floors()) {
    const GeneratedPlan plan = generate_plan(reference);
    const HousePlan house = read_house_plan(YamlReader::parse(with_detail(plan), plan.name));
    EXPECT_EQ(static_cast<int>(house.items.size() + house.doorways.size() + house.windows.size()),
              plan.objects + plan.fittings)
        << plan.name;
    EXPECT_NEAR(generate_scene(reference).floor_area_m2(), plan.floor_area_m2, 1e-6) << plan.name;
    EXPECT_GT(plan.free_share, 0.15) << plan.name;
  }
}

}  // namespace
}  // namespace mh
