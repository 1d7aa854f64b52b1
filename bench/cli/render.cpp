// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/detector_option.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/render_motion.hpp"
#include "bench/cli/ros_output.hpp"
#include "bench/cli/scene_option.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/protocol/world/cached_detections.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/run/signal_watch.hpp"
#include "bench/suite/check_labels.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/labels.hpp"
#include "scenes/load.hpp"
#include "scenes/recordings/euroc.hpp"
#include "scenes/recordings/file_checksums.hpp"
#include "scenes/recordings/ros/recorder.hpp"
#include "scenes/scannet/files.hpp"
#include "sim/sensors/imu.hpp"
#include "sim/sensors/shutter.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/render_sequence.hpp"
#include "sim/simulation/robot_messages.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

struct RenderArguments {
  std::string scene, robot = "pepper", camera, level, pedestrian, out, format = "tum",
                     renderer = "embree";
  std::string labels = "exact";
  RenderMotion motion;
  SceneFrameOption frame;
  DetectorOption detector;
  RenderSequenceOptions sequence;
  PngCompression png_compression;
  double stereo_m = 0;
  RosOption ros;
  bool json = false;
};

/// The digest that an input had when it was read; empty if there is no input of that name.
std::string digest_of(const std::vector<InputDigest>& inputs, std::string_view name) {
  const auto input = std::ranges::find(inputs, name, &InputDigest::name);
  return input == inputs.end() ? "" : hex(input->digest);
}

/// Everything that determines the images: a folder is resumed only if all of this is unchanged.
/// @param inputs  digests of what was read for robot (with its URDF), level, pedestrian and
/// detector
std::string settings_of(const RenderArguments& o, const Scene& scene, const Trajectory& path,
                        const std::vector<InputDigest>& inputs) {
  nlohmann::ordered_json json = {{"scene", o.scene},
                                 {"scene_digest", hex(digest(scene))},
                                 {"motion", o.motion.text()},
                                 {"path_digest", hex(digest(path))},
                                 {"robot", o.robot},
                                 {"robot_digest", digest_of(inputs, "robot")},
                                 {"camera", o.camera},
                                 {"level", o.level},
                                 {"level_digest", digest_of(inputs, "level")},
                                 {"pedestrian", o.pedestrian},
                                 {"pedestrian_digest", digest_of(inputs, "pedestrian")},
                                 {"format", o.format},
                                 {"renderer", o.renderer},
                                 {"every", o.sequence.every},
                                 {"seed", o.sequence.seed}};
  if (o.sequence.labels != LabelMode::kExact) json["labels"] = name(o.sequence.labels);
  if (is_ros_format(o.format)) json["chunk_compression"] = o.ros.compression;
  if (const auto spec = o.detector.spec()) {
    json["detector"] = source_of(*spec).filename().string();
    json["detector_digest"] = digest_of(inputs, "detector");
    json["detector_settings"] = format_detector_settings(spec->settings, false);
  }
  if (o.stereo_m > 0) json["stereo"] = o.stereo_m;
  if (o.png_compression) json["png_compression"] = *o.png_compression;
  if (o.sequence.frames != SIZE_MAX) json["frames"] = o.sequence.frames;
  return json.dump(2) + "\n";
}

/// The first file or folder that shows that a folder holds a sequence; empty if it holds none.
fs::path part_of_sequence(const fs::path& folder) {
  for (const char* part : {"rgb", "rgb.txt", "color", "intrinsic", "mav0"})
    if (fs::exists(folder / part)) return folder / part;
  for (const char* whole : {"*.sens", "*.bag", "*.mcap"})
    if (const auto files = list_folder(folder, whole); !files.empty())
      return folder / files.front();
  return {};
}

/// Refuses a folder with an older sequence: images of two tours in one folder would look like one
/// sequence.
void refuse_older_sequence(const fs::path& folder) {
  if (!is_folder(folder) || fs::exists(folder / "render.json"))
    return;  // compared later, when all settings are known
  if (const fs::path part = part_of_sequence(folder); !part.empty())
    throw InputError(fmt::format("{}: already holds a sequence ({}); name another folder",
                                 folder.string(), part.filename().string()));
}

