// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/ros/cameras.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scenes/recordings/nearest_stamp.hpp"
#include "scenes/recordings/ros/image.hpp"
#include "scenes/recordings/ros/names.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

bool has_no_distortion(const ros::CameraInfo& info) {
  return std::ranges::all_of(info.d, [](double k) { return k == 0; });
}

/// @throws InputError if the calibration is not that of a pinhole camera with plumb_bob or
/// rational_polynomial distortion.
void set_distortion(Camera& camera, const ros::CameraInfo& info) {
  if (has_no_distortion(info)) return;
  const std::string& model = info.distortion_model;
  const bool rational = model == "rational_polynomial";
  // "Brown Conrady" is RealSense's name for plumb_bob.
  if (!rational && model != "plumb_bob" && model != "Brown Conrady" && !model.empty())
    throw InputError(fmt::format("distortion model '{}' is not supported", model));
  const std::size_t most = rational ? 8 : 5;
  for (std::size_t i = most; i < info.d.size(); ++i)
    if (info.d[i] != 0)
      throw InputError(fmt::format("its distortion has more than the {} coefficients of {}", most,
                                   rational ? "rational_polynomial" : "plumb_bob"));
  camera.distortion = distortion_of(info.d);
}

bool is_rectified(const std::string& topic) {
  return topic.substr(topic.rfind('/') + 1).find("_rect") != std::string::npos;
}

/// One axis of a calibration: the size of the whole sensor, the part that was cropped from it, and
/// how many of that part's pixels were binned into one (REP 104).
struct Axis {
  double focal_px, center_px;
  std::uint32_t size_px, offset_px, part_px, joined;

  std::uint32_t step() const { return std::max(joined, 1U); }
  double focal() const { return focal_px / step(); }
  /// Pixel centers are at integers, so the center of a binned pixel is in the middle between the
  /// centers of the pixels that it joins.
  double center() const { return (center_px - offset_px - 0.5 * (step() - 1)) / step(); }
  int size() const {
    return static_cast<int>(std::min(part_px > 0 ? part_px : size_px, 65535U) / step());
  }
};

/// The camera that a calibration describes for a topic of images.
Camera camera_of(const ImageTopic& images, const ros::CameraInfo& info) {
  Camera camera;
  const bool rectified = is_rectified(images.name);
  // Drivers leave P empty if nothing has to be rectified.
  const bool by_p = rectified && (info.p[0] != 0 || !has_no_distortion(info));
  const Axis x{by_p ? info.p[0] : info.k[0],
               by_p ? info.p[2] : info.k[2],
               info.width,
               info.roi.x_offset,
               info.roi.width,
               info.binning_x};
  const Axis y{by_p ? info.p[5] : info.k[4],
               by_p ? info.p[6] : info.k[5],
               info.height,
               info.roi.y_offset,
               info.roi.height,
               info.binning_y};
  camera.fx_px = x.focal(), camera.cx_px = x.center();
  camera.fy_px = y.focal(), camera.cy_px = y.center();
  const bool has_size = info.width > 0 && info.height > 0;
  camera.width_px = has_size ? x.size() : images.width_px;
  camera.height_px = has_size ? y.size() : images.height_px;
  if (images.width_px > 0 &&
      (images.width_px != camera.width_px || images.height_px != camera.height_px))
    throw InputError(fmt::format("is for {} x {} pixels, but the images have {} x {}",
                                 camera.width_px, camera.height_px, images.width_px,
                                 images.height_px));
  if (!rectified) set_distortion(camera, info);
  std::vector<Stamp> stamps_ns;
  for (const StoredImage& image : images.images) stamps_ns.push_back(image.stamp_ns);
  camera.rate_hz = rate_of_hz(stamps_ns);
  return camera;
}

