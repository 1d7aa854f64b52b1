// SPDX-License-Identifier: Apache-2.0
#include "scenes/house/plan_file.hpp"

#include <fmt/format.h>

#include "scenes/house/plan_parts.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;

GardenPlan read_garden(YamlReader yaml, const Materials& materials) {
  GardenPlan garden;
  garden.material = material_by_name(yaml.at("material"), materials);
  garden.distance_m = yaml.number("distance_m", 1.0, 1000.0);
  garden.height_m = yaml.number("height_m", 0.1, 1000.0);
  garden.glow = yaml.number_or("glow", garden.glow, 0.0);
  yaml.finish();
  return garden;
}

std::string garden_text(const GardenEntry& garden) {
  return fmt::format("garden: {{material: {}, distance_m: {:.1f}, height_m: {:.1f}, glow: {}}}\n",
                     garden.material, garden.distance_m, garden.height_m, garden.glow);
}

void read_lights(YamlReader yaml, HousePlan& house) {
  if (auto sun = yaml.find("sun")) {
    const YamlReader direction = sun->at("direction");
    const std::vector<double> n = direction.as_numbers(3);
    const Vector3d way(n[0], n[1], n[2]);
    if (way.norm() < 1e-6 || way.z() >= 0) direction.fail("must point down");
    house.sun = Light{.kind = Light::Kind::kSun,
                      .direction = way.normalized().cast<float>(),
                      .color = read_light_color(sun->at("color"))};
    sun->finish();
  }
  if (auto sky = yaml.find("sky")) {
    house.sky = Light{.kind = Light::Kind::kSky, .color = read_light_color(sky->at("color"))};
    sky->finish();
  }
  yaml.finish();
}

std::string lights_text(const HouseFile& house) {
  const auto numbers = [](const Vector3d& v) {
    return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", v.x(), v.y(), v.z());
  };
  std::string out = "lights:\n";
  if (const auto& sun = house.sun) {
    const Vector3d& way = sun->direction;
    out += fmt::format("  sun: {{direction: [{:.3f}, {:.3f}, {}], color: {}}}\n", way.x(), way.y(),
                       way.z(), numbers(sun->color));
  }
  if (house.sky) out += fmt::format("  sky: {{color: {}}}\n", numbers(*house.sky));
  return out;
}

}  // namespace

HousePlan read_house_plan(YamlReader yaml) {
  HousePlan house;
  house.name = yaml.string("name");
  const YamlReader extent = yaml.at("extent_m");
  house.extent = read_rect(extent);
  constexpr double kMost_m = 500;
  for (const double meters : {house.extent.x1 - house.extent.x0, house.extent.y1 - house.extent.y0})
    if (meters > kMost_m)
      extent.fail(fmt::format("is {} m long; {} m is the most", meters, kMost_m));
  house.height_m = yaml.number("height_m", 2.0, 10.0);
  house.wall_m = yaml.number("wall_thickness_m", 0.02, 1.0);
  house.detail = yaml.number_or("detail", house.detail, 0.5, 8.0);
  const Materials materials = read_materials(yaml.at("materials"));
  house.trim = material_by_name(yaml.at("trim"), materials);
  house.window_frame = material_by_name(yaml.at("window_frame"), materials);

  std::vector<YamlReader> rooms = yaml.at("rooms").items();
  for (YamlReader& entry : rooms) read_room(entry, materials, house);
  if (const auto doorways = yaml.find("doorways")) read_doorways(*doorways, house);
  if (const auto windows = yaml.find("windows")) read_windows(*windows, house);
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    if (const auto items = rooms[i].find("items")) read_items(*items, materials, i, house);
    rooms[i].finish();
  }
  if (auto garden = yaml.find("garden")) house.garden = read_garden(std::move(*garden), materials);
  if (auto lights = yaml.find("lights")) read_lights(std::move(*lights), house);
  yaml.finish();
  return house;
}

std::string to_yaml(const HouseFile& house) {
  std::string out =
      fmt::format("# {}\nname: {}\nextent_m: {}\nheight_m: {:.3f}\nwall_thickness_m: {}\n\n",
                  house.comment, house.name, rect_text(house.extent), house.height_m, house.wall_m);
  out += materials_text(house.materials);
  out += "\nrooms:\n";
  for (const RoomEntry& room : house.rooms) out += room_text(room);
  out += "\n";
  if (!house.doorways.empty()) out += doorways_text(house);
  if (!house.windows.empty()) out += windows_text(house);
  out += fmt::format("\ntrim: {}\nwindow_frame: {}\n", house.trim, house.window_frame);
  out += garden_text(house.garden) + "\n" + lights_text(house);
  if (house.detail) out += fmt::format("detail: {:.3f}\n", *house.detail);
  return out;
}

}  // namespace mh