/// Names of the written files and folders.
std::vector<std::string> names_written(const fs::path& out) {
  const std::string name = name_of_folder(out);
  std::vector<std::string> names{"render.json",
                                 "associations.txt",
                                 "groundtruth.txt",
                                 "camera.yaml",
                                 "camera_info.yaml",
                                 FileChecksums::kName,
                                 "mav0",
                                 "_info.txt",
                                 kLabelTableV2,
                                 name + "_2d-label-filt.zip",
                                 name + "_2d-instance-filt.zip",
                                 name + ".sens",
                                 name + ".mcap",
                                 name + ".bag"};
  for (const std::string part : {"rgb", "depth", "label", "instance"}) {
    names.push_back(part);
    names.push_back(part + ".txt");
  }
  for (const char* part : {"color", "pose", "intrinsic", "label-filt", "instance-filt"})
    names.emplace_back(part);
  return names;
}

/// The camera named by --camera; nullptr for the robot's own.
const MountedCamera* find_camera(const RenderArguments& options, const Robot& robot) {
  if (options.camera.empty()) return nullptr;
  if (!robot.equipment)
    throw InputError(
        fmt::format("--camera {}: robot '{}' has no further cameras", options.camera, robot.name));
  for (const MountedCamera& mounted : robot.equipment->cameras)
    if (mounted.name == options.camera) return &mounted;
  throw InputError(
      fmt::format("--camera {}: robot '{}' has no such camera", options.camera, robot.name));
}

/// Poses of a camera while the robot drives along its path.
Trajectory path_of(const MountedCamera& mounted, const Equipment& e, const DrivenPath& path) {
  Trajectory camera = path.camera;
  for (std::size_t i = 0; i < path.base.size(); ++i) {
    std::map<std::string, double> joints;
    if (!path.head.empty())
      joints = {{e.head->yaw, path.head[i][0]}, {e.head->pitch, path.head[i][1]}};
    camera[i].world_from_camera =
        path.base[i].world_from_camera * e.base_from(mounted.link, joints);
  }
  return camera;
}

/// The path of a second camera, to the right of the first.
Trajectory beside(Trajectory path, double right_m) {
  const SE3 first_from_second(Eigen::Matrix3d::Identity(), {right_m, 0, 0});
  for (TimedPose& pose : path) pose.world_from_camera = pose.world_from_camera * first_from_second;
  return path;
}

void print_json(const RenderedSequence& done) {
  fmt::print("{}\n", nlohmann::ordered_json({{"frames", done.frames},
                                             {"resumed", done.resumed},
                                             {"render_s", done.render_s},
                                             {"encode_s", done.encode_s}})
                         .dump(2));
}