Camera color_camera(const ChosenTopics& chosen, const RosTopics& topics) {
  Camera camera = camera_of(*chosen.color, chosen.info->info);
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
        fmt::format("{}: holds no sensor_msgs/CameraInfo for {}; name its topic (info=TOPIC) or a "
                    "settings file with --settings, in a suite with `settings:`",
                    file, chosen.color->name));
  if (chosen.info->other_at_ns)
    notes.push_back(
        fmt::format("{}: the calibration of {} changes at {} ns: the first is used for all frames",
                    file, chosen.info->topic, *chosen.info->other_at_ns));
  try {
    return color_camera(chosen, topics);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: the calibration of {}: {}; a settings file replaces it "
                    "(--settings, in a suite `settings:`)",
                    file, chosen.color->name, error.what()));
  }
}

/// The transform that RealSense's recorder stores for the stream of an image topic; the topic's
/// name begins with the stream's name. @returns the end of the transform's name ("/tf/0"), and
/// stream_from_reference
std::optional<std::pair<std::string, SE3>> recorded_tf(const RosTopics& topics,
                                                       const ImageTopic& images) {
  for (const auto& [name, stream_from_reference] : topics.transforms) {
    const std::size_t mark = name.rfind("/tf/");
    if (mark != std::string::npos && images.name.starts_with(name.substr(0, mark + 1)))
      return std::pair(name.substr(mark), stream_from_reference);
  }
  return std::nullopt;
}

bool have_sizes_of_their_own(const ImageTopic& color, const ImageTopic& depth) {
  return color.width_px > 0 && depth.width_px > 0 &&
         (color.width_px != depth.width_px || color.height_px != depth.height_px);
}

/// color_from_depth as stated in a file; nullopt if it is not stated, or if the two frames already
/// coincide.
std::optional<SE3> color_from_depth(const ChosenTopics& chosen, const RosTopics& topics) {
  const ImageTopic &color = *chosen.color, &depth = *chosen.depth;
  const auto color_tf = recorded_tf(topics, color), depth_tf = recorded_tf(topics, depth);
  if (color_tf && depth_tf && color_tf->first == depth_tf->first)
    return (color_tf->second * depth_tf->second.inverse()).normalized();
  // Drivers that align depth to color still publish the calibration of the unaligned depth with it;
  // only the frame id reveals that depth is aligned.
  if (color.frame == depth.frame)
    return have_sizes_of_their_own(color, depth) ? std::optional(SE3()) : std::nullopt;
  if (auto fixed = fixed_transform(topics, color.frame, depth.frame);
      fixed && !color.frame.empty() && !depth.frame.empty())
    return fixed;
  const std::string camera = color.name.substr(0, color.name.find('/', 1)) + "/";
  for (const auto& [name, transform] : topics.transforms)
    if (name.starts_with(camera) && name.ends_with("/extrinsics/depth_to_color")) return transform;
  return std::nullopt;
}

/// Whether the calibrations of depth and color differ, as far as the file states them.
bool differ(const ChosenTopics& chosen) {
  constexpr double kSame_px = 1;
  const ImageTopic &color = *chosen.color, &depth = *chosen.depth;
  if (have_sizes_of_their_own(color, depth)) return true;
  if (chosen.info == nullptr || chosen.depth_info == nullptr) return false;
  const ros::CameraInfo &a = chosen.info->info, &b = chosen.depth_info->info;
  return std::ranges::any_of(std::array{0U, 2U, 4U, 5U},
                             [&](std::size_t i) { return std::abs(a.k[i] - b.k[i]) > kSame_px; });
}

/// Whether a transform moves points by less than any camera could measure.
bool is_identity(const SE3& transform) {
  constexpr double kNone = 1e-6;
  return transform.translation().norm() < kNone && angle_between_rad(transform, SE3()) < kNone;
}

