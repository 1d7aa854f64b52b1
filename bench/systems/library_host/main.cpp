// SPDX-License-Identifier: Apache-2.0
// modelhouse-library-host LIBRARY SEED [SETTINGS]: conducts the conversation
// (docs/outside_systems.md) on behalf of a shared library (include/modelhouse/system.h), so that no
// foreign code is ever loaded into the bench. What the library prints goes to standard error.
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "include/modelhouse/system.h"
#include "slam/core/relocalization_stage.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/files.hpp"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// What the library did wrong, as the reply to a request.
struct Fault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

mh_pose pose_of(const Json& told) {
  mh_pose pose{};
  for (std::size_t i = 0; i < std::size(pose.values); ++i)
    pose.values[i] = told.at(i).get<double>();
  return pose;
}

/// An image that the bench wrote: binary PPM or PGM, 8 or 16 bit.
class Image {
 public:
  explicit Image(const std::string& file) : bytes_(mh::read_file(file)) {
    int kind = 0, most = 0, end = 0;
    if (std::sscanf(bytes_.c_str(), "P%d %d %d %d%n", &kind, &width, &height, &most, &end) != 4)
      throw Fault(file + ": is not an image");
    first_ = static_cast<std::size_t>(end) + 1;
  }
  const std::uint8_t* bytes() const {
    return reinterpret_cast<const std::uint8_t*>(bytes_.data()) + first_;
  }
  /// Pixels of two bytes each, which are big-endian in the file.
  std::vector<std::uint16_t> shorts() const {
    std::vector<std::uint16_t> pixels(static_cast<std::size_t>(width) *
                                      static_cast<std::size_t>(height));
    for (std::size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = static_cast<std::uint16_t>(bytes()[2 * i] << 8 | bytes()[2 * i + 1]);
    return pixels;
  }
  int width = 0, height = 0;

 private:
  std::string bytes_;
  std::size_t first_ = 0;
};

/// The mh_setup that the library is created from, with everything that it points to.
class Setup {
 public:
  Setup(const Json& hello, std::uint64_t seed, std::string settings)
      : settings_(std::move(settings)), classes_(hello.at("classes")) {
    for (const std::string& name : classes_) class_names_.push_back(name.c_str());
    const Json& camera = hello.at("camera");
    const auto number = [&](const char* key) { return camera.value(key, 0.0); };
    told = {.version = MH_SYSTEM_VERSION,
            .camera = {.width_px = camera.at("width"),
                       .height_px = camera.at("height"),
                       .fx_px = number("fx"),
                       .fy_px = number("fy"),
                       .cx_px = number("cx"),
                       .cy_px = number("cy"),
                       .k1 = number("k1"),
                       .k2 = number("k2"),
                       .p1 = number("p1"),
                       .p2 = number("p2"),
                       .k3 = number("k3"),
                       .rate_hz = number("fps"),
                       .baseline_m = number("bf") / number("fx"),
                       .depth_per_meter = hello.at("depth_per_meter")},
            .seed = seed,
            .settings = settings_.empty() ? nullptr : settings_.c_str(),
            .class_count = static_cast<std::int32_t>(class_names_.size()),
            .classes = class_names_.data(),
            .message = message_.data(),
            .k4 = number("k4"),
            .k5 = number("k5"),
            .k6 = number("k6")};
  }
  Setup(const Setup&) = delete;
  Setup& operator=(const Setup&) = delete;

  void clear_message() { message_.fill('\0'); }
  /// ": what the library wrote", or an empty string.
  std::string message() const {
    const std::string text(message_.data(), strnlen(message_.data(), message_.size()));
    return text.empty() ? text : ": " + text;
  }
  mh_setup told{};

