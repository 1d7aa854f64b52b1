// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/class_sets.hpp"

namespace mh {
namespace {

// NYU40's id of the class that represents each of 13 groups.
enum Group : ClassId {
  kWall = 1,
  kFloor = 2,
  kBed = 4,
  kChair = 5,
  kSofa = 6,
  kTable = 7,
  kWindow = 9,
  kPainting = 11,
  kCeiling = 22,
  kBooks = 23,
  kTelevision = 25,
  kFurniture = 39,
  kObjects = 40,
};

constexpr std::array<Group, 41> kGroupOfNyu40 = {
    kObjects,                                         // 0: void, never looked up
    kWall,       kFloor,     kFurniture, kBed,        // wall, floor, cabinet, bed
    kChair,      kSofa,      kTable,     kWall,       // chair, sofa, table, door
    kWindow,     kFurniture, kPainting,  kFurniture,  // window, bookshelf, painting, counter
    kWindow,     kTable,     kFurniture, kWindow,     // blinds, desk, shelves, curtain
    kFurniture,  kObjects,   kObjects,   kFloor,      // dresser, pillow, mirror, floor mat
    kObjects,    kCeiling,   kBooks,     kFurniture,  // clothes, ceiling, books, refrigerator
    kTelevision, kObjects,   kObjects,   kObjects,    // television, paper, towel, shower curtain
    kObjects,    kObjects,   kObjects,   kFurniture,  // box, whiteboard, person, night stand
    kObjects,    kObjects,   kObjects,   kObjects,    // toilet, sink, lamp, bathtub
    kObjects,    kWall,      kFurniture, kObjects,    // bag, otherstructure, ~furniture, ~prop
};

constexpr Group of_five(Group group) {
  switch (group) {
    case kFloor:
    case kCeiling:
      return group;
    case kWall:
    case kWindow:
      return kWall;
    case kBed:
    case kChair:
    case kSofa:
    case kTable:
    case kFurniture:
      return kFurniture;
    default:
      return kObjects;
  }
}

constexpr Group of_two(Group group) {
  const Group five = of_five(group);
  return five == kFurniture || five == kObjects ? kObjects : kWall;
}

}  // namespace

ClassId class_in(ClassSet set, ClassId class_id) {
  if (set == ClassSet::kAll || class_id == kVoid || class_id == kBackground) return class_id;
  const Group group = kGroupOfNyu40.at(classes()[class_id].nyu40);
  return set == ClassSet::kThirteen ? group
         : set == ClassSet::kFive   ? of_five(group)
                                    : of_two(group);
}

}  // namespace mh
