// SPDX-License-Identifier: Apache-2.0
#include "slam/core/labels.hpp"

#include <array>

namespace mh {
namespace {

// NYU40: Gupta et al., CVPR 2013, the mapping shipped with ScanNet; its colors follow ScanNet's
// convention of one fixed color per class. COCO indices: Lin et al., ECCV 2014.
constexpr std::array kClasses = {
    ClassInfo{0, "void", 0, -1, 0, 0, 0},
    ClassInfo{1, "wall", 1, -1, 174, 199, 232},
    ClassInfo{2, "floor", 2, -1, 152, 223, 138},
    ClassInfo{3, "cabinet", 3, -1, 31, 119, 180},
    ClassInfo{4, "bed", 4, 59, 255, 187, 120},
    ClassInfo{5, "chair", 5, 56, 188, 189, 34},
    ClassInfo{6, "sofa", 6, 57, 140, 86, 75},
    ClassInfo{7, "table", 7, 60, 255, 152, 150},
    ClassInfo{8, "door", 8, -1, 214, 39, 40},
    ClassInfo{9, "window", 9, -1, 197, 176, 213},
    ClassInfo{10, "bookshelf", 10, -1, 148, 103, 189},
    ClassInfo{11, "picture", 11, -1, 196, 156, 148},
    ClassInfo{12, "counter", 12, -1, 23, 190, 207},
    ClassInfo{13, "blinds", 13, -1, 178, 76, 76},
    ClassInfo{14, "desk", 14, -1, 247, 182, 210},
    ClassInfo{15, "shelves", 15, -1, 66, 188, 102},
    ClassInfo{16, "curtain", 16, -1, 219, 219, 141},
    ClassInfo{17, "dresser", 17, -1, 140, 57, 197},
    ClassInfo{18, "pillow", 18, -1, 202, 185, 52},
    ClassInfo{19, "mirror", 19, -1, 51, 176, 203},
    ClassInfo{20, "floor mat", 20, -1, 200, 54, 131},
    ClassInfo{21, "clothes", 21, -1, 92, 193, 61},
    ClassInfo{22, "ceiling", 22, -1, 78, 71, 183},
    ClassInfo{23, "books", 23, 73, 172, 114, 82},
    ClassInfo{24, "refridgerator", 24, 72, 255, 127, 14},
    ClassInfo{25, "television", 25, 62, 91, 163, 138},
    ClassInfo{26, "paper", 26, -1, 153, 98, 156},
    ClassInfo{27, "towel", 27, -1, 140, 153, 101},
    ClassInfo{28, "shower curtain", 28, -1, 158, 218, 229},
    ClassInfo{29, "box", 29, -1, 100, 125, 154},
    ClassInfo{30, "whiteboard", 30, -1, 178, 127, 135},
    ClassInfo{31, "person", 31, 0, 120, 185, 128},
    ClassInfo{32, "night stand", 32, -1, 146, 111, 194},
    ClassInfo{33, "toilet", 33, 61, 44, 160, 44},
    ClassInfo{34, "sink", 34, 71, 112, 128, 144},
    ClassInfo{35, "lamp", 35, -1, 96, 207, 209},
    ClassInfo{36, "bathtub", 36, -1, 227, 119, 194},
    ClassInfo{37, "bag", 37, 26, 213, 92, 176},
    ClassInfo{38, "otherstructure", 38, -1, 94, 106, 211},
    ClassInfo{39, "otherfurniture", 39, -1, 82, 84, 163},
    ClassInfo{40, "otherprop", 40, -1, 100, 85, 144},
    ClassInfo{41, "background", 0, -1, 60, 60, 60},
    ClassInfo{42, "oven", 39, 69, 230, 85, 13},
    ClassInfo{43, "potted plant", 40, 58, 49, 163, 84},
    ClassInfo{44, "microwave", 39, 68, 253, 174, 107},
    ClassInfo{45, "clock", 40, 74, 231, 186, 82},
    ClassInfo{46, "vase", 40, 75, 206, 109, 189},
    ClassInfo{47, "bottle", 40, 39, 107, 110, 207},
    ClassInfo{48, "cup", 40, 41, 181, 207, 107},
    ClassInfo{49, "bowl", 40, 45, 214, 97, 107},
    ClassInfo{50, "laptop", 40, 63, 117, 107, 177},
    ClassInfo{51, "keyboard", 40, 66, 99, 121, 57},
    ClassInfo{52, "toaster", 40, 70, 189, 158, 57},
    ClassInfo{53, "teddy bear", 40, 77, 231, 150, 156},
    ClassInfo{54, "bench", 39, 13, 165, 81, 148},
};

constexpr std::array<std::pair<std::string_view, ClassId>, 9> kSynonyms = {{
    {"tv", 25},
    {"refrigerator", 24},
    {"fridge", 24},
    {"couch", 6},
    {"dining table", 7},
    {"book", 23},
    {"plant", 43},
    {"shelf", 15},
    {"backpack", 37},
}};

}  // namespace

std::span<const ClassInfo> classes() {
  return kClasses;
}

std::optional<ClassId> class_by_name(std::string_view name) {
  for (const ClassInfo& info : kClasses)
    if (info.name == name) return info.id;
  for (const auto& [synonym, id] : kSynonyms)
    if (synonym == name) return id;
  return std::nullopt;
}

ClassId ClassDistribution::most_probable() const {
  ClassId best = mh::kVoid;
  float best_probability = 0.0F;
  for (const auto& [id, probability] : entries)
    if (probability > best_probability) {
      best = id;
      best_probability = probability;
    }
  return best;
}

}  // namespace mh
