// SPDX-License-Identifier: Apache-2.0
#include "scenes/recorded/ros/sequence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "scenes/messages/message_file.hpp"
#include "scenes/recorded/class_map.hpp"
#include "scenes/recorded/nearest_stamp.hpp"
#include "scenes/recorded/ros/image.hpp"
#include "scenes/recorded/ros/names.hpp"
#include "scenes/recorded/ros/topics.hpp"
#include "slam/core/counted.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// The messages of a frame.
struct StoredFrame {
  StoredImage color, depth;
  std::optional<StoredImage> labels;
};

/// What is needed of a topic to read its images.
struct ImageSource {
  std::string name;
  bool compressed = false;
  ros::Wire wire = ros::Wire::kRos1;
};

ImageSource source_of(const ImageTopic& topic) {
  return {topic.name, topic.compressed, topic.wire};
}

class RosSequence : public Sequence {
 public:
  std::unique_ptr<MessageFile> file;
  Camera of_color;
  ImageSource color, depth, labels;
  std::vector<StoredFrame> frames;
  std::optional<ClassMap> classes;
  std::optional<Trajectory> true_poses;

  const Camera& camera() const override { return of_color; }
  std::size_t size() const override { return frames.size(); }
  Stamp stamp_ns(std::size_t i) const override { return frames[i].color.stamp_ns; }
  const Trajectory* truth() const override { return true_poses ? &*true_poses : nullptr; }

  RgbdFrame frame(std::size_t i, RandomStream) const override {
    const StoredFrame& stored = frames[i];
    RgbdFrame frame;
    frame.stamp_ns = stored.color.stamp_ns;
    frame.color = image(color, stored.color, color_in);
    frame.depth_m = image(depth, stored.depth, depth_in);
    if (stored.labels) {
      const auto ids = image(labels, *stored.labels, ids_in);
      try {
        frame.semantics = one_hot(ids, classes ? &*classes : nullptr);
      } catch (const InputError& error) {
        fail(labels, *stored.labels, error.what());
      }
    }
    return frame;
  }

  LabelsOfFrames stored_labels() const {
    return {.frames = frames.size(),
            .read = [this](std::size_t i) -> std::optional<Grid2d<std::uint16_t>> {
              if (!frames[i].labels) return std::nullopt;
              return image(labels, *frames[i].labels, ids_in);
            },
            .place =
                [this](std::size_t i) {
                  return fmt::format("{}: topic {} at {} ns", file->name(), labels.name,
                                     frames[i].labels->stamp_ns);
                }};
  }

 private:
  [[noreturn]] void fail(const ImageSource& source, const StoredImage& stored,
                         const char* why) const {
    throw InputError(
        fmt::format("{}: topic {} at {} ns: {}", file->name(), source.name, stored.stamp_ns, why));
  }

  template <class T>
  using Read = Grid2d<T> (*)(std::string_view, ros::Wire, bool);

  template <class T>
  Grid2d<T> image(const ImageSource& source, const StoredImage& stored, Read<T> read) const {
    const HeldBytes message = file->read(stored.place);
    try {
      Grid2d<T> grid = read(message.view, source.wire, source.compressed);
      if (grid.width() != of_color.width_px || grid.height() != of_color.height_px)
        throw InputError(fmt::format("is {} x {}, the camera has {} x {}", grid.width(),
                                     grid.height(), of_color.width_px, of_color.height_px));
      return grid;
    } catch (const InputError& error) {
      fail(source, stored, error.what());
    }
  }
};

/// Frames per second, from the median time between images, to 0.01 Hz; 30 for a single image.
double rate_of(const std::vector<StoredImage>& images) {
  std::vector<Stamp> gaps_ns;
  for (std::size_t i = 1; i < images.size(); ++i)
    if (images[i].stamp_ns > images[i - 1].stamp_ns)
      gaps_ns.push_back(images[i].stamp_ns - images[i - 1].stamp_ns);
  if (gaps_ns.empty()) return 30;
  const auto middle = gaps_ns.begin() + static_cast<std::ptrdiff_t>(gaps_ns.size() / 2);
  std::ranges::nth_element(gaps_ns, middle);
  return std::max(0.01, std::round(1e11 / static_cast<double>(*middle)) / 100);
}

/// @throws InputError if the calibration is none that a pinhole with plumb_bob's distortion has.
void set_distortion(Camera& camera, const ros::CameraInfo& info) {
  if (std::ranges::all_of(info.d, [](double k) { return k == 0; })) return;
  const bool rational = info.distortion_model == "rational_polynomial";
  if (!rational && info.distortion_model != "plumb_bob" && !info.distortion_model.empty())
    throw InputError(fmt::format("distortion model '{}' is not supported", info.distortion_model));
  for (std::size_t i = 5; i < info.d.size(); ++i)
    if (info.d[i] != 0)
      throw InputError("its distortion has more than the five coefficients of plumb_bob");
  const auto k = [&](std::size_t i) { return i < info.d.size() ? info.d[i] : 0.0; };
  camera.distortion = {k(0), k(1), k(2), k(3), k(4)};
}

