// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/conversation.hpp"

#include <array>
#include <mutex>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/suite/find_program.hpp"
#include "bench/systems/child_process.hpp"
#include "bench/systems/outside_error.hpp"
#include "bench/systems/outside_system.hpp"
#include "bench/systems/scratch_folder.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/lower_case.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Request = nlohmann::ordered_json;
// The type of replies: its cost is linear in a reply's length even if the reply has many keys.
using Json = nlohmann::json;

constexpr int kProtocol = 1;
constexpr double kFarewell_s = 5;  // docs/outside_systems.md
constexpr std::size_t kMostOfError = 300;

std::string shortened(std::string_view line, std::size_t most = 120) {
  std::string text(line.substr(0, most));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  return line.size() > most ? text + "..." : text;
}

/// The camera as JSON, with k4 to k6 only if they are not all 0.
Request json_of(const Camera& camera) {
  const Distortion& d = camera.distortion;
  Request json = {{"width", camera.width_px},
                  {"height", camera.height_px},
                  {"fx", camera.fx_px},
                  {"fy", camera.fy_px},
                  {"cx", camera.cx_px},
                  {"cy", camera.cy_px},
                  {"k1", d.k1},
                  {"k2", d.k2},
                  {"p1", d.p1},
                  {"p2", d.p2},
                  {"k3", d.k3},
                  {"fps", camera.rate_hz},
                  {"bf", camera.baseline_m * camera.fx_px}};
  if (d.is_rational()) json.update({{"k4", d.k4}, {"k5", d.k5}, {"k6", d.k6}});
  return json;
}

/// Command that starts a library's host, a program next to this one.
std::string host_command(const OutsideProgram& program, std::uint64_t seed) {
  const auto quoted = [&](const fs::path& file) {
    return shell_quoted(fs::absolute(file).string());
  };
  std::string command = fmt::format("exec {} {} {}", quoted(library_host()),
                                    quoted(program.folder / program.library), seed);
  if (!program.settings.empty()) command += " " + quoted(program.folder / program.settings);
  return command;
}

/// Sends numbered requests and checks that each reply matches.
class Conversation {
 public:
  Conversation(const OutsideProgram& program, const Camera& camera, std::uint64_t seed,
               const fs::path& log)
      : reply_limit_s_(program.reply_limit_s),
        child_(program, command(program, camera, seed), ChildProcess::Talk::kOverPipes, log,
               scratch_.path()) {
    Request classes_by_id = Request::array();
    for (const ClassInfo& info : classes()) classes_by_id.push_back(info.name);
    const Json reply = ask("hello",
                           {{"protocol", kProtocol},
                            {"camera", json_of(camera)},
                            {"depth_per_meter", kDepthPerMeter},
                            {"settings", settings().string()},
                            {"classes", classes_by_id}},
                           {"protocol", "name"});
    if (const auto it = reply.find("protocol"); it == reply.end() || *it != kProtocol)
      fail(it == reply.end()
               ? fmt::format("named no \"protocol\": expected {}", kProtocol)
               : fmt::format("speaks protocol {}, not {}", shortened(it->dump()), kProtocol));
  }

  /// Sends a request and returns its reply. The reply must have this request's number and no keys
  /// other than `known`.
  Json ask(const std::string& what, const Request& fields, const std::set<std::string>& known) {
    const std::lock_guard lock(mutex_);
    doing_ = fmt::format("{} (request {})", what, ++number_);
    Request request = {{"id", number_}, {"do", what}};
    request.update(fields);
    child_.send(request.dump(), doing_);
    const std::string line = child_.read_line(reply_limit_s_, doing_);
    Json reply = parse(line);
    if (const auto it = reply.find("error"); it != reply.end())
      fail(fmt::format("reported an error: {}", shortened(it->dump(), kMostOfError)));
    const auto id = reply.find("id");
    if (id == reply.end() || !id->is_number_integer())
      fail(fmt::format("gave no request number (\"id\") in '{}'", shortened(line)));
    if (*id != number_) fail(fmt::format("replied to request {}, which was not sent", id->dump()));
    for (const auto& [key, value] : reply.items())
      if (key != "id" && !known.contains(key))
        fail(fmt::format("gave an unknown key '{}'", shortened(key)));
    return reply;
  }