/// The depth camera for registering depth to color; nullopt if depth is already registered, or must
/// be used as if it were, in which case a note is added.
/// @throws InputError if the sizes differ and the file does not state how to register depth.
std::optional<DepthCamera> depth_camera(const ChosenTopics& chosen, const RosTopics& topics,
                                        const std::string& file, std::vector<std::string>& notes) {
  const ImageTopic &color = *chosen.color, &depth = *chosen.depth;
  const bool other_frame = color.frame != depth.frame;
  const std::optional<SE3> transform = color_from_depth(chosen, topics);
  const bool apart = other_frame && transform && !is_identity(*transform);
  if (!differ(chosen) && !apart) return std::nullopt;
  // If a file has only one calibration, it applies to both.
  const bool has_own = chosen.depth_info != nullptr && chosen.depth_info != chosen.info;
  if (transform && has_own) {
    DepthCamera registering{{}, *transform};
    try {
      registering.camera = camera_of(depth, chosen.depth_info->info);
      validate(registering.camera);
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}: the calibration of {}: {}", file, depth.name, error.what()));
    }
    notes.push_back(fmt::format(
        "{}: depth of {} is registered to color of {}: {} x {} pixels at {:.4g} m from it", file,
        depth.name, color.name, registering.camera.width_px, registering.camera.height_px,
        transform->translation().norm()));
    return registering;
  }
  if (have_sizes_of_their_own(color, depth))
    throw InputError(fmt::format(
        "{}: depth of {} is {} x {}, color of {} is {} x {}, and {} tells how to register it: a "
        "topic with depth registered to color is needed",
        file, depth.name, depth.width_px, depth.height_px, color.name, color.width_px,
        color.height_px, has_own ? "neither tf nor extrinsics" : "no CameraInfo of depth"));
  notes.push_back(fmt::format(
      "{}: depth of {} has a different {} from color of {}: it is used as if it were registered",
      file, depth.name, differ(chosen) ? "calibration" : "frame", color.name));
  return std::nullopt;
}

/// Whether depth is stored in meters, as floating-point numbers.
bool is_in_meters(const ImageTopic& depth) {
  return depth.encoding.starts_with("32FC1");
}

/// The decimal number that a float was rounded from.
double meant(float value) {
  return std::stod(fmt::format("{}", value));
}

/// Units of integer depth per meter: from the settings, otherwise from the file, otherwise 1000.
double depth_per_meter(const ImageTopic& depth, const RosTopics& topics,
                       const RecordingConfig& config, const std::string& file,
                       std::vector<std::string>& notes) {
  const std::optional<double> named = !config.calibration.empty() && config.depth_per_meter
                                          ? config.depth_per_meter(config.calibration)
                                          : std::nullopt;
  if (is_in_meters(depth)) {
    if (named && *named != 1)
      notes.push_back(fmt::format("{}: its depth per meter, {:g}, is not used: {} is in meters",
                                  config.calibration.string(), *named, depth.name));
    return kRosDepthPerMeter;
  }
  double stated = kRosDepthPerMeter;
  for (const auto& [prefix, units] : topics.depth_units) {
    if (!depth.name.starts_with(prefix)) continue;
    stated = 1 / meant(units.front());
    if (units.size() > 1)
      notes.push_back(
          fmt::format("{}: the unit of depth changes from {} m to {} m: the first is "
                      "used for all frames",
                      file, units[0], units[1]));
  }
  if (!named || *named == stated) return stated;
  notes.push_back(fmt::format("{}: its depth per meter, {:g}, is used for {}, not {:g}",
                              config.calibration.string(), *named, depth.name, stated));
  return *named;
}

}  // namespace

RosCameras ros_cameras(const ChosenTopics& chosen, const RosTopics& topics,
                       const RecordingConfig& config, const std::string& file,
                       std::vector<std::string>& notes) {
  RosCameras cameras;
  cameras.color = calibrated(chosen, topics, config, file, notes);
  cameras.depth = depth_camera(chosen, topics, file, notes);
  cameras.depth_per_meter = depth_per_meter(*chosen.depth, topics, config, file, notes);
  return cameras;
}

}  // namespace mh