bool is_rectified(const std::string& topic) {
  return topic.substr(topic.rfind('/') + 1).find("_rect") != std::string::npos;
}

Camera camera_of(const ChosenTopics& chosen, const RosTopics& topics) {
  const ImageTopic& color = *chosen.color;
  const ros::CameraInfo& info = chosen.info->info;
  Camera camera;
  const std::array<double, 3> first = is_rectified(color.name)
                                          ? std::array{info.p[0], info.p[5], info.p[2]}
                                          : std::array{info.k[0], info.k[4], info.k[2]};
  camera.fx_px = first[0];
  camera.fy_px = first[1];
  camera.cx_px = first[2];
  camera.cy_px = is_rectified(color.name) ? info.p[6] : info.k[5];
  const bool has_size = info.width > 0 && info.height > 0;
  camera.width_px =
      has_size ? static_cast<int>(std::min<std::uint32_t>(info.width, 65535)) : color.width_px;
  camera.height_px =
      has_size ? static_cast<int>(std::min<std::uint32_t>(info.height, 65535)) : color.height_px;
  if (!color.compressed &&
      (color.width_px != camera.width_px || color.height_px != camera.height_px))
    throw InputError(fmt::format("is for {} x {} pixels, but the images have {} x {}",
                                 camera.width_px, camera.height_px, color.width_px,
                                 color.height_px));
  if (!is_rectified(color.name)) set_distortion(camera, info);
  camera.rate_hz = rate_of(color.images);
  const auto projector = topics.calibrations.find(ros::kProjectorInfoTopic);
  if (projector != topics.calibrations.end() && projector->second.info.p[3] < 0 &&
      projector->second.info.p[0] > 0)
    camera.baseline_m = -projector->second.info.p[3] / projector->second.info.p[0];
  validate(camera);
  return camera;
}

Camera calibrated(const ChosenTopics& chosen, const RosTopics& topics,
                  const RecordingConfig& config, const std::string& file,
                  std::vector<std::string>& notes) {
  if (!config.calibration.empty() && config.has_camera(config.calibration))
    return config.read_camera(config.calibration).camera;
  if (chosen.info == nullptr)
    throw InputError(
        fmt::format("{}: holds no sensor_msgs/CameraInfo for {}; name its topic "
                    "(info=TOPIC) or a settings file by --settings, in a suite by "
                    "`settings:`",
                    file, chosen.color->name));
  if (chosen.info->other_at_ns)
    notes.push_back(
        fmt::format("{}: the calibration of {} is another from {} ns on: the first is "
                    "used for all frames",
                    file, chosen.info->topic, *chosen.info->other_at_ns));
  try {
    return camera_of(chosen, topics);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: the calibration of {}: {}; a settings file replaces it "
                    "(--settings, in a suite `settings:`)",
                    file, chosen.color->name, error.what()));
  }
}

/// @throws InputError if depth cannot be registered to color.
void check_registered(const ChosenTopics& chosen, const std::string& file,
                      std::vector<std::string>& notes) {
  const ImageTopic &color = *chosen.color, &depth = *chosen.depth;
  if (!color.compressed && !depth.compressed &&
      (color.width_px != depth.width_px || color.height_px != depth.height_px))
    throw InputError(
        fmt::format("{}: depth of {} is {} x {}, color of {} is {} x {}: a topic with "
                    "depth registered to color is needed",
                    file, depth.name, depth.width_px, depth.height_px, color.name, color.width_px,
                    color.height_px));
  constexpr double kSame_px = 1;
  if (chosen.info == nullptr || chosen.depth_info == nullptr) return;
  for (const std::size_t i : {0U, 2U, 4U, 5U})
    if (std::abs(chosen.info->info.k[i] - chosen.depth_info->info.k[i]) > kSame_px) {
      notes.push_back(
          fmt::format("{}: depth of {} has another calibration than color of {}: it is used as if "
                      "it were registered",
                      file, depth.name, color.name));
      return;
    }
}

/// The stamps of a topic's images, for lookup.
StampIndex index_of(const ImageTopic& topic) {
  std::vector<Stamp> stamps_ns;
  for (const StoredImage& image : topic.images) stamps_ns.push_back(image.stamp_ns);
  return StampIndex(stamps_ns);
}

