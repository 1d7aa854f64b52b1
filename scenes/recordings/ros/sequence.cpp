// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/ros/sequence.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "scenes/recordings/class_map.hpp"
#include "scenes/recordings/messages/message_file.hpp"
#include "scenes/recordings/nearest_stamp.hpp"
#include "scenes/recordings/registered_depth.hpp"
#include "scenes/recordings/ros/cameras.hpp"
#include "scenes/recordings/ros/image.hpp"
#include "scenes/recordings/ros/parts.hpp"
#include "scenes/recordings/ros/topics.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// The messages of a frame.
struct StoredFrame {
  StoredImage color, depth;
  std::optional<StoredImage> labels;
};

/// What is needed to read a topic's images.
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
  std::vector<std::unique_ptr<MessageFile>> files;
  Camera of_color;
  std::optional<DepthCamera> of_depth;  ///< absent: depth is registered to color
  double per_meter = kRosDepthPerMeter;
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
    frame.color = image(color, stored.color, of_color, color_in);
    const auto meters = [&](std::string_view message, ros::Wire wire, bool compressed) {
      return depth_in(message, wire, compressed, per_meter);
    };
    frame.depth_m = image(depth, stored.depth, of_depth ? of_depth->camera : of_color, meters);
    if (of_depth) frame.depth_m = registered_depth(frame.depth_m, *of_depth, of_color);
    if (stored.labels) {
      const auto ids = image(labels, *stored.labels, of_color, ids_in);
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
              return image(labels, *frames[i].labels, of_color, ids_in);
            },
            .place =
                [this](std::size_t i) {
                  return fmt::format("{}: topic {} at {} ns", name_of(*frames[i].labels),
                                     labels.name, frames[i].labels->stamp_ns);
                }};
  }

 private:
  [[noreturn]] void fail(const ImageSource& source, const StoredImage& stored,
                         const char* why) const {
    throw InputError(fmt::format("{}: topic {} at {} ns: {}", name_of(stored), source.name,
                                 stored.stamp_ns, why));
  }

  const std::string& name_of(const StoredImage& stored) const {
    return files[stored.place.part]->name();
  }

  /// @param read  (message, wire, compressed) -> a grid
  template <class ReadImage>
  std::invoke_result_t<const ReadImage&, std::string_view, ros::Wire, bool> image(
      const ImageSource& source, const StoredImage& stored, const Camera& camera,
      const ReadImage& read) const {
    const HeldBytes message = files[stored.place.part]->read(stored.place);
    try {
      auto grid = read(message.view, source.wire, source.compressed);
      if (grid.width() != camera.width_px || grid.height() != camera.height_px)
        throw InputError(fmt::format("is {} x {}, the camera has {} x {}", grid.width(),
                                     grid.height(), camera.width_px, camera.height_px));
      return grid;
    } catch (const InputError& error) {
      fail(source, stored, error.what());
    }
  }
};

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
    notes.push_back(fmt::format("{}: images of {} are not ordered by timestamp: they are sorted",
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

/// Whether a path is a file with this extension, or a folder with one or more of them.
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

OpenedRecording open_path(const fs::path& path, const RecordingConfig& config, const char* pattern,
                          OpenMessages open) {
  std::vector<std::string> notes;
  std::vector<MessageBytes> parts;
  for (const fs::path& file : parts_at(path, pattern, notes))
    parts.push_back({file.string(), map_file(file, MapPages::kAsTouched)});
  OpenedRecording opened =
      open_messages(open, parts, parts.size() == 1 ? parts.front().name : path.string(), config);
  opened.notes.insert(opened.notes.begin(), notes.begin(), notes.end());
  return opened;
}

OpenedRecording open_bag_recording(const fs::path& path, const RecordingConfig& config) {
  return open_path(path, config, "*.bag", open_bag);
}
OpenedRecording open_mcap_recording(const fs::path& path, const RecordingConfig& config) {
  return open_path(path, config, "*.mcap", open_mcap);
}

/// The files of a recording, and their content.
struct Read {
  std::vector<std::unique_ptr<MessageFile>> files;
  RosTopics topics;
  std::vector<MessageChannel> channels;  ///< channels of all files, each listed once
  std::size_t messages = 0;
};

/// Reads one part of a recording. @throws InputError if it is not a file of messages
void read_part(OpenMessages open, const MessageBytes& part, Read& read,
               std::vector<std::string>& notes) {
  const std::size_t number = read.files.size();
  auto file =
      open(part.content, part.name,
           [&](const MessageChannel& channel, std::string_view message, const MessagePlace& place) {
             MessagePlace of_all = place;
             of_all.part = number;
             read.topics.add(channel, message, of_all);
           });
  for (const std::string& note : file->notes()) notes.push_back(note);
  for (const MessageChannel& channel : file->channels())
    if (std::ranges::find(read.channels, channel) == read.channels.end())
      read.channels.push_back(channel);
  read.messages += file->message_count();
  read.files.push_back(std::move(file));
}

/// Reads all parts. A part that is not a file of messages is left out, unless it is the only one.
Read read_parts(OpenMessages open, const std::vector<MessageBytes>& parts,
                std::vector<std::string>& notes) {
  Read read;
  std::string first_fault;
  for (const MessageBytes& part : parts) {
    try {
      read_part(open, part, read, notes);
    } catch (const InputError& error) {
      if (first_fault.empty()) first_fault = error.what();
      notes.push_back(fmt::format("{}: this part is left out", error.what()));
    }
  }
  if (read.files.empty()) throw InputError(first_fault);
  return read;
}

}  // namespace

OpenedRecording open_messages(OpenMessages open, const std::vector<MessageBytes>& parts,
                              const std::string& name, const RecordingConfig& config) {
  const TopicNames names = parse_topic_names(config.topics);
  OpenedRecording opened;
  Read read = read_parts(open, parts, opened.notes);
  RosTopics& topics = read.topics;
  auto sequence = std::make_unique<RosSequence>();
  sequence->files = std::move(read.files);
  for (const MessageBytes& part : parts) opened.images.emplace_back(part.name);
  if (topics.unreadable > 0)
    opened.notes.push_back(fmt::format("{}: {} cannot be read, the first: {}", name,
                                       counted(topics.unreadable, "message"),
                                       topics.first_unreadable));
  if (read.messages == 0)
    throw InputError(fmt::format(
        "{}: holds no messages{}", name,
        opened.notes.empty() ? "" : ": " + opened.notes.front().substr(name.size() + 2)));
  const ChosenTopics chosen = choose_topics(topics, names, read.channels, name);
  repair_stamps(topics, chosen, opened.notes, name);
  RosCameras cameras = ros_cameras(chosen, topics, config, name, opened.notes);
  sequence->of_color = cameras.color;
  sequence->of_depth = cameras.depth;
  sequence->per_meter = cameras.depth_per_meter;
  sequence->color = source_of(*chosen.color);
  sequence->depth = source_of(*chosen.depth);
  sequence->frames = paired(chosen, name, opened.notes);
  sequence->true_poses = true_trajectory(topics, names, *chosen.color, opened.notes, name);
  opened.has_labels = chosen.labels != nullptr;
  // Read even if labels are ignored, so that what is read depends only on the recording.
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
