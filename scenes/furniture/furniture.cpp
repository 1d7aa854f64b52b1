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
    kind("bed", "bed", kFloor, "wood linen duvet", 1.30F, 2.06F, 0.88F, build::bed),
    kind("bench", "bench", kFloor, "wood", 1.0F, 0.38F, 0.44F, build::bench),
    kind("book_stack", "books", kOnPiece, "", 0.26F, 0.20F, 0.10F, build::book_stack),
    kind("bookshelf", "bookshelf", kFloor, "wood", 1.0F, 0.30F, 1.90F, build::bookshelf),
    kind("bottle", "bottle", kOnPiece, "glass", 0.075F, 0.075F, 0.28F, build::bottle),
    kind("bowl", "bowl", kOnPiece, "body", 0.22F, 0.22F, 0.09F, build::bowl),
    kind("box", "box", kFloor, "body", 0.40F, 0.36F, 0.30F, build::box),
    kind("ceiling_lamp", "lamp", kCeiling, "wood", 0.46F, 0.46F, 0.12F, build::ceiling_lamp, -2.6F),
    kind("chair", "chair", kFloor, "wood", 0.44F, 0.46F, 0.88F, build::chair),
    kind("clock", "clock", kWall, "frame", 0.30F, 0.04F, 0.30F, build::clock),
    kind("coat_rack", "otherfurniture", kWall, "wood", 1.1F, 0.24F, 0.95F, build::coat_rack),
    kind("coffee_table", "table", kFloor, "wood", 0.9F, 0.6F, 0.40F, build::coffee_table),
    kind("console_table", "table", kFloor, "wood", 1.05F, 0.34F, 0.80F, build::console_table),
    kind("cup", "cup", kOnPiece, "body", 0.11F, 0.08F, 0.09F, build::cup),
    kind("cupboard", "cabinet", kFloor, "wood metal china", 0.9F, 0.42F, 1.90F, build::cupboard),
    kind("curtain", "curtain", kWall, "fabric rod", 0.44F, 0.10F, 2.27F, build::curtain),
    kind("desk", "desk", kFloor, "wood", 1.0F, 0.5F, 0.73F, build::desk),
    kind("dining_table", "table", kFloor, "wood", 1.3F, 0.8F, 0.73F, build::dining_table),
    kind("dresser", "dresser", kFloor, "wood metal", 1.05F, 0.45F, 0.80F, build::dresser),
    kind("floor_lamp", "lamp", kFloor, "metal shade", 0.34F, 0.34F, 1.62F, build::floor_lamp,
         0.96F),
    kind("kettle", "otherprop", kOnPiece, "body", 0.24F, 0.17F, 0.24F, build::kettle),
    kind("kitchen_counter", "counter", kFloor, "wood top", 1.75F, 0.62F, 0.86F,
         build::kitchen_counter),
    kind("laptop", "laptop", kOnPiece, "body screen", 0.34F, 0.30F, 0.23F, build::laptop),
    kind("microwave", "microwave", kOnPiece, "body", 0.48F, 0.36F, 0.28F, build::microwave),
    kind("mirror", "mirror", kWall, "frame glass", 0.5F, 0.03F, 1.5F, build::mirror),
    kind("night_stand", "night stand", kFloor, "wood", 0.44F, 0.40F, 0.50F, build::night_stand),
    kind("open_shelf", "shelves", kFloor, "wood", 0.9F, 0.34F, 1.60F, build::open_shelf),
    kind("oven", "oven", kFloor, "body", 0.60F, 0.62F, 0.86F, build::oven),
    kind("pan", "otherprop", kOnPiece, "body", 0.40F, 0.24F, 0.08F, build::pan),
    kind("pendant_lamp", "lamp", kCeiling, "dome", 0.42F, 0.42F, 0.85F, build::pendant_lamp, 0.0F),
    kind("photo_frame", "picture", kOnPiece, "image frame", 0.20F, 0.10F, 0.26F,
         build::photo_frame),
    kind("picture", "picture", kWall, "image frame", 0.6F, 0.03F, 0.45F, build::picture),
    kind("pillow", "pillow", kOnPiece, "fabric", 0.42F, 0.20F, 0.36F, build::pillow),
    kind("plant_bushy", "potted plant", kFloor, "pot leaves", 0.46F, 0.46F, 0.75F,
         build::plant_bushy),
    kind("plant_tall", "potted plant", kFloor, "pot leaves", 0.46F, 0.46F, 1.45F,
         build::plant_tall),
    kind("range_hood", "otherstructure", kWall, "body", 0.56F, 0.46F, 0.93F, build::range_hood),
    kind("refrigerator", "refridgerator", kFloor, "body door", 0.66F, 0.68F, 1.78F,
         build::refrigerator),
    kind("rug", "floor mat", kFloor, "top", 2.0F, 1.4F, 0.01F, build::rug),
    kind("shoe_shelf", "shelves", kFloor, "wood", 1.1F, 0.35F, 0.95F, build::shoe_shelf),
    kind("sideboard", "cabinet", kFloor, "wood metal", 1.3F, 0.42F, 0.80F, build::sideboard),
    kind("sofa", "sofa", kFloor, "fabric wood", 1.8F, 0.86F, 0.80F, build::sofa),
    kind("table_lamp", "lamp", kOnPiece, "base shade", 0.26F, 0.26F, 0.45F, build::table_lamp,
         0.78F),
    kind("teddy_bear", "teddy bear", kOnPiece, "fur", 0.22F, 0.20F, 0.30F, build::teddy_bear),
    kind("television", "television", kOnPiece, "screen", 1.12F, 0.22F, 0.70F, build::television),
    kind("toaster", "toaster", kOnPiece, "body", 0.28F, 0.18F, 0.19F, build::toaster),
    kind("towel", "towel", kWall, "fabric", 0.36F, 0.07F, 0.62F, build::towel),
    kind("tv_board", "cabinet", kFloor, "wood metal", 1.6F, 0.40F, 0.45F, build::tv_board),
    kind("vase", "vase", kOnPiece, "body", 0.15F, 0.15F, 0.30F, build::vase),
    kind("wall_cabinet", "cabinet", kWall, "wood", 0.9F, 0.34F, 0.6F, build::wall_cabinet),
    kind("wall_shelf", "shelves", kWall, "wood", 0.9F, 0.22F, 0.32F, build::wall_shelf),
    kind("wardrobe", "dresser", kFloor, "wood metal", 1.2F, 0.58F, 2.1F, build::wardrobe),
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