void run(RenderArguments options) {
  resolve(options.scene, Shipped::kScene);
  resolve(options.robot, Shipped::kRobot);
  resolve(options.level, Shipped::kLevel);
  const fs::path out = options.out;
  for (const LabelMode mode :
       {LabelMode::kExact, LabelMode::kAnnotated, LabelMode::kBoxes, LabelMode::kDetector})
    if (options.labels == name(mode)) options.sequence.labels = mode;
  refuse_older_sequence(out);
  options.ros.check(options.format);
  if (options.stereo_m > 0 && options.format != "euroc")
    throw InputError(fmt::format("--stereo {:g}: only --format euroc has a second camera, not {}",
                                 options.stereo_m, options.format));
  make_renderer(options.renderer, Scene{});  // fails at once if the machine lacks this renderer
  const OutputFolder folder(out, "render", names_written(out));
  options.motion.read();
  std::vector<InputDigest> inputs;
  std::vector<std::string> warnings;
  const Robot robot =
      noted(inputs, "robot", options.robot, [&] { return load_robot(options.robot, &warnings); });
  std::shared_ptr<const Detector> detector;
  if (const auto spec = options.detector.spec()) {
    detector = noted(inputs, "detector", source_of(*spec), [&] { return open_detector(*spec); });
    options.sequence.relabel = [detector, fill = spec->settings.fill,
                                keep = detections_in(options.detector.opened_cache("render"))](
                                   RgbdFrame& frame, std::size_t i) {
      frame.semantics = labels_of(detect_kept(*detector, frame, i, keep), frame.depth_m,
                                  frame.color.width(), frame.color.height(), fill);
    };
    options.sequence.labels = LabelMode::kNone;
  }
  const MountedCamera* const mounted = find_camera(options, robot);
  SensorConfig sensors = exact_sensors();
  if (!options.level.empty())
    sensors =
        noted(inputs, "level", options.level, [&] { return load_sensor_config(options.level); });
  std::optional<Pedestrian> pedestrian;
  if (!options.pedestrian.empty())
    pedestrian = noted(inputs, "pedestrian", options.pedestrian,
                       [&] { return load_pedestrian(options.pedestrian); });

  Progress progress("render");
  progress.say(fmt::format("scene {}", options.scene));
  const Scene scene = [&] {
    Progress light("light");
    Scene loaded = load_scene(options.scene, &warnings, options.frame.frame());
    light_from_cache(loaded, options.sequence.threads, usual_cache(), {},
                     [&](double share) { light.share(share); });
    return loaded;
  }();
  if (std::string warning = check_labels(scene, options.sequence.labels); !warning.empty())
    warnings.push_back(std::move(warning));
  for (const std::string& warning : warnings) progress.say("warning: " + warning);
  const std::shared_ptr<const Renderer> renderer = make_scene_renderer(scene, options.renderer);
  std::vector<MovingObstacle> others;
  if (pedestrian) others.push_back(as_obstacle(scene, *pedestrian));
  const DrivenPath driven = options.motion.path(scene, robot, others, sensors,
                                                [&](std::string_view line) { progress.say(line); });
  const Camera camera = mounted != nullptr ? mounted->camera : robot.camera;
  const Trajectory path = mounted != nullptr && !options.motion.is_of_camera()
                              ? path_of(*mounted, *robot.equipment, driven)
                              : driven.camera;

  if (detector != nullptr) {
    progress.say("labels from " + detector->description());
    std::vector<Stamp> stamps_ns;
    for (std::size_t i = 0; i < std::min(options.sequence.frames, path.size()); ++i)
      stamps_ns.push_back(path[i].stamp_ns);
    if (const std::string note = detector->check_frames(stamps_ns); !note.empty())
      progress.say("warning: " + note);
  }
  const std::string settings = settings_of(options, scene, path, inputs);
  const bool holds_frames = fs::exists(out / "render.json") && !part_of_sequence(out).empty();
  if (holds_frames) {
    if (read_file(out / "render.json") != settings)
      throw InputError(fmt::format(
          "{}: already contains a sequence with other settings (see its render.json); name another "
          "folder",
          out.string()));
    options.sequence.resume = true;
  }
  write_atomically(out / "render.json", settings);
  const bool goes_on =
      options.format == "tum" || options.format == "scannet-frames" || options.format == "euroc";
  const SignalWatch watch;
  const auto report = [&](double share) {
    if (watch.signal() != 0) throw Interrupted{watch.signal(), goes_on};
    progress.share(share);
  };
  std::shared_ptr<const PedestrianScene> pedestrian_scene;
  if (pedestrian) pedestrian_scene = make_pedestrian_scene(scene, renderer, *pedestrian);
  const auto shutter_along = [&](const Trajectory& along) {
    return pedestrian_scene
               ? Shutter([pedestrian_scene](Stamp stamp) { return pedestrian_scene->at(stamp); },
                         camera, along, sensors)
               : Shutter(renderer, camera, along, sensors);
  };
  const Shutter shutter = shutter_along(path);
  const Camera reported_camera = recorded_camera(shutter.camera(), options.sequence);
  if (options.format == "scannet") {  // one file: frames are added in order
    const std::vector<std::size_t> wanted = moments(shutter, sensors, options.sequence);
    using Clock = std::chrono::steady_clock;
    const auto seconds_since = [](Clock::time_point start) {
      return std::chrono::duration<double>(Clock::now() - start).count();
    };
    const Clock::time_point start = Clock::now();
    RenderedSequence done{.frames = wanted.size()};
    write_scannet_recording(out, reported_camera, wanted.size(), [&](std::size_t k) {
      report(static_cast<double>(k) / static_cast<double>(wanted.size()));
      const Clock::time_point begun = Clock::now();
      ExactFrame frame = exact_frame(shutter, sensors, options.sequence, wanted[k]);
      done.render_s += seconds_since(begun);
      return frame;
    });
    done.encode_s = seconds_since(start) - done.render_s;
    progress.share(1);
    progress.end();
    if (options.json) print_json(done);
    return;
  }
  if (options.format == "euroc") {
    const int cameras = options.stereo_m > 0 ? 2 : 1;
    EurocCameraWriter left(out, 0, 0, reported_camera, options.png_compression);
    RenderedSequence done = render_sequence(shutter, sensors, left, options.sequence,
                                            [&](double share) { report(share / cameras); });
    if (cameras == 2) {
      EurocCameraWriter right(out, 1, options.stereo_m, reported_camera, options.png_compression);
      RenderSequenceOptions other = options.sequence;
      other.is_second = true;
      const RenderedSequence more =
          render_sequence(shutter_along(beside(path, options.stereo_m)), sensors, right, other,
                          [&](double share) { report(0.5 + share / 2); });
      done.frames += more.frames;
      done.resumed += more.resumed;
      done.render_s += more.render_s;
      done.encode_s += more.encode_s;
    }
    const ImuConfig& imu = sensors.imu;
    write_euroc_states(
        out, left.truth(), path, imu_along(path, imu, RandomStream(options.sequence.seed)),
        {imu.rate_hz, imu.gyro_noise, imu.gyro_walk, imu.accel_noise, imu.accel_walk});
    progress.end();
    if (options.json) print_json(done);
    return;
  }
  std::unique_ptr<SequenceWriter> writer;
  if (is_ros_format(options.format)) {
    std::unique_ptr<MessageWriter> file = options.ros.open(options.format, out);
    std::optional<MessageLog> of_robot;
    if (options.motion.is_driven())
      of_robot = robot_messages(
          file->wire(), record_drive(scene, robot, driven, path, options.sequence.seed, others));
    writer = std::make_unique<RosRecorder>(std::move(file), reported_camera, std::move(of_robot));
  } else {
    writer = make_sequence_writer(options.format, out, reported_camera, options.png_compression);
  }
  const RenderedSequence done =
      render_sequence(shutter, sensors, *writer, options.sequence, report);
  progress.end();
  if (options.json) print_json(done);
}

}  // namespace

