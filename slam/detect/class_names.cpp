// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/class_names.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/lower_case.hpp"
#include "slam/io/text_file.hpp"
#include "slam/io/yaml.hpp"

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

// Names that networks give to classes for which class_by_name() knows a different name.
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

ClassNames with_ids(std::vector<std::string> names) {
  ClassNames all;
  for (const std::string& name : names) all.ids.push_back(class_named(name));
  all.names = std::move(names);
  return all;
}

/// Takes a quoted string from the start of `rest`; nullopt if there is none.
std::optional<std::string> take_quoted(std::string_view& rest) {
  const char quote = rest.empty() ? '\0' : rest.front();
  if (quote != '\'' && quote != '"') return std::nullopt;
  std::string text;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] == quote) {
      rest.remove_prefix(i + 1);
      return text;
    }
    if (rest[i] == '\\' && i + 1 < rest.size()) ++i;
    text += rest[i];
  }
  return std::nullopt;
}

bool take(std::string_view& rest, char expected) {
  while (!rest.empty() && (rest.front() == ' ' || rest.front() == '\n')) rest.remove_prefix(1);
  if (rest.empty() || rest.front() != expected) return false;
  rest.remove_prefix(1);
  while (!rest.empty() && (rest.front() == ' ' || rest.front() == '\n')) rest.remove_prefix(1);
  return true;
}

/// Takes an index with its colon, such as `12:`, from the start of `rest`; nullopt if there is
/// none.
std::optional<std::size_t> take_index(std::string_view& rest) {
  const bool quoted = !rest.empty() && (rest.front() == '\'' || rest.front() == '"');
  std::string_view digits = rest.substr(quoted ? 1 : 0);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc()) return std::nullopt;
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  if (quoted && !rest.empty()) rest.remove_prefix(1);
  return take(rest, ':') ? std::optional(index) : std::nullopt;
}

std::vector<std::string> require_some(std::vector<std::string> names,
                                      const std::filesystem::path& file) {
  if (names.empty()) throw InputError(fmt::format("{}: names no class", file.string()));
  return names;
}

/// `names` in a data set's file for Ultralytics: a list, or a mapping from index to name.
std::vector<std::string> names_in_yaml(const std::filesystem::path& file) {
  YamlReader yaml = YamlReader::load(file);
  YamlReader list = yaml.at("names");
  std::vector<std::string> names;
  if (list.is_sequence()) {
    for (const YamlReader& name : list.items()) names.push_back(name.as_string());
    return names;
  }
  const auto entries = list.entries();
  names.resize(entries.size());
  for (const auto& [key, name] : entries) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (error != std::errc() || end != key.data() + key.size() || index >= names.size())
      name.fail(fmt::format("'{}' is not an index from 0 to {}", key, names.size() - 1));
    names[index] = name.as_string();
  }
  return names;
}

}  // namespace

std::string ClassNames::unknown_note(const std::filesystem::path& of) const {
  if (std::ranges::any_of(ids, [](ClassId id) { return id != kVoid; })) return "";
  return fmt::format("{}: none of its {} has the name of one of our classes: all labels stay void",
                     of.string(), counted(size(), "class", "classes"));
}

const ClassNames& coco80() {
  static const ClassNames kNames = with_ids({kCoco80.begin(), kCoco80.end()});
  return kNames;
}

int coco80_of_category(int category_id) {
  if (category_id < 1 || category_id > 90 || std::ranges::count(kNoCategory, category_id) > 0)
    return -1;
  const auto skipped = std::ranges::count_if(kNoCategory, [&](int no) { return no < category_id; });
  return category_id - 1 - static_cast<int>(skipped);
}

ClassNames load_class_names(const std::filesystem::path& file) {
  const std::string ending = lower_case(file.extension().string());
  if (ending == ".yaml" || ending == ".yml")
    return with_ids(require_some(names_in_yaml(file), file));
  const std::string text = read_text(file);
  if (auto printed = read_class_names(text)) return *std::move(printed);
  std::vector<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find_first_not_of(" \t\r");
    line = first == line.npos ? "" : line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
    names.push_back(std::move(line));
  }
  while (!names.empty() && names.back().empty()) names.pop_back();
  return with_ids(require_some(std::move(names), file));
}

std::optional<ClassNames> read_class_names(std::string_view python) {
  const bool by_index = take(python, '{');
  if (!by_index && !take(python, '[')) return std::nullopt;
  const char end = by_index ? '}' : ']';
  std::map<std::size_t, std::string> named;
  while (!take(python, end)) {
    const auto index = by_index ? take_index(python) : std::optional(named.size());
    auto name = take_quoted(python);
    if (!index || !name || !named.emplace(*index, *std::move(name)).second) return std::nullopt;
    if (!take(python, ',') && !python.starts_with(end)) return std::nullopt;
  }
  if (named.empty() || named.rbegin()->first != named.size() - 1 || !python.empty())
    return std::nullopt;
  std::vector<std::string> names;
  for (auto& [index, name] : named) names.push_back(std::move(name));
  return with_ids(std::move(names));
}

}  // namespace mh
