// SPDX-License-Identifier: Apache-2.0
#include "scenes/furniture/furniture.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "scenes/furniture/builders.hpp"

namespace mh {
namespace {

using enum Mount;

// Roles must name every material that the builder asks for with Piece::material.
constexpr auto kind = [](std::string_view name, std::string_view class_name, Mount mount,
                         std::string_view roles, float w, float d, float h, void (*build)(Piece&),
                         std::optional<float> bulb = std::nullopt) {
  return FurnitureKind{name, class_name, mount, roles, {w, d, h}, build, bulb};
};

const std::array kKinds = {
    kind("armchair", "chair", kFloor, "fabric wood", 0.76F, 0.80F, 0.82F, build::armchair),
    kind("bag", "bag", kOnPiece, "body", 0.36F, 0.16F, 0.38F, build::bag),
    kind("base_counter", "counter", kFloor, "wood top", 1.20F, 0.62F, 0.88F, build::base_counter),
    kind("bath_shelf", "shelves", kWall, "wood fabric", 0.55F, 0.16F, 0.50F, build::bath_shelf),
    kind("bathtub", "bathtub", kFloor, "body", 1.6F, 0.74F, 0.56F, build::bathtub),
    kind("bed", "bed", kFloor, "wood linen duvet", 1.30F, 2.06F, 0.88F, build::bed),
    kind("bench", "bench", kFloor, "wood", 1.0F, 0.38F, 0.44F, build::bench),
    kind("bicycle", "otherprop", kFloor, "body", 1.70F, 0.58F, 1.05F, build::bicycle),
    kind("blinds", "blinds", kWall, "body", 1.0F, 0.05F, 0.8F, build::blinds),
    kind("book_stack", "books", kOnPiece, "", 0.26F, 0.20F, 0.10F, build::book_stack),
    kind("bookshelf", "bookshelf", kFloor, "wood", 1.0F, 0.30F, 1.90F, build::bookshelf),
    kind("bottle", "bottle", kOnPiece, "glass", 0.075F, 0.075F, 0.28F, build::bottle),
    kind("bowl", "bowl", kOnPiece, "body", 0.22F, 0.22F, 0.09F, build::bowl),
    kind("box", "box", kFloor, "body", 0.40F, 0.36F, 0.30F, build::box),
    kind("broom_rack", "otherprop", kWall, "wood", 0.60F, 0.12F, 1.50F, build::broom_rack),
    kind("calendar", "paper", kWall, "", 0.30F, 0.006F, 0.45F, build::calendar),
    kind("ceiling_lamp", "lamp", kCeiling, "wood", 0.46F, 0.46F, 0.12F, build::ceiling_lamp, -2.6F),
    kind("chair", "chair", kFloor, "wood", 0.44F, 0.46F, 0.88F, build::chair),
    kind("clock", "clock", kWall, "frame", 0.30F, 0.04F, 0.30F, build::clock),
    kind("clothes_rack", "otherfurniture", kFloor, "metal", 1.20F, 0.50F, 1.65F,
         build::clothes_rack),
    kind("coat_rack", "otherfurniture", kWall, "wood", 1.1F, 0.24F, 0.95F, build::coat_rack),
    kind("coffee_table", "table", kFloor, "wood", 0.9F, 0.6F, 0.40F, build::coffee_table),
    kind("computer", "otherprop", kFloor, "body", 0.20F, 0.44F, 0.42F, build::computer),
    kind("conference_phone", "otherprop", kOnPiece, "", 0.28F, 0.28F, 0.07F,
         build::conference_phone),
    kind("conference_table", "table", kFloor, "wood metal", 2.8F, 1.2F, 0.74F,
         build::conference_table),
    kind("console_table", "table", kFloor, "wood", 1.05F, 0.34F, 0.80F, build::console_table),
    kind("copier", "otherprop", kFloor, "body", 1.0F, 0.75F, 1.15F, build::copier),
    kind("cup", "cup", kOnPiece, "body", 0.11F, 0.08F, 0.09F, build::cup),
    kind("cupboard", "cabinet", kFloor, "wood metal china", 0.9F, 0.42F, 1.90F, build::cupboard),
    kind("curtain", "curtain", kWall, "fabric rod", 0.44F, 0.10F, 2.27F, build::curtain),
    kind("dado_rail", "otherstructure", kWall, "wood", 2.0F, 0.022F, 0.08F, build::dado_rail),
    kind("dart_board", "otherprop", kWall, "", 0.45F, 0.05F, 0.45F, build::dart_board),
    kind("desk", "desk", kFloor, "wood", 1.0F, 0.5F, 0.73F, build::desk),
    kind("dining_table", "table", kFloor, "wood", 1.3F, 0.8F, 0.73F, build::dining_table),
    kind("dresser", "dresser", kFloor, "wood metal", 1.05F, 0.45F, 0.80F, build::dresser),
    kind("dumbbell_rack", "otherfurniture", kFloor, "metal", 1.40F, 0.55F, 0.95F,
         build::dumbbell_rack),
    kind("exercise_ball", "otherprop", kFloor, "body", 0.60F, 0.60F, 0.60F, build::exercise_ball),
    kind("exercise_bike", "otherfurniture", kFloor, "body", 0.50F, 1.05F, 1.20F,
         build::exercise_bike),
    kind("filing_cabinet", "cabinet", kFloor, "body", 0.46F, 0.62F, 1.32F, build::filing_cabinet),
    kind("fire_extinguisher", "otherprop", kWall, "", 0.22F, 0.20F, 0.55F,
         build::fire_extinguisher),
    kind("fireplace", "otherstructure", kFloor, "top", 1.40F, 0.40F, 1.10F, build::fireplace),
    kind("floor_lamp", "lamp", kFloor, "metal shade", 0.34F, 0.34F, 1.62F, build::floor_lamp,
         0.96F),
    kind("fuse_box", "otherstructure", kWall, "body", 0.40F, 0.10F, 0.50F, build::fuse_box),
    kind("hook_rail", "otherfurniture", kWall, "wood", 0.80F, 0.12F, 0.85F, build::hook_rail),
    kind("ironing_board", "otherfurniture", kFloor, "fabric", 1.25F, 0.38F, 0.88F,
         build::ironing_board),
    kind("kettle", "otherprop", kOnPiece, "body", 0.24F, 0.17F, 0.24F, build::kettle),
    kind("keyboard", "keyboard", kOnPiece, "body", 0.44F, 0.15F, 0.025F, build::keyboard),
    kind("kitchen_counter", "counter", kFloor, "wood top", 1.75F, 0.62F, 0.86F,
         build::kitchen_counter),
    kind("ladder", "otherprop", kFloor, "metal", 0.50F, 0.70F, 1.40F, build::ladder),
    kind("laptop", "laptop", kOnPiece, "body screen", 0.34F, 0.30F, 0.23F, build::laptop),
    kind("laundry_basket", "otherprop", kFloor, "body fabric", 0.44F, 0.34F, 0.50F,
         build::laundry_basket),
    kind("lift_door", "door", kWall, "metal", 1.30F, 0.12F, 2.25F, build::lift_door),
    kind("light_switch", "otherstructure", kWall, "body", 0.085F, 0.014F, 0.085F,
         build::light_switch),
    kind("lockers", "cabinet", kFloor, "body", 1.24F, 0.50F, 1.90F, build::lockers),
    kind("magazine_rack", "shelves", kFloor, "wood", 0.90F, 0.34F, 1.50F, build::magazine_rack),
    kind("mailboxes", "shelves", kFloor, "wood", 1.6F, 0.36F, 1.5F, build::mailboxes),
    kind("microwave", "microwave", kOnPiece, "body", 0.48F, 0.36F, 0.28F, build::microwave),
    kind("mirror", "mirror", kWall, "frame glass", 0.5F, 0.03F, 1.5F, build::mirror),
    kind("monitor", "television", kOnPiece, "body screen", 0.54F, 0.20F, 0.46F, build::monitor),
    kind("night_stand", "night stand", kFloor, "wood", 0.44F, 0.40F, 0.50F, build::night_stand),
    kind("notice_board", "picture", kWall, "face frame", 1.2F, 0.03F, 0.9F, build::notice_board),
    kind("office_chair", "chair", kFloor, "fabric", 0.62F, 0.62F, 1.02F, build::office_chair),
    kind("open_shelf", "shelves", kFloor, "wood", 0.9F, 0.34F, 1.60F, build::open_shelf),
    kind("oven", "oven", kFloor, "body", 0.60F, 0.62F, 0.86F, build::oven),
    kind("pan", "otherprop", kOnPiece, "body", 0.40F, 0.24F, 0.08F, build::pan),
    kind("panel_lamp", "lamp", kCeiling, "rim", 1.2F, 0.3F, 0.05F, build::panel_lamp, -3.0F),
    kind("paper_stack", "paper", kOnPiece, "", 0.23F, 0.31F, 0.06F, build::paper_stack),
    kind("pendant_lamp", "lamp", kCeiling, "dome", 0.42F, 0.42F, 0.85F, build::pendant_lamp, 0.0F),
    kind("photo_frame", "picture", kOnPiece, "image frame", 0.20F, 0.10F, 0.26F,
         build::photo_frame),
    kind("piano", "otherfurniture", kFloor, "wood", 1.48F, 0.62F, 1.20F, build::piano),
    kind("picture", "picture", kWall, "image frame", 0.6F, 0.03F, 0.45F, build::picture),
    kind("pillow", "pillow", kOnPiece, "fabric", 0.42F, 0.20F, 0.36F, build::pillow),
    kind("pipes", "otherstructure", kWall, "metal", 0.80F, 0.06F, 1.60F, build::pipes),
    kind("plant_bushy", "potted plant", kFloor, "pot leaves", 0.46F, 0.46F, 0.75F,
         build::plant_bushy),
    kind("plant_tall", "potted plant", kFloor, "pot leaves", 0.46F, 0.46F, 1.45F,
         build::plant_tall),
    kind("pool_table", "table", kFloor, "wood fabric", 2.40F, 1.35F, 0.82F, build::pool_table),
    kind("printer", "otherprop", kOnPiece, "body", 0.44F, 0.42F, 0.28F, build::printer),
    kind("projector_screen", "otherprop", kWall, "body", 1.90F, 0.10F, 1.50F,
         build::projector_screen),
    kind("radiator", "otherstructure", kWall, "body", 1.0F, 0.11F, 0.6F, build::radiator),
    kind("range_hood", "otherstructure", kWall, "body", 0.56F, 0.46F, 0.93F, build::range_hood),
    kind("reception_desk", "counter", kFloor, "wood top", 2.20F, 0.80F, 1.10F,
         build::reception_desk),
    kind("refrigerator", "refridgerator", kFloor, "body door", 0.66F, 0.68F, 1.78F,
         build::refrigerator),
    kind("rug", "floor mat", kFloor, "top", 2.0F, 1.4F, 0.01F, build::rug),
    kind("school_chair", "chair", kFloor, "body metal", 0.44F, 0.48F, 0.82F, build::school_chair),
    kind("school_desk", "desk", kFloor, "wood metal", 0.70F, 0.50F, 0.74F, build::school_desk),
    kind("shoe_shelf", "shelves", kFloor, "wood", 1.1F, 0.35F, 0.95F, build::shoe_shelf),
    kind("shower", "otherstructure", kFloor, "body wall fabric", 0.9F, 0.9F, 2.05F, build::shower),
    kind("sideboard", "cabinet", kFloor, "wood metal", 1.3F, 0.42F, 0.80F, build::sideboard),
    kind("sign", "otherprop", kWall, "", 0.30F, 0.010F, 0.16F, build::sign),
    kind("socket", "otherstructure", kWall, "body", 0.17F, 0.06F, 0.32F, build::socket),
    kind("sofa", "sofa", kFloor, "fabric wood", 1.8F, 0.86F, 0.80F, build::sofa),
    kind("stool", "chair", kFloor, "fabric metal", 0.36F, 0.36F, 0.70F, build::stool),
    kind("storage_shelf", "shelves", kFloor, "metal", 1.10F, 0.46F, 1.90F, build::storage_shelf),
    kind("table_lamp", "lamp", kOnPiece, "base shade", 0.26F, 0.26F, 0.45F, build::table_lamp,
         0.78F),
    kind("teddy_bear", "teddy bear", kOnPiece, "fur", 0.22F, 0.20F, 0.30F, build::teddy_bear),
    kind("television", "television", kOnPiece, "screen", 1.12F, 0.22F, 0.70F, build::television),
    kind("tile_panel", "otherstructure", kWall, "tiles", 1.2F, 0.012F, 0.6F, build::tile_panel),
    kind("toaster", "toaster", kOnPiece, "body", 0.28F, 0.18F, 0.19F, build::toaster),
    kind("toilet", "toilet", kFloor, "body seat", 0.40F, 0.70F, 0.78F, build::toilet),
    kind("toilet_paper", "otherprop", kWall, "", 0.16F, 0.12F, 0.14F, build::toilet_paper),
    kind("tool_board", "otherprop", kWall, "wood", 1.30F, 0.10F, 0.80F, build::tool_board),
    kind("towel", "towel", kWall, "fabric", 0.36F, 0.07F, 0.62F, build::towel),
    kind("towel_radiator", "otherstructure", kWall, "body fabric", 0.50F, 0.12F, 1.10F,
         build::towel_radiator),
    kind("trash_can", "otherprop", kFloor, "body", 0.28F, 0.28F, 0.36F, build::trash_can),
    kind("treadmill", "otherfurniture", kFloor, "body", 0.80F, 1.75F, 1.35F, build::treadmill),
    kind("trunking", "otherstructure", kWall, "body", 2.0F, 0.07F, 0.14F, build::trunking),
    kind("tv_board", "cabinet", kFloor, "wood metal", 1.6F, 0.40F, 0.45F, build::tv_board),
    kind("vase", "vase", kOnPiece, "body", 0.15F, 0.15F, 0.30F, build::vase),
    kind("vending_machine", "otherfurniture", kFloor, "body", 0.95F, 0.82F, 1.85F,
         build::vending_machine),
    kind("wall_cabinet", "cabinet", kWall, "wood", 0.9F, 0.34F, 0.6F, build::wall_cabinet),
    kind("wall_papers", "paper", kWall, "", 0.7F, 0.006F, 0.6F, build::wall_papers),
    kind("wall_screen", "television", kWall, "screen", 1.30F, 0.09F, 0.76F, build::wall_screen),
    kind("wall_shelf", "shelves", kWall, "wood", 0.9F, 0.22F, 0.32F, build::wall_shelf),
    kind("wardrobe", "dresser", kFloor, "wood metal", 1.2F, 0.58F, 2.1F, build::wardrobe),
    kind("washbasin", "cabinet", kFloor, "body wood", 0.7F, 0.48F, 0.86F, build::washbasin),
    kind("washing_machine", "otherfurniture", kFloor, "body", 0.60F, 0.62F, 0.85F,
         build::washing_machine),
    kind("water_cooler", "otherprop", kFloor, "body", 0.34F, 0.36F, 1.35F, build::water_cooler),
    kind("weight_bench", "otherfurniture", kFloor, "fabric metal", 1.50F, 1.50F, 1.10F,
         build::weight_bench),
    kind("whiteboard", "whiteboard", kWall, "face frame", 1.8F, 0.09F, 1.2F, build::whiteboard),
    kind("workbench", "table", kFloor, "wood", 1.60F, 0.65F, 0.90F, build::workbench),
    kind("yoga_mat", "floor mat", kFloor, "top", 0.60F, 1.75F, 0.01F, build::yoga_mat),
};

}  // namespace

MaterialId Piece::material(const std::string& role, MaterialSpec usual,
                           const Eigen::Vector3f& emission) {
  const auto found = materials_.find(role);
  if (found == materials_.end()) return mesh.material(usual, emission);
  MaterialSpec chosen = found->second;
  chosen.size_m = usual.size_m;
  return mesh.material(chosen, emission);
}

void Piece::part(const std::string& suffix, std::string_view class_name) {
  const auto id = class_by_name(class_name);
  assert(id);
  mesh.begin_instance(name_ + "/" + suffix, *id);
}

std::span<const FurnitureKind> furniture_kinds() {
  return kKinds;
}

const FurnitureKind* find_furniture(std::string_view name) {
  const auto found = std::ranges::find(kKinds, name, &FurnitureKind::name);
  return found == kKinds.end() ? nullptr : &*found;
}

}  // namespace mh
