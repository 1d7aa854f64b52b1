// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/trajectory_io.hpp"
#include "slam/detect/detector.hpp"
#include "slam/detect/heads.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/number_in.hpp"
#include "slam/io/printable.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A box as given in a file.
struct FiledBox {
  double left = 0, top = 0, width = 0, height = 0;
  double score = 1;
  int network_class = 0;
  bool normalized = false;  ///< as fractions of the image's size, not in pixels
};

/// The boxes of a frame, and the file's name for the frame, for messages.
struct FrameBoxes {
  std::string name;
  std::vector<FiledBox> boxes;
};

/// Boxes by frame: by its index in the sequence, or by its stamp.
struct FiledBoxes {
  std::map<std::size_t, FrameBoxes> by_index;
  std::map<Stamp, FrameBoxes> by_stamp;
};

constexpr Stamp kSameStamp_ns = 1'000'000;
constexpr double kLargestShare =
    3;  // largest share of the image in YOLO's boxes: larger numbers are pixels
constexpr std::size_t kMostFrames = 100'000'000;  // larger frame numbers are stamps in nanoseconds

/// The boxes of a frame that a file calls "17" or "1305031229.528748" (a stamp, s).
std::vector<FiledBox>& boxes_of(FiledBoxes& all, const std::string& frame,
                                const std::string& place) {
  const auto named = [&](FrameBoxes& boxes) -> std::vector<FiledBox>& {
    if (boxes.name.empty()) boxes.name = frame;
    return boxes.boxes;
  };
  std::int64_t number = 0;
  const bool digits = !frame.empty() && frame.find_first_not_of("0123456789") == frame.npos;
  if (digits &&
      std::from_chars(frame.data(), frame.data() + frame.size(), number).ec == std::errc())
    return named(all.by_index[static_cast<std::size_t>(number)]);
  char* end = nullptr;
  const double seconds = std::strtod(frame.c_str(), &end);
  if (frame.empty() || *end != '\0' || !std::isfinite(seconds) || std::abs(seconds) > 9e9)
    throw InputError(
        fmt::format("{}: frame '{}' is neither an index nor a stamp in seconds", place, frame));
  return named(all.by_stamp[std::llround(seconds * 1e6) * 1000]);
}

/// If one whole number in a file is too large for an index, all are stamps in ns.
void move_stamps(FiledBoxes& all) {
  if (all.by_index.empty() || all.by_index.rbegin()->first < kMostFrames) return;
  for (auto& [number, filed] : all.by_index) {
    FrameBoxes& frame = all.by_stamp[static_cast<Stamp>(number)];
    frame.name = filed.name;
    frame.boxes.insert(frame.boxes.end(), filed.boxes.begin(), filed.boxes.end());
  }
  all.by_index.clear();
}

/// @param first_class  the number that the file gives to the first class
void check(const FiledBox& box, const ClassNames& names, const std::string& place,
           int first_class = 0) {
  for (const auto& [what, value] : {std::pair("left", box.left),
                                    {"top", box.top},
                                    {"width", box.width},
                                    {"height", box.height},
                                    {"score", box.score}})
    if (!std::isfinite(value))
      throw InputError(fmt::format("{}: {} is {}, not a number", place, what, value));
  if (box.width <= 0 || box.height <= 0)
    throw InputError(fmt::format("{}: a box of {} x {} has no area", place, box.width, box.height));
  if (box.score < 0 || box.score > 1)
    throw InputError(fmt::format("{}: score {} is outside [0, 1]", place, box.score));
  if (box.network_class < 0 || static_cast<std::size_t>(box.network_class) >= names.size())
    throw InputError(
        fmt::format("{}: class {} is not one of the {} named classes, which count from {}", place,
                    box.network_class + first_class, names.size(), first_class));
}

/// Numbers of a line, separated by whitespace or commas. @throws InputError if there is any other
/// word.
/// @param columns what a line should hold, for the message
std::vector<double> numbers(std::string line, const std::string& place, const char* columns) {
  std::ranges::replace(line, ',', ' ');
  std::istringstream words(line);
  std::vector<double> all;
  for (std::string word; words >> word;) {
    const auto value = number_in(without_plus(word));
    if (!value)
      throw InputError(fmt::format("{}: '{}' is not a number; each line is {}", place,
                                   printable(word), columns));
    all.push_back(*value);
  }
  return all;
}

