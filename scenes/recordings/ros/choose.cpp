// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "scenes/recordings/ros/image.hpp"
#include "scenes/recordings/ros/names.hpp"
#include "scenes/recordings/ros/topics.hpp"
#include "slam/io/error.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

constexpr std::array kColorEncodings = {
    "rgb8",   "bgr8",  "rgba8",       "bgra8",       "8UC3",        "8UC4",
    "rgb16",  "bgr16", "bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8",
    "yuv422", "uyvy",  "yuv422_yuy2", "yuyv",        "nv12",        "nv21"};
constexpr std::array kGrayEncodings = {"mono8", "8UC1"};
constexpr std::array kDepthEncodings = {"32FC1", "16UC1", "mono16"};

bool is_one_of(const auto& encodings, const std::string& encoding) {
  return std::ranges::find(encodings, encoding) != encodings.end();
}

/// Whether a topic holds our own label or instance images, of any camera: these are neither color
/// nor depth.
bool is_ours(const ImageTopic& topic) {
  return topic.name.ends_with("/labels/image") || topic.name.ends_with("/instances/image");
}
/// Whether a topic has depth compressed by image_transport's compressedDepth, or by its
/// `compressed`, whose format begins with the encoding: "16UC1; png compressed".
bool has_compressed_depth(const ImageTopic& topic) {
  const std::string encoding = topic.encoding.substr(0, topic.encoding.find(';'));
  return topic.compressed &&
         (is_compressed_depth(topic.encoding) || is_one_of(kDepthEncodings, encoding));
}
bool is_depth(const ImageTopic& topic) {
  return !is_ours(topic) && (has_compressed_depth(topic) ||
                             (!topic.compressed && is_one_of(kDepthEncodings, topic.encoding)));
}
bool is_color(const ImageTopic& topic) {
  return !is_ours(topic) && (topic.compressed ? !has_compressed_depth(topic)
                                              : is_one_of(kColorEncodings, topic.encoding));
}
bool is_gray(const ImageTopic& topic) {
  return !is_ours(topic) && !topic.compressed && is_one_of(kGrayEncodings, topic.encoding);
}

std::string parent_of(const std::string& topic) {
  return topic.substr(0, topic.rfind('/'));
}

/// Of several topics, returns those of the same camera as the color topic, judging by the beginning
/// of the name ("/camera2/..."); all topics if there are none of that camera.
std::vector<const ImageTopic*> of_same_camera(std::vector<const ImageTopic*> topics,
                                              const ImageTopic& color) {
  const auto camera_of = [](const std::string& name) { return name.substr(0, name.find('/', 1)); };
  const auto is_other = [&](const ImageTopic* topic) {
    return camera_of(topic->name) != camera_of(color.name);
  };
  if (topics.size() > 1 && !std::ranges::all_of(topics, is_other)) std::erase_if(topics, is_other);
  return topics;
}

std::string listed(const std::vector<const ImageTopic*>& topics) {
  std::string text;
  for (const ImageTopic* topic : topics)
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", topic->name,
                        topic->compressed ? "compressed" : topic->encoding);
  return text;
}

/// Every topic with its type, for users who have to name one.
std::string all_topics(const std::vector<MessageChannel>& channels) {
  std::string text;
  for (const MessageChannel& channel : channels)
    text += fmt::format("{}{} ({}{})", text.empty() ? "" : ", ", channel.topic,
                        channel.type.empty() ? "without a type" : channel.type,
                        channel.wire ? "" : ", not encoded as ROS 1 or CDR");
  return text.empty() ? "it has no topics" : "its topics: " + text;
}

class Chooser {
 public:
  Chooser(const RosTopics& topics, const std::vector<MessageChannel>& channels,
          const std::string& file)
      : topics_(topics), channels_(channels), file_(file) {}

  const ImageTopic* named(const std::string& name) const {
    const auto found = topics_.images.find(name);
    if (found != topics_.images.end()) return &found->second;
    std::vector<std::string> known;
    for (const auto& [topic, images] : topics_.images) known.push_back(topic);
    throw InputError(fmt::format("{}: topic '{}' holds no image{}; {}", file_, name,
                                 hint(name, known), all_topics(channels_)));
  }