  /// Sends a request about a frame and parses the fields that every reply about a frame may
  /// contain.
  SystemReport ask_about(const std::string& what, const RgbdFrame& frame, RandomStream stream,
                         Request fields) {
    const FrameFiles files = image_files(frame);
    images_mb_ =
        static_cast<double>(files.color.size() + files.depth.size() + files.labels.size()) /
        (1024.0 * 1024.0);
    fields["stamp"] = format_stamp(frame.stamp_ns);
    fields["color"] = show("color.ppm", files.color);
    fields["depth"] = show("depth.pgm", files.depth);
    if (!files.labels.empty()) fields["labels"] = show("labels.pgm", files.labels);
    if (frame.odom_from_camera) fields["odometry"] = frame.odom_from_camera->numbers();
    for (const LaserScan& scan : frame.lasers)
      fields["lasers"].push_back({{"name", scan.name},
                                  {"camera_from_laser", scan.camera_from_laser.numbers()},
                                  {"first_rad", scan.first_rad},
                                  {"step_rad", scan.step_rad},
                                  {"limits_m", {scan.min_range_m, scan.max_range_m}},
                                  {"ranges_m", scan.ranges_m}});
    for (const ImuReading& reading : frame.imu) {
      const auto& w = reading.turn_rad_per_s;
      const auto& a = reading.specific_force_m_per_s2;
      fields["imu"].push_back(
          {format_stamp(reading.stamp_ns), w.x(), w.y(), w.z(), a.x(), a.y(), a.z()});
    }
    fields["seed"] = told_seed(stream);
    const Json reply = ask(
        what, fields,
        {"pose", "map", "keypoints", "inliers", "keyframe", "map_reset", "stage", "candidates"});
    SystemReport report;
    report.world_from_camera = pose(reply);
    report.map = static_cast<std::uint32_t>(count(reply, "map").value_or(0));
    report.keypoints = count(reply, "keypoints");
    report.inliers = count(reply, "inliers");
    report.keyframe_added = flag(reply, "keyframe");
    report.map_reset = flag(reply, "map_reset");
    report.relocalization = stage(reply);
    report.candidates = candidates(reply);
    return report;
  }

  void finish() { child_.finish(kFarewell_s); }

  int count_of(const Json& value, const char* key) {
    if (!value.is_number_integer() || value < 0 || value > 1'000'000'000)
      fail(fmt::format("gave {} of {}: expected a count", key, shortened(value.dump())));
    return value.get<int>();
  }

  [[noreturn]] void fail(const std::string& what) {
    child_.fail(fmt::format("{}, replying to {}", what, doing_));
  }

 private:
  fs::path settings() const { return scratch_.path() / "settings.yaml"; }
  /// Writes an image for the program. @returns its path
  std::string show(const char* name, const std::string& image) {
    try {
      if (const std::string why = scratch_.write(name, image); !why.empty()) fail(why);
    } catch (const DiskFullError&) {
      constexpr double kMuch_mb = 1;
      if (const double mb = child_.written_mb() - images_mb_; mb > kMuch_mb)
        fail(fmt::format("left no room for its images: it wrote {:.0f} MB beside them", mb));
      throw;
    }
    return (scratch_.path() / name).string();
  }
  std::string command(const OutsideProgram& program, const Camera& camera, std::uint64_t seed) {
    write_atomically(settings(), settings_text(camera));
    if (program.is_library()) return host_command(program, seed);
    return expand_command(program.command,
                          {{"settings", settings().string()}, {"seed", std::to_string(seed)}});
  }

  Json parse(const std::string& line) {
    if (is_nested_too_deep(line))
      fail(fmt::format("nested its reply more than {} levels deep: '{}'", kDeepestJson,
                       shortened(line)));
    if (line.find('\0') != std::string::npos)  // a parser would take it for the end
      fail(fmt::format("wrote something that is not a line of JSON: '{}'", shortened(line)));
    Json reply;
    std::vector<std::set<std::string>> keys;  // of the open objects, innermost last
    std::string doubled;
    const auto note_keys = [&](int, Json::parse_event_t event, const Json& parsed) {
      if (event == Json::parse_event_t::object_start) keys.emplace_back();
      if (event == Json::parse_event_t::object_end) keys.pop_back();
      if (event == Json::parse_event_t::key && !keys.back().insert(parsed).second) doubled = parsed;
      return true;
    };
    try {
      reply = Json::parse(line, note_keys);
    } catch (const Json::out_of_range&) {
      fail(fmt::format("wrote a number that is too large: '{}'", shortened(line)));
    } catch (const Json::exception&) {
      const std::string small = lower_case(line);
      const bool nan = small.starts_with("{") && (small.find("nan") != std::string::npos ||
                                                  small.find("inf") != std::string::npos);
      fail(fmt::format("wrote {}: '{}'",
                       nan ? "a number that is not finite" : "something that is not a line of JSON",
                       shortened(line)));
    }
    if (!reply.is_object()) fail(fmt::format("wrote no JSON object: '{}'", shortened(line)));
    if (!doubled.empty())
      fail(fmt::format("gave the key '{}' twice in '{}'", shortened(doubled), shortened(line)));
    return reply;
  }

  std::optional<SE3> pose(const Json& reply) {
    const auto it = reply.find("pose");
    if (it == reply.end()) fail("gave neither a pose nor \"pose\": null");
    if (it->is_null()) return std::nullopt;
    std::array<double, 7> v{};
    if (!it->is_array() || it->size() != v.size())
      fail(fmt::format("gave a pose of {}: expected [x, y, z, qx, qy, qz, qw]",
                       shortened(it->dump())));
    for (std::size_t k = 0; k < v.size(); ++k) {
      if (!(*it)[k].is_number())
        fail(
            fmt::format("gave a pose that does not consist of numbers: {}", shortened(it->dump())));
      v[k] = (*it)[k];
    }
    return told_pose(v, [this](const std::string& what) { fail(what); });
  }

  bool flag(const Json& reply, const char* key) {
    const auto it = reply.find(key);
    if (it == reply.end()) return false;
    if (!it->is_boolean()) fail(fmt::format("gave a {} of {}", key, shortened(it->dump())));
    return *it;
  }

  std::optional<int> count(const Json& from, const char* key) {
    const auto it = from.find(key);
    return it == from.end() ? std::nullopt : std::optional(count_of(*it, key));
  }

  std::optional<RelocalizationStage> stage(const Json& reply) {
    const auto it = reply.find("stage");
    if (it == reply.end()) return std::nullopt;
    const auto reported = it->is_string()
                              ? value_of(it->get<std::string>(), words(RelocalizationStage{}))
                              : std::nullopt;
    if (!reported) fail(fmt::format("gave an unknown stage {}", shortened(it->dump())));
    return reported;
  }

  Candidates candidates(const Json& reply) {
    const auto it = reply.find("candidates");
    if (it == reply.end() || it->is_null()) return {};
    if (!it->is_object()) fail(fmt::format("gave candidates of {}", shortened(it->dump())));
    for (const auto& [key, value] : it->items())
      if (!std::set<std::string>{"keyframes", "c1", "c2", "c3", "final"}.contains(key))
        fail(fmt::format("gave an unknown key 'candidates.{}'", shortened(key)));
    return {.keyframes = count(*it, "keyframes"),
            .c1 = count(*it, "c1"),
            .c2 = count(*it, "c2"),
            .c3 = count(*it, "c3"),
            .final = count(*it, "final"),
            .label_mass = {},
            .gamma = {}};
  }

  const ScratchFolder scratch_;
  const double reply_limit_s_;
  std::mutex mutex_;
  std::uint64_t number_ = 0;
  double images_mb_ = 0;  ///< of one frame
  std::string doing_ = "hello";
  ChildProcess child_;
};

class ConversationSystem : public OutsideSystem {
 public:
  ConversationSystem(const OutsideProgram& program, const Camera& camera, std::uint64_t seed,
                     const fs::path& log)
      : talk_(std::make_unique<Conversation>(program, camera, seed, log)) {}