int whole(double value, const char* what, const std::string& place) {
  if (!(std::abs(value) <= 1e9) || value != std::floor(value))
    throw InputError(fmt::format("{}: {} {} is not a whole number", place, what, value));
  return static_cast<int>(value);
}

/// Calls visit(place, numbers) for each line that is neither empty nor a comment.
template <class Visit>
void for_each_line(const fs::path& file, const char* columns, const Visit& visit) {
  std::istringstream text(read_text(file));
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    const std::string place = fmt::format("{}:{}", file.string(), ++number);
    if (line.find_first_not_of(" \t\r") == line.npos || line[0] == '#') continue;
    visit(place, numbers(line, place, columns));
  }
}

/// The file of class names that annotation programs write next to YOLO's text files.
constexpr const char* kFolderClasses = "classes.txt";

/// YOLO's text: FRAME.txt of lines "class x y width height [score]", center and size as fractions
/// of the image's size.
void read_yolo_folder(const fs::path& folder, const ClassNames& names, FiledBoxes& all) {
  for (const std::string& name : list_folder(folder, "*.txt")) {
    if (name == kFolderClasses) continue;
    const fs::path file = folder / name;
    std::vector<FiledBox>& boxes = boxes_of(all, file.stem().string(), file.string());
    constexpr const char* kColumns = "class x y width height [score]";
    for_each_line(file, kColumns, [&](const std::string& place, const std::vector<double>& v) {
      if (v.size() != 5 && v.size() != 6)
        throw InputError(
            fmt::format("{}: {}, not {}", place, counted(v.size(), "number"), kColumns));
      FiledBox box{.left = v[1] - v[3] / 2,
                   .top = v[2] - v[4] / 2,
                   .width = v[3],
                   .height = v[4],
                   .score = v.size() == 6 ? v[5] : 1,
                   .network_class = whole(v[0], "class", place),
                   .normalized = true};
      check(box, names, place);
      if (std::ranges::any_of(std::span(v).subspan(1, 4),
                              [](double share) { return std::abs(share) > kLargestShare; }))
        throw InputError(
            fmt::format("{}: box {} {} {} {} is not given as fractions of the image size", place,
                        v[1], v[2], v[3], v[4]));
      boxes.push_back(box);
    });
  }
}

/// MOT: lines "frame,id,left,top,width,height,confidence,class[,visibility]"; frames and classes
/// count from 1.
void read_mot(const fs::path& file, const ClassNames& names, FiledBoxes& all) {
  constexpr const char* kColumns = "frame, id, left, top, width, height, confidence, class";
  for_each_line(file, kColumns, [&](const std::string& place, const std::vector<double>& v) {
    if (v.size() < 8)
      throw InputError(fmt::format("{}: {}, not {}", place, counted(v.size(), "number"), kColumns));
    const int frame = whole(v[0], "frame", place);
    if (frame < 1) throw InputError(fmt::format("{}: frame {}: frames count from 1", place, frame));
    FiledBox box{.left = v[2] - 1,  // in MOT, the upper left pixel is (1, 1)
                 .top = v[3] - 1,
                 .width = v[4],
                 .height = v[5],
                 .score = v[6],
                 .network_class = whole(v[7], "class", place) - 1};
    check(box, names, place, 1);
    FrameBoxes& of_frame = all.by_index[static_cast<std::size_t>(frame - 1)];
    of_frame.name = std::to_string(frame);
    of_frame.boxes.push_back(box);
  });
}

