// SPDX-License-Identifier: Apache-2.0
#include "slam/core/labels.hpp"

#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>

#include <gtest/gtest.h>

namespace mh {
namespace {

// Names and colors of NYU40 classes 1 to 40, as in ScanNet's scripts (util.py).
struct Published {
  const char* name;
  int r, g, b;
};
constexpr std::array<Published, 40> kNyu40 = {
    {{"wall", 174, 199, 232},         {"floor", 152, 223, 138},
     {"cabinet", 31, 119, 180},       {"bed", 255, 187, 120},
     {"chair", 188, 189, 34},         {"sofa", 140, 86, 75},
     {"table", 255, 152, 150},        {"door", 214, 39, 40},
     {"window", 197, 176, 213},       {"bookshelf", 148, 103, 189},
     {"picture", 196, 156, 148},      {"counter", 23, 190, 207},
     {"blinds", 178, 76, 76},         {"desk", 247, 182, 210},
     {"shelves", 66, 188, 102},       {"curtain", 219, 219, 141},
     {"dresser", 140, 57, 197},       {"pillow", 202, 185, 52},
     {"mirror", 51, 176, 203},        {"floor mat", 200, 54, 131},
     {"clothes", 92, 193, 61},        {"ceiling", 78, 71, 183},
     {"books", 172, 114, 82},         {"refridgerator", 255, 127, 14},
     {"television", 91, 163, 138},    {"paper", 153, 98, 156},
     {"towel", 140, 153, 101},        {"shower curtain", 158, 218, 229},
     {"box", 100, 125, 154},          {"whiteboard", 178, 127, 135},
     {"person", 120, 185, 128},       {"night stand", 146, 111, 194},
     {"toilet", 44, 160, 44},         {"sink", 112, 128, 144},
     {"lamp", 96, 207, 209},          {"bathtub", 227, 119, 194},
     {"bag", 213, 92, 176},           {"otherstructure", 94, 106, 211},
     {"otherfurniture", 82, 84, 163}, {"otherprop", 100, 85, 144}}};

// Those of COCO's 80 classes that are found indoors, by their index in the usual list, starting at
// 0.
const std::map<int, std::string_view> kCoco80 = {
    {0, "person"},        {13, "bench"},  {26, "bag"},     {39, "bottle"},    {41, "cup"},
    {45, "bowl"},         {56, "chair"},  {57, "couch"},   {58, "plant"},     {59, "bed"},
    {60, "dining table"}, {61, "toilet"}, {62, "tv"},      {63, "laptop"},    {66, "keyboard"},
    {68, "microwave"},    {69, "oven"},   {70, "toaster"}, {71, "sink"},      {72, "refrigerator"},
    {73, "book"},         {74, "clock"},  {75, "vase"},    {77, "teddy bear"}};

TEST(Classes, TheFirstFortyAreThoseOfNyu40InScanNetsColors) {
  ASSERT_GT(classes().size(), kNyu40.size());
  for (std::size_t i = 0; i < kNyu40.size(); ++i) {
    const ClassInfo& info = classes()[i + 1];
    EXPECT_EQ(info.name, kNyu40[i].name);
    EXPECT_EQ(info.nyu40, i + 1) << info.name;
    EXPECT_EQ(std::tuple(info.r, info.g, info.b), std::tuple(kNyu40[i].r, kNyu40[i].g, kNyu40[i].b))
        << info.name;
  }
}

TEST(Classes, EachOfCocosIsUnderItsIndexOnce) {
  std::map<int, ClassId> seen;
  for (const ClassInfo& info : classes()) {
    if (info.coco80 == -1) continue;
    EXPECT_TRUE(seen.emplace(info.coco80, info.id).second) << info.name;
  }
  ASSERT_EQ(seen.size(), kCoco80.size());
  for (const auto& [index, name] : kCoco80) {
    ASSERT_TRUE(class_by_name(name)) << name;
    EXPECT_EQ(*class_by_name(name), seen[index]) << name;
  }
}

TEST(Classes, AreInOrderEachWithANameAndAColorOfItsOwn) {
  std::set<std::string_view> names;
  std::set<std::tuple<int, int, int>> colors;
  for (std::size_t i = 0; i < classes().size(); ++i) {
    const ClassInfo& info = classes()[i];
    EXPECT_EQ(info.id, i);
    EXPECT_EQ(class_by_name(info.name), info.id);
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_TRUE(colors.emplace(info.r, info.g, info.b).second) << info.name;
    // Classes that NYU40 lacks map to otherfurniture or otherprop; void and background map to
    // neither.
    if (i > kNyu40.size()) {
      EXPECT_EQ(info.nyu40 == 39 || info.nyu40 == 40, i != kBackground) << info.name;
    }
  }
  EXPECT_EQ(classes()[kVoid].name, "void");
  EXPECT_EQ(classes()[kBackground].name, "background");
  EXPECT_EQ(classes()[kVoid].nyu40, 0);
  EXPECT_EQ(classes()[kBackground].nyu40, 0);
  EXPECT_FALSE(class_by_name("unheard of"));
  EXPECT_FALSE(class_by_name(""));
}

TEST(ClassDistribution, TheMostProbableIsTheSmallestIdAmongEquals) {
  EXPECT_EQ(ClassDistribution{}.most_probable(), kVoid);
  EXPECT_EQ(ClassDistribution::one_hot(7).most_probable(), 7);
  EXPECT_EQ(ClassDistribution::one_hot(kVoid), ClassDistribution{});
  EXPECT_EQ((ClassDistribution{{{3, 0.25F}, {5, 0.5F}, {9, 0.25F}}}).most_probable(), 5);
  EXPECT_EQ((ClassDistribution{{{3, 0.5F}, {5, 0.5F}}}).most_probable(), 3);
  EXPECT_EQ((ClassDistribution{{{3, 0.0F}}}).most_probable(), kVoid);
}

}  // namespace
}  // namespace mh