std::vector<StoredFrame> paired(const ChosenTopics& chosen, const std::string& file,
                                std::vector<std::string>& notes) {
  std::vector<StoredImage> all_color = chosen.color->images;
  const auto is_earlier = [](const StoredImage& a, const StoredImage& b) {
    return a.stamp_ns < b.stamp_ns;
  };
  if (!std::ranges::is_sorted(all_color, is_earlier)) {
    std::ranges::stable_sort(all_color, is_earlier);
    notes.push_back(
        fmt::format("{}: images of {} are not in the order of their stamps: they are "
                    "sorted by them",
                    file, chosen.color->name));
  }
  const StampIndex depth_at = index_of(*chosen.depth);
  const StampIndex labels_at = chosen.labels ? index_of(*chosen.labels) : StampIndex({});
  std::vector<StoredFrame> frames;
  for (const StoredImage& color : all_color) {
    const auto depth = depth_at.nearest(color.stamp_ns);
    if (!depth) continue;
    StoredFrame frame{color, chosen.depth->images[*depth], {}};
    if (const auto labels = labels_at.nearest(color.stamp_ns))
      frame.labels = chosen.labels->images[*labels];
    frames.push_back(frame);
  }
  if (frames.empty())
    throw InputError(fmt::format("{}: no color image of {} has a depth image of {} within 0.02 s",
                                 file, chosen.color->name, chosen.depth->name));
  const std::size_t all = chosen.color->images.size();
  if (frames.size() < all)
    notes.push_back(
        fmt::format("{}: {} of {} color images have no depth image within 0.02 s and are left out",
                    file, all - frames.size(), all));
  return frames;
}

/// The file itself, or the only one of that kind in a folder.
fs::path file_at(const fs::path& path, const char* pattern) {
  if (!is_folder(path)) return path;
  const std::vector<std::string> names = list_folder(path, pattern);
  if (names.size() == 1) return path / names.front();
  if (names.empty()) throw InputError(fmt::format("{}: holds no file {}", path.string(), pattern));
  throw InputError(fmt::format("{}: holds {} files {}: name one of them, {} for example",
                               path.string(), names.size(), pattern, names.front()));
}

/// Whether a path is such a file, or a folder of such.
bool looks_like(const fs::path& path, const char* extension) {
  if (is_folder(path)) return !list_folder(path, std::string("*") + extension).empty();
  return path.extension() == extension && is_file(path);
}

bool is_bag(const fs::path& path) {
  return looks_like(path, ".bag");
}
bool is_mcap(const fs::path& path) {
  return looks_like(path, ".mcap");
}

OpenedRecording open_file(const fs::path& file, const RecordingConfig& config, OpenMessages open) {
  return open_messages(open, map_file(file, MapPages::kAsTouched), file.string(), config);
}

OpenedRecording open_bag_recording(const fs::path& path, const RecordingConfig& config) {
  return open_file(file_at(path, "*.bag"), config, open_bag);
}
OpenedRecording open_mcap_recording(const fs::path& path, const RecordingConfig& config) {
  return open_file(file_at(path, "*.mcap"), config, open_mcap);
}

}  // namespace

OpenedRecording open_messages(OpenMessages open, HeldBytes content, const std::string& name,
                              const RecordingConfig& config) {
  const TopicNames names = parse_topic_names(config.topics);
  RosTopics topics;
  auto sequence = std::make_unique<RosSequence>();
  sequence->file = open(std::move(content), name,
                        [&](const MessageChannel& channel, std::string_view message,
                            const MessagePlace& place) { topics.add(channel, message, place); });
  OpenedRecording opened;
  opened.notes = sequence->file->notes();
  opened.images = {name};
  if (topics.unreadable > 0)
    opened.notes.push_back(fmt::format("{}: {} cannot be read, the first: {}", name,
                                       counted(topics.unreadable, "message"),
                                       topics.first_unreadable));
  if (sequence->file->message_count() == 0)
    throw InputError(fmt::format(
        "{}: holds no messages{}", name,
        opened.notes.empty() ? "" : ": " + opened.notes.front().substr(name.size() + 2)));
  const ChosenTopics chosen = choose_topics(topics, names, sequence->file->channels(), name);
  check_registered(chosen, name, opened.notes);
  sequence->of_color = calibrated(chosen, topics, config, name, opened.notes);
  sequence->color = source_of(*chosen.color);
  sequence->depth = source_of(*chosen.depth);
  sequence->frames = paired(chosen, name, opened.notes);
  sequence->true_poses = true_trajectory(topics, names, *chosen.color, opened.notes, name);
  opened.has_labels = chosen.labels != nullptr;
  // Read even where labels are left out: what is read depends on the recording alone.
  if (!config.classes.empty()) {
    sequence->classes = load_class_map(config.classes);
    if (!opened.has_labels) opened.notes.push_back(no_labels_note(config.classes));
  }
  if (chosen.labels != nullptr && config.labels) {
    sequence->labels = source_of(*chosen.labels);
    if (sequence->classes)
      note_foreign_ids(sequence->stored_labels(), *sequence->classes, config.classes, opened.notes);
    const auto without = std::ranges::count_if(
        sequence->frames, [](const StoredFrame& frame) { return !frame.labels.has_value(); });
    if (without > 0)
      opened.notes.push_back(
          fmt::format("{}: {} of {} frames have no label image within 0.02 s: all is void there",
                      name, without, sequence->frames.size()));
  } else {
    for (StoredFrame& frame : sequence->frames) frame.labels.reset();
  }
  opened.sequence = std::move(sequence);
  return opened;
}

const SequenceReader kBagReader{"bag", "FILE", is_bag, open_bag_recording, nullptr, true};
const SequenceReader kMcapReader{"mcap", "FILE", is_mcap, open_mcap_recording, nullptr, true};

}  // namespace mh