  void rewind() override { talk_->ask("rewind", Request::object(), {}); }
  void finish() override { talk_->finish(); }

 private:
  SystemReport ask(Question what, std::uint64_t session, const RgbdFrame& frame,
                   RandomStream stream) const override {
    if (what == Question::kTrack)
      return talk_->ask_about("track", frame, stream, Request::object());
    return talk_->ask_about(what == Question::kBlank ? "blank" : "relocalize", frame, stream,
                            {{"session", session}});
  }
  void forget() override { talk_->ask("reset", Request::object(), {}); }
  std::optional<Trajectory> end_mapping() override {
    const Json reply = talk_->ask("freeze", Request::object(), {"trajectory", "maps"});
    const auto it = reply.find("trajectory");
    if (it == reply.end()) return std::nullopt;
    Trajectory trajectory = trajectory_of(*it);
    if (const auto maps = reply.find("maps"); maps != reply.end()) {
      if (!maps->is_array() || maps->size() != trajectory.size())
        fail(fmt::format("gave maps that are not {}, one for each line of its trajectory",
                         counted(trajectory.size(), "number")));
      for (std::size_t i = 0; i < trajectory.size(); ++i)
        trajectory[i].map = static_cast<std::uint32_t>(talk_->count_of((*maps)[i], "maps"));
    }
    return trajectory;
  }
  [[noreturn]] void fail(const std::string& what) const override { talk_->fail(what); }

  Trajectory trajectory_of(const Json& lines) const {
    std::string text;
    if (!lines.is_array()) fail("gave a trajectory that is not a list of lines");
    for (const Json& line : lines) {
      if (!line.is_string()) fail("gave a trajectory that is not a list of lines");
      text += line.get<std::string>() + "\n";
    }
    if (lines.empty()) return {};
    try {
      return parse_trajectory(text, "trajectory");
    } catch (const InputError& error) {
      fail(fmt::format("gave a bad trajectory: {}", error.what()));
    }
  }

  std::unique_ptr<Conversation> talk_;
};

}  // namespace

std::unique_ptr<System> make_conversation_system(const OutsideProgram& program,
                                                 const Camera& camera, std::uint64_t seed,
                                                 const fs::path& log) {
  validate(program);
  return std::make_unique<ConversationSystem>(program, camera, seed, log);
}

}  // namespace mh