/// COCO's results: [{"image_id": 0, "category_id": 62, "bbox": [x, y, width, height], "score":
/// 0.9}, ...].
void read_coco(const fs::path& file, const ClassNames& names, bool own_names, FiledBoxes& all) {
  using Json = nlohmann::json;
  const std::string text = read_text(file);
  if (is_nested_too_deep(text))
    throw InputError(fmt::format("{}: is nested too deeply", file.string()));
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::out_of_range&) {
    throw InputError(fmt::format("{}: holds a number beyond the range of a double", file.string()));
  } catch (const Json::parse_error& error) {
    const std::string_view before = std::string_view(text).substr(0, error.byte);
    throw InputError(fmt::format("{}:{}: is not JSON (which has no NaN and no comments)",
                                 file.string(), 1 + std::ranges::count(before, '\n')));
  }
  if (json.is_object() && json.contains("annotations"))
    throw InputError(fmt::format(
        "{}: holds COCO annotations, but COCO results are needed, a list of {{image_id, "
        "category_id, bbox, score}}",
        file.string()));
  if (!json.is_array())
    throw InputError(fmt::format("{}: is not a list of COCO's results", file.string()));
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string place = fmt::format("{}: entry {}", file.string(), i);
    const Json& entry = json[i];
    const auto part = [&](const char* key) -> const Json& {
      if (!entry.is_object() || !entry.contains(key))
        throw InputError(fmt::format("{}: has no '{}'", place, key));
      return entry.at(key);
    };
    const Json &image = part("image_id"), &category = part("category_id"), &bbox = part("bbox"),
               &score = part("score");
    const bool box_is_good = bbox.is_array() && bbox.size() == 4 &&
                             std::ranges::all_of(bbox, [](const Json& v) { return v.is_number(); });
    if (!box_is_good || !score.is_number() || !category.is_number_integer())
      throw InputError(fmt::format(
          "{}: bbox must be four numbers, score a number, category_id an integer", place));
    const double id = category.get<double>();
    FiledBox box{.left = bbox[0],
                 .top = bbox[1],
                 .width = bbox[2],
                 .height = bbox[3],
                 .score = score,
                 .network_class = 0};
    const int number = whole(id, "category_id", place);
    box.network_class = own_names ? number - 1 : coco80_of_category(number);
    if (box.network_class < 0)
      throw InputError(fmt::format("{}: category_id {} is not one of {}", place, number,
                                   own_names ? "the named classes, which count from 1" : "COCO's"));
    check(box, names, place);
    std::string frame = image.is_string() ? image.get<std::string>() : image.dump();
    if (const auto slash = frame.rfind('/'); slash != frame.npos) frame.erase(0, slash + 1);
    for (const char* ending : {".png", ".jpg", ".jpeg"})
      if (frame.ends_with(ending)) frame.resize(frame.size() - std::string_view(ending).size());
    boxes_of(all, frame, place).push_back(box);
  }
}

constexpr std::string_view kMot = "MOT";

/// @throws InputError if a setting is given that only a network takes, since it would have no
/// effect
void require_no_network_settings(const DetectorSpec& spec) {
  const DetectorSettings &asked = spec.settings, usual;
  const char* which = !spec.config.empty()                 ? "config"
                      : asked.head != usual.head           ? "head"
                      : asked.letterbox != usual.letterbox ? "letterbox"
                      : asked.padding != usual.padding     ? "padding"
                      : asked.normalize != usual.normalize ? "normalize"
                      : asked.channels != usual.channels   ? "channels"
                      : asked.width_px != usual.width_px   ? "width_px"
                      : asked.height_px != usual.height_px ? "height_px"
                                                           : nullptr;
  if (which != nullptr)
    throw InputError(fmt::format("{}: `{}` is a setting for networks, but this holds boxes",
                                 spec.boxes.string(), which));
}

class BoxesFromFiles : public Detector {
 public:
  explicit BoxesFromFiles(const DetectorSpec& spec)
      : file_(spec.boxes), settings_(spec.settings), names_(names_of(spec)) {
    require_no_network_settings(spec);
    const std::string ending = spec.boxes.extension().string();
    if (is_folder(spec.boxes)) {
      kind_ = "YOLO text";
      read_yolo_folder(spec.boxes, names_, filed_);
    } else if (ending == ".json") {
      kind_ = "COCO results";
      read_coco(spec.boxes, names_, !spec.classes.empty(), filed_);
    } else if (ending == ".csv" || ending == ".txt") {
      kind_ = kMot;
      read_mot(spec.boxes, names_, filed_);
    } else {
      if (!is_there(spec.boxes)) read_file(spec.boxes);  // fails with a message
      throw InputError(
          fmt::format("{}: boxes are .json (COCO), .csv or .txt (MOT), or a folder of "
                      ".txt (YOLO)",
                      spec.boxes.string()));
    }
    move_stamps(filed_);
    if (is_folder(spec.boxes) && frame_count() == 0)
      throw InputError(fmt::format("{}: holds no .txt file of a frame", spec.boxes.string()));
  }

