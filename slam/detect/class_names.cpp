// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/class_names.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "slam/core/counted.hpp"
#include "slam/core/error.hpp"
#include "slam/core/lower_case.hpp"
#include "slam/core/text_file.hpp"

namespace mh {
namespace {

constexpr std::array<const char*, 80> kCoco80 = {"person",        "bicycle",      "car",
                                                 "motorcycle",    "airplane",     "bus",
                                                 "train",         "truck",        "boat",
                                                 "traffic light", "fire hydrant", "stop sign",
                                                 "parking meter", "bench",        "bird",
                                                 "cat",           "dog",          "horse",
                                                 "sheep",         "cow",          "elephant",
                                                 "bear",          "zebra",        "giraffe",
                                                 "backpack",      "umbrella",     "handbag",
                                                 "tie",           "suitcase",     "frisbee",
                                                 "skis",          "snowboard",    "sports ball",
                                                 "kite",          "baseball bat", "baseball glove",
                                                 "skateboard",    "surfboard",    "tennis racket",
                                                 "bottle",        "wine glass",   "cup",
                                                 "fork",          "knife",        "spoon",
                                                 "bowl",          "banana",       "apple",
                                                 "sandwich",      "orange",       "broccoli",
                                                 "carrot",        "hot dog",      "pizza",
                                                 "donut",         "cake",         "chair",
                                                 "couch",         "potted plant", "bed",
                                                 "dining table",  "toilet",       "tv",
                                                 "laptop",        "mouse",        "remote",
                                                 "keyboard",      "cell phone",   "microwave",
                                                 "oven",          "toaster",      "sink",
                                                 "refrigerator",  "book",         "clock",
                                                 "vase",          "scissors",     "teddy bear",
                                                 "hair drier",    "toothbrush"};

// The category ids up to 90 that COCO's annotations leave out.
constexpr std::array kNoCategory = {12, 26, 29, 30, 45, 66, 68, 69, 71, 83};

// Names of networks for classes that class_by_name() knows by another.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kAlsoCalled = {{
    {"tvmonitor", "television"},
    {"pottedplant", "potted plant"},
    {"diningtable", "table"},
    {"handbag", "bag"},
    {"suitcase", "bag"},
    {"teddybear", "teddy bear"},
}};

ClassId class_named(std::string name) {
  name = lower_case(std::move(name));
  std::ranges::replace(name, '_', ' ');
  for (const auto& [also, ours] : kAlsoCalled)
    if (also == name) name = ours;
  return class_by_name(name).value_or(kVoid);
}

}  // namespace

std::string ClassNames::unknown_note(const std::filesystem::path& of) const {
  if (std::ranges::any_of(ids, [](ClassId id) { return id != kVoid; })) return "";
  return fmt::format("{}: none of its {} has the name of a class of ours: all labels stay void",
                     of.string(), counted(size(), "class", "classes"));
}

const ClassNames& coco80() {
  static const ClassNames kNames = [] {
    ClassNames all;
    for (const char* name : kCoco80) {
      all.names.emplace_back(name);
      all.ids.push_back(class_named(name));
    }
    return all;
  }();
  return kNames;
}

int coco80_of_category(int category_id) {
  if (category_id < 1 || category_id > 90 || std::ranges::count(kNoCategory, category_id) > 0)
    return -1;
  const auto skipped = std::ranges::count_if(kNoCategory, [&](int no) { return no < category_id; });
  return category_id - 1 - static_cast<int>(skipped);
}

ClassNames load_class_names(const std::filesystem::path& file) {
  ClassNames all;
  std::istringstream text(read_text(file));
  for (std::string line; std::getline(text, line);) {
    const auto first = line.find_first_not_of(" \t\r");
    line = first == line.npos ? "" : line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
    all.names.push_back(std::move(line));
  }
  while (!all.names.empty() && all.names.back().empty()) all.names.pop_back();
  if (all.names.empty()) throw InputError(fmt::format("{}: names no class", file.string()));
  for (const std::string& name : all.names) all.ids.push_back(class_named(name));
  return all;
}

}  // namespace mh