 private:
  std::string settings_;
  std::vector<std::string> classes_;
  std::vector<const char*> class_names_;
  std::array<char, MH_MESSAGE_SIZE> message_{};
};

Json pose_json(const mh_pose& pose) {
  for (const double value : pose.values)
    if (!std::isfinite(value))
      throw Fault(fmt::format("gave a pose of [{}]: a number is not finite",
                              fmt::join(std::begin(pose.values), std::end(pose.values), ", ")));
  return std::to_array(pose.values);
}

Json reply_json(const mh_reply& reply) {
  Json json = {{"pose", reply.has_pose != 0 ? pose_json(reply.pose) : Json()}};
  const auto count = [](Json& into, const char* key, std::int32_t number) {
    if (number != MH_UNKNOWN) into[key] = number;
  };
  count(json, "keypoints", reply.keypoints);
  count(json, "inliers", reply.inliers);
  json["keyframe"] = reply.keyframe_added != 0;
  json["map_reset"] = reply.map_reset != 0;
  using Stage = mh::RelocalizationStage;
  static_assert(static_cast<int>(Stage::kVerified) == MH_STAGE_VERIFIED);
  if (reply.stage < MH_STAGE_UNKNOWN || reply.stage > MH_STAGE_VERIFIED)
    throw Fault(fmt::format("gave an unknown stage {}", reply.stage));
  if (reply.stage != MH_STAGE_UNKNOWN) json["stage"] = name(static_cast<Stage>(reply.stage));
  Json candidates = Json::object();
  count(candidates, "keyframes", reply.keyframes);
  count(candidates, "c1", reply.c1);
  count(candidates, "c2", reply.c2);
  count(candidates, "c3", reply.c3);
  count(candidates, "final", reply.final);
  if (!candidates.empty()) json["candidates"] = candidates;
  return json;
}

/// Calls `function`; turns exceptions that escape from the library into faults.
template <class Function>
auto guarded(const Function& function) {
  try {
    return function();
  } catch (const std::exception& exception) {
    throw Fault(fmt::format("let an exception escape: {}", exception.what()));
  } catch (...) {
    throw Fault("let an exception escape");
  }
}

using MakeSystem = mh_system* (*)(const mh_setup*);

/// @throws Fault
MakeSystem load(const fs::path& file) {
  void* loaded = guarded([&] { return dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL); });
  if (loaded == nullptr) {
    std::string reason = dlerror();  // starts with the file's path, which differs by machine
    if (reason.starts_with(file.string() + ": ")) reason.erase(0, file.string().size() + 2);
    throw Fault("cannot be loaded: " + reason);
  }
  constexpr const char* kMake = "mh_make_system";
  const auto make = reinterpret_cast<MakeSystem>(dlsym(loaded, kMake));
  if (make == nullptr) throw Fault(fmt::format("has no function {}: is it extern \"C\"?", kMake));
  return make;
}

/// The library's system, created from the request `hello`.
class HostedSystem {
 public:
  HostedSystem(const Json& hello, const fs::path& library, std::uint64_t seed, std::string settings)
      : setup_(hello, seed, std::move(settings)) {
    const MakeSystem make = load(library);
    system_ = guarded([&] { return make(&setup_.told); });
    if (system_ == nullptr) throw Fault("created no system" + setup_.message());
    if (system_->version != MH_SYSTEM_VERSION)
      throw Fault(
          fmt::format("was built with version {} of modelhouse/system.h, the bench has version {}",
                      system_->version, MH_SYSTEM_VERSION));
    for (const auto& [name, there] : {std::pair("track", system_->track != nullptr),
                                      {"rewind", system_->rewind != nullptr},
                                      {"reset", system_->reset != nullptr},
                                      {"freeze", system_->freeze != nullptr},
                                      {"relocalize", system_->relocalize != nullptr},
                                      {"destroy", system_->destroy != nullptr}})
      if (!there) throw Fault(fmt::format("left the function {} empty", name));
  }

  Json reply(const std::string& what, const Json& request) {
    if (what == "rewind") return call(system_->rewind), Json::object();
    if (what == "reset") return call(system_->reset), Json::object();
    if (what == "freeze") return freeze();
    if (what == "track") return show(system_->track, request);
    if (const std::uint64_t session = request.at("session"); session != session_) {
      session_ = session;
      if (system_->begin_query != nullptr) call(system_->begin_query);
    }
    return show(what == "blank" ? system_->blank : system_->relocalize, request);
  }
  void destroy() {
    guarded([&] { system_->destroy(system_->self); });
  }

 private:
  /// Calls a function that returns a status.
  template <class Function, class... Arguments>
  void call(Function* function, Arguments... arguments) {
    setup_.clear_message();
    const int status = guarded([&] { return function(system_->self, arguments...); });
    if (status != 0) throw Fault(fmt::format("reported an error ({}){}", status, setup_.message()));
  }