  Detected detect(const Grid2d<Rgb8>& color, std::size_t index, Stamp stamp_ns) const override {
    Detected found;
    std::vector<Candidate> candidates;
    for (const FiledBox& box : of_frame(index, stamp_ns)) {
      if (box.score < settings_.confidence) continue;
      const double w = box.normalized ? color.width() : 1, h = box.normalized ? color.height() : 1;
      Candidate candidate{.x = (box.left + box.width / 2) * w,
                          .y = (box.top + box.height / 2) * h,
                          .width = box.width * w,
                          .height = box.height * h,
                          .best = box.network_class,
                          .scores = std::vector<float>(names_.size(), 0.0F)};
      constexpr double kSlack_px = 1;
      if (box.left * w < -kSlack_px || box.top * h < -kSlack_px ||
          (box.left + box.width) * w > color.width() + kSlack_px ||
          (box.top + box.height) * h > color.height() + kSlack_px)
        ++found.clipped;
      candidate.scores[static_cast<std::size_t>(box.network_class)] = static_cast<float>(box.score);
      candidates.push_back(std::move(candidate));
    }
    found.boxes =
        select_boxes(candidates, Placement{}, color.width(), color.height(), names_, settings_);
    return found;
  }
  const ClassNames& names() const override { return names_; }
  std::string description() const override {
    std::size_t boxes = 0;
    for (const auto& [frame, list] : filed_.by_index) boxes += list.boxes.size();
    for (const auto& [frame, list] : filed_.by_stamp) boxes += list.boxes.size();
    return fmt::format("{}: {} of {}", kind_, counted(boxes, "box", "boxes"),
                       counted(frame_count(), "frame"));
  }
  std::uint64_t digest() const override { return 0; }
  std::string check_frames(std::span<const Stamp> stamps_ns) const override {
    if (frame_count() == 0) return fmt::format("{}: holds no box", file_.string());
    const std::string unknown = names_.unknown_note(file_);
    std::set<const FrameBoxes*> found;
    for (std::size_t i = 0; i < stamps_ns.size(); ++i)
      for (const FrameBoxes* boxes : lists_of(i, stamps_ns[i])) found.insert(boxes);
    found.erase(nullptr);
    if (found.size() == frame_count()) return unknown;
    const FrameBoxes* lost = nullptr;
    const auto look = [&](const FrameBoxes& boxes) {
      if (lost == nullptr && !found.contains(&boxes)) lost = &boxes;
    };
    for (const auto& [index, boxes] : filed_.by_index) look(boxes);
    for (const auto& [stamp_ns, boxes] : filed_.by_stamp) look(boxes);
    if (found.empty())
      throw InputError(
          fmt::format("{}: none of its {} is one of the sequence's {}, the first is '{}': frames "
                      "are named by {}",
                      file_.string(), counted(frame_count(), "frame"), stamps_ns.size(), lost->name,
                      kind_ == kMot ? "number from 1" : "index from 0 or by stamp"));
    return fmt::format("{}: {} of its {} are not among the sequence's {}, the first is '{}'{}",
                       file_.string(), frame_count() - found.size(),
                       counted(frame_count(), "frame"), stamps_ns.size(), lost->name,
                       unknown.empty() ? "" : "; " + unknown);
  }

 private:
  static ClassNames names_of(const DetectorSpec& spec) {
    if (!spec.classes.empty()) return load_class_names(spec.classes);
    const fs::path beside = spec.boxes / kFolderClasses;
    return is_folder(spec.boxes) && is_there(beside) ? load_class_names(beside) : coco80();
  }

  std::size_t frame_count() const { return filed_.by_index.size() + filed_.by_stamp.size(); }

  /// The boxes of a frame under its index and under its stamp; null where there are none.
  std::array<const FrameBoxes*, 2> lists_of(std::size_t index, Stamp stamp_ns) const {
    const auto at = filed_.by_index.find(index);
    const auto near = filed_.by_stamp.lower_bound(stamp_ns - kSameStamp_ns);
    const bool is_near = near != filed_.by_stamp.end() && near->first <= stamp_ns + kSameStamp_ns;
    return {at == filed_.by_index.end() ? nullptr : &at->second, is_near ? &near->second : nullptr};
  }

  std::vector<FiledBox> of_frame(std::size_t index, Stamp stamp_ns) const {
    std::vector<FiledBox> all;
    for (const FrameBoxes* list : lists_of(index, stamp_ns))
      if (list != nullptr) all.insert(all.end(), list->boxes.begin(), list->boxes.end());
    return all;
  }

  fs::path file_;
  DetectorSettings settings_;
  ClassNames names_;
  std::string_view kind_;
  FiledBoxes filed_;
};

}  // namespace

std::unique_ptr<Detector> open_boxes(const DetectorSpec& spec) {
  return std::make_unique<BoxesFromFiles>(spec);
}

}  // namespace mh
