// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/furniture/furniture.hpp"

/// One function per kind of object; furniture.cpp lists them by name.
namespace mh::build {

// seats.cpp
void bed(Piece& piece);
void sofa(Piece& piece);
void armchair(Piece& piece);
void chair(Piece& piece);
void bench(Piece& piece);
void pillow(Piece& piece);
void teddy_bear(Piece& piece);

// tables.cpp
void dining_table(Piece& piece);
void coffee_table(Piece& piece);
void console_table(Piece& piece);
void desk(Piece& piece);
void night_stand(Piece& piece);

// shelves.cpp
void bookshelf(Piece& piece);
void open_shelf(Piece& piece);
void wall_shelf(Piece& piece);
void shoe_shelf(Piece& piece);
void tv_board(Piece& piece);
void book_stack(Piece& piece);

// cabinets.cpp
void sideboard(Piece& piece);
void dresser(Piece& piece);
void wardrobe(Piece& piece);
void cupboard(Piece& piece);
void box(Piece& piece);

// bathroom.cpp
void toilet(Piece& piece);
void bathtub(Piece& piece);
void shower(Piece& piece);
void washbasin(Piece& piece);
void washing_machine(Piece& piece);
void laundry_basket(Piece& piece);
void trash_can(Piece& piece);
void toilet_paper(Piece& piece);
void radiator(Piece& piece);
void blinds(Piece& piece);

// office.cpp
void office_chair(Piece& piece);
void monitor(Piece& piece);
void keyboard(Piece& piece);
void filing_cabinet(Piece& piece);
void whiteboard(Piece& piece);
void notice_board(Piece& piece);
void copier(Piece& piece);
void printer(Piece& piece);
void paper_stack(Piece& piece);
void mailboxes(Piece& piece);
void conference_table(Piece& piece);
void conference_phone(Piece& piece);
void water_cooler(Piece& piece);
void computer(Piece& piece);
void panel_lamp(Piece& piece);

// public.cpp
void reception_desk(Piece& piece);
void lift_door(Piece& piece);
void magazine_rack(Piece& piece);
void school_desk(Piece& piece);
void school_chair(Piece& piece);
void projector_screen(Piece& piece);
void wall_screen(Piece& piece);
void lockers(Piece& piece);
void fire_extinguisher(Piece& piece);
void storage_shelf(Piece& piece);
void base_counter(Piece& piece);
void vending_machine(Piece& piece);

// sport.cpp
void treadmill(Piece& piece);
void exercise_bike(Piece& piece);
void dumbbell_rack(Piece& piece);
void weight_bench(Piece& piece);
void exercise_ball(Piece& piece);
void yoga_mat(Piece& piece);
void bicycle(Piece& piece);

// household.cpp
void ironing_board(Piece& piece);
void workbench(Piece& piece);
void tool_board(Piece& piece);
void ladder(Piece& piece);
void clothes_rack(Piece& piece);

// leisure.cpp
void pool_table(Piece& piece);
void fireplace(Piece& piece);
void piano(Piece& piece);
void stool(Piece& piece);
void dart_board(Piece& piece);

// kitchen.cpp
void refrigerator(Piece& piece);
void kitchen_counter(Piece& piece);
void oven(Piece& piece);
void range_hood(Piece& piece);
void wall_cabinet(Piece& piece);
void microwave(Piece& piece);
void toaster(Piece& piece);
void kettle(Piece& piece);
void pan(Piece& piece);

// lamps.cpp
void floor_lamp(Piece& piece);
void table_lamp(Piece& piece);
void ceiling_lamp(Piece& piece);
void pendant_lamp(Piece& piece);

// cloth.cpp
void curtain(Piece& piece);
void rug(Piece& piece);
void towel(Piece& piece);
void coat_rack(Piece& piece);
void hook_rail(Piece& piece);
void bag(Piece& piece);

// fixtures.cpp
void socket(Piece& piece);
void trunking(Piece& piece);
void dado_rail(Piece& piece);
void pipes(Piece& piece);
void towel_radiator(Piece& piece);
void tile_panel(Piece& piece);
void fuse_box(Piece& piece);
void sign(Piece& piece);
void calendar(Piece& piece);
void bath_shelf(Piece& piece);
void broom_rack(Piece& piece);

// plants.cpp
void plant_tall(Piece& piece);
void plant_bushy(Piece& piece);

// things.cpp
void television(Piece& piece);
void laptop(Piece& piece);
void picture(Piece& piece);
void photo_frame(Piece& piece);
void mirror(Piece& piece);
void light_switch(Piece& piece);
void wall_papers(Piece& piece);
void clock(Piece& piece);
void bottle(Piece& piece);
void cup(Piece& piece);
void bowl(Piece& piece);
void vase(Piece& piece);

}  // namespace mh::build

namespace mh::build {

// parts.cpp: common materials, and parts shared by several kinds.
MaterialSpec oak(std::uint64_t seed = 15);
MaterialSpec bare_steel();
MaterialSpec black_rubber();
MaterialSpec plain(std::string kind, Rgb8 tone, double variation = 0.3, std::uint64_t seed = 1);
/// An upright rectangle that faces -y: the area that a door or a drawer covers.
struct Front {
  float x0, x1, y, z0, z1;
};
/// Space for books of at most `height` and `depth` that stand at height z, with their spines at y =
/// front (facing -y).
struct BookSpace {
  float x0, x1, front, z, height, depth;
};
/// Adds a row of books to the current object.
void books(Piece& piece, const BookSpace& space, std::uint64_t row);
/// An ellipse (square = 1), or a shape closer to a rectangle (square < 1).
struct Oval {
  float radius_x_m, radius_y_m, square = 1.0F;
};
/// A round body with this cross section. The profile lists pairs (share of the radii, height above
/// `center`) from bottom to top; the faces point outward.
void oval(Piece& piece, MaterialId material, const Eigen::Vector3f& center, const Oval& section,
          std::span<const Eigen::Vector2f> profile, int sides = 28);
/// The material of handles: the role `metal`.
MaterialId grip_metal(Piece& piece);
/// A bar handle from a to b, at a distance `off` along -y.
void handle(Piece& piece, MaterialId material, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
            float off = 0.03F);

}  // namespace mh::build