  std::vector<const ImageTopic*> all(const std::function<bool(const ImageTopic&)>& is) const {
    std::vector<const ImageTopic*> found;
    for (const auto& [name, topic] : topics_.images)
      if (is(topic)) found.push_back(&topic);
    // An uncompressed image is preferred to its compressed twin.
    std::erase_if(found, [&](const ImageTopic* topic) {
      const auto twin = topics_.images.find(parent_of(topic->name));
      return topic->compressed && twin != topics_.images.end() && is(twin->second);
    });
    return found;
  }

  std::vector<const ImageTopic*> all_images() const {
    std::vector<const ImageTopic*> images;
    for (const auto& [name, topic] : topics_.images) images.push_back(&topic);
    return images;
  }

  /// @param encodings accepted encodings, for the message
  const ImageTopic* only(const std::vector<const ImageTopic*>& found, const char* what,
                         const std::string& encodings) const {
    if (found.size() == 1) return found.front();
    if (found.empty())
      throw InputError(fmt::format(
          "{}: no topic holds {} images that are read ({}); {}", file_, what, encodings,
          topics_.images.empty() ? all_topics(channels_) : "its images: " + listed(all_images())));
    throw InputError(
        fmt::format("{}: several topics hold {} images: {}; name one: --topics {}={} "
                    "(in a suite `topics:`)",
                    file_, what, listed(found), what, found.front()->name));
  }

  /// The calibration next to an image topic: /x/camera_info for /x/image_raw or
  /// /x/image_raw/compressed; or, as named by RealSense's recorder, /x/info/camera_info for
  /// /x/image/data.
  const Calibration* calibration_of(const ImageTopic& image) const {
    std::string folder = parent_of(image.name);
    for (int up = 0; up < 3; ++up, folder = parent_of(folder))
      for (const char* name : {"/camera_info", "/info/camera_info"}) {
        if (up == 2 && name == std::string_view("/camera_info")) continue;
        const auto found = topics_.calibrations.find(folder + name);
        if (found != topics_.calibrations.end()) return &found->second;
      }
    return topics_.calibrations.size() == 1 ? &topics_.calibrations.begin()->second : nullptr;
  }

  const Calibration* named_calibration(const std::string& name) const {
    const auto found = topics_.calibrations.find(name);
    if (found != topics_.calibrations.end()) return &found->second;
    throw InputError(fmt::format("{}: topic '{}' holds no sensor_msgs/CameraInfo; {}", file_, name,
                                 all_topics(channels_)));
  }

 private:
  const RosTopics& topics_;
  const std::vector<MessageChannel>& channels_;
  const std::string& file_;
};

}  // namespace

ChosenTopics choose_topics(const RosTopics& topics, const TopicNames& names,
                           const std::vector<MessageChannel>& channels, const std::string& file) {
  const Chooser choose(topics, channels, file);
  ChosenTopics chosen;
  const auto color_or_gray = [&] {
    std::vector<const ImageTopic*> found = choose.all(is_color);
    return found.empty() ? choose.all(is_gray) : found;
  };
  chosen.color =
      names.color.empty()
          ? choose.only(color_or_gray(), "color",
                        fmt::format("{}, {}, compressed", fmt::join(kColorEncodings, ", "),
                                    fmt::join(kGrayEncodings, ", ")))
          : choose.named(names.color);
  chosen.depth =
      names.depth.empty()
          ? choose.only(of_same_camera(choose.all(is_depth), *chosen.color), "depth",
                        fmt::format("{}, compressedDepth", fmt::join(kDepthEncodings, ", ")))
          : choose.named(names.depth);
  if (!names.labels.empty())
    chosen.labels = choose.named(names.labels);
  else if (const auto ours = topics.images.find(ros::kLabelTopic); ours != topics.images.end())
    chosen.labels = &ours->second;
  chosen.info = names.info.empty() ? choose.calibration_of(*chosen.color)
                                   : choose.named_calibration(names.info);
  chosen.depth_info = choose.calibration_of(*chosen.depth);
  return chosen;
}

}  // namespace mh