void add_render(CLI::App& app) {
  auto options = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand(
      "render",
      "Renders what a camera sees on its path through a scene, with labels, instances and poses.");
  command
      ->add_option("scene", options->scene,
                   "Scene (YAML), mesh file, or the name of a shipped scene")
      ->required();
  options->motion.add_to(*command);
  options->frame.add_to(*command);
  command->add_option("--robot", options->robot,
                      "Robot (YAML), or the name of a shipped one: base and camera");
  command->add_option("--camera", options->camera,
                      "Another of the robot's cameras, by its name in the robot's file");
  command->add_option("--level", options->level,
                      "Sensor level (YAML), or the name of a shipped one (default: no noise)");
  command->add_option("--pedestrian", options->pedestrian,
                      "Adds a pedestrian (YAML), who can get in the way of a driving robot");
  command
      ->add_option("--out", options->out,
                   "Folder to write; resumes where it was stopped (scannet, mcap and rosbag start "
                   "over, since a single file is written in one go)")
      ->required();
  command
      ->add_option(
          "--format", options->format,
          "tum: folders and lists; euroc: gray images, inertial readings, truth; scannet: .sens, "
          "label images; scannet-frames: folders as extracted from a .sens; mcap, rosbag: "
          "NAME.mcap (ROS 2) or NAME.bag (ROS 1), with everything that the robot measures")
      ->check(one_of_words({"tum", "euroc", "scannet", "scannet-frames", "mcap", "rosbag"}));
  command
      ->add_option("--stereo", options->stereo_m,
                   "euroc: adds a second camera this many meters to the right")
      ->check(CLI::Range(0.001, 10.0));
  options->ros.add_to(*command);
  command->add_option("--frames", options->sequence.frames, "At most this many frames of the path")
      ->default_str("all")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--every", options->sequence.every, "Every n-th frame only")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--renderer", options->renderer, "embree or osmesa")
      ->check(one_of_words({"embree", "osmesa"}));
  CLI::Option* labels = command
                            ->add_option("--labels", options->labels,
                                         "exact, annotated, boxes or detector: what `label` "
                                         "contains, including the level's faults")
                            ->check(one_of_words({"exact", "annotated", "boxes", "detector"}));
  for (CLI::Option* option : options->detector.add_to(*command)) labels->excludes(option);
  command->add_option("--seed", options->sequence.seed, "Seed of the noise")->check(seed_number());
  command
      ->add_option("--threads", options->sequence.threads,
                   "Frames processed in parallel; does not change any byte")
      ->check(CLI::Range(1, 256));
  command
      ->add_option("--png-compression", options->png_compression,
                   "0 (none) to 9 (smallest) (default: 1)")
      ->check(CLI::Range(0, 9));
  command->add_flag("--json", options->json,
                    "Prints JSON: the number of frames written and the time of each stage");
  command->footer(
      "Example:\n  modelhouse render office --motion handheld:0 --level handheld "
      "--out out/sequence");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