  Json show(int (*function)(void*, const mh_frame*, mh_reply*), const Json& request) {
    mh_reply reply{};
    for (std::int32_t* unknown : {&reply.keypoints, &reply.inliers, &reply.keyframes, &reply.c1,
                                  &reply.c2, &reply.c3, &reply.final})
      *unknown = MH_UNKNOWN;
    if (function == nullptr) return reply_json(reply);
    const Image color(request.at("color"));
    const std::vector<std::uint16_t> depth = Image(request.at("depth")).shorts();
    std::optional<Image> labels;
    if (request.contains("labels")) labels.emplace(request.at("labels"));
    std::optional<mh_pose> odometry;
    if (request.contains("odometry")) odometry = pose_of(request.at("odometry"));
    std::vector<std::vector<float>> ranges_m;
    std::vector<mh_laser> lasers;
    const Json scans = request.value("lasers", Json::array());
    for (const Json& told : scans) {
      ranges_m.push_back(told.at("ranges_m"));
      lasers.push_back({.name = told.at("name").get_ref<const std::string&>().c_str(),
                        .camera_from_laser = pose_of(told.at("camera_from_laser")),
                        .first_rad = told.at("first_rad"),
                        .step_rad = told.at("step_rad"),
                        .min_range_m = told.at("limits_m").at(0),
                        .max_range_m = told.at("limits_m").at(1),
                        .ranges_m = ranges_m.back().data(),
                        .range_count = static_cast<std::int32_t>(ranges_m.back().size())});
    }
    std::vector<mh_imu> imu;
    for (const Json& told : request.value("imu", Json::array())) {
      mh_imu& reading = imu.emplace_back();
      reading.stamp_ns = mh::parse_stamp(told.at(0).get_ref<const std::string&>());
      for (std::size_t i = 0; i < 3; ++i) {
        reading.turn_rad_per_s[i] = told.at(1 + i).get<double>();
        reading.specific_force_m_per_s2[i] = told.at(4 + i).get<double>();
      }
    }
    const mh_frame frame = {
        .stamp_ns = mh::parse_stamp(request.at("stamp").get_ref<const std::string&>()),
        .width_px = color.width,
        .height_px = color.height,
        .color = color.bytes(),
        .depth = depth.data(),
        .labels = labels ? labels->bytes() : nullptr,
        .seed = request.at("seed"),
        .odometry = odometry ? &*odometry : nullptr,
        .imu = imu.data(),
        .imu_count = static_cast<std::int32_t>(imu.size()),
        .lasers = lasers.data(),
        .laser_count = static_cast<std::int32_t>(lasers.size())};
    call(function, &frame, &reply);
    return reply_json(reply);
  }

  Json freeze() {
    call(system_->freeze);
    if (system_->trajectory == nullptr) return Json::object();
    Json lines = Json::array();
    const mh_add_pose add = [](void* to, std::int64_t stamp_ns, const mh_pose* pose) {
      static_cast<Json*>(to)->push_back(
          fmt::format("{} {}", mh::format_stamp(stamp_ns),
                      fmt::join(std::begin(pose->values), std::end(pose->values), " ")));
    };
    call(system_->trajectory, add, &lines);
    return {{"trajectory", lines}};
  }

  Setup setup_;
  mh_system* system_ = nullptr;
  std::uint64_t session_ = 0;
};

/// Takes standard input and output out of the library's reach and returns them: the library finds
/// nothing to read, and prints to the log.
std::pair<int, std::FILE*> take_streams() {
  const int requests = fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
  const int replies = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (requests < 0 || replies < 0 || nothing < 0) std::exit(3);
  dup2(nothing, STDIN_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  return {requests, fdopen(replies, "w")};
}

void flush_log() {
  std::fflush(stdout);
  std::cout.flush();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fprintf(stderr, "usage: modelhouse-library-host LIBRARY SEED [SETTINGS]\n");
    return 2;
  }
  const auto [requests, replies] = take_streams();
  std::FILE* lines = fdopen(requests, "r");
  std::unique_ptr<HostedSystem> system;
  char* line = nullptr;
  std::size_t room = 0;
  while (getline(&line, &room, lines) > 0) {
    const Json request = Json::parse(line);
    const std::string what = request.at("do");
    Json reply = {{"id", request.at("id")}};
    try {
      if (what == "hello") {
        system = std::make_unique<HostedSystem>(request, argv[1], std::stoull(argv[2]),
                                                argc > 3 ? argv[3] : "");
        reply.update({{"protocol", request.at("protocol")}, {"name", argv[1]}});
      } else {
        reply.update(system->reply(what, request));
      }
    } catch (const Fault& fault) {
      reply["error"] = fault.what();
    }
    flush_log();
    const std::string text = reply.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    std::fwrite(text.data(), 1, text.size(), replies);
    std::fflush(replies);
    if (reply.contains("error")) _exit(0);  // the library's state is unknown
  }
  if (system) system->destroy();
  flush_log();
  return 0;
}
