// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/conversation.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/protocol/query.hpp"
#include "bench/systems/child_process.hpp"
#include "bench/systems/outside_error.hpp"
#include "scenes/recorded/frame_files.hpp"
#include "slam/core/files.hpp"
#include "slam/core/trajectory_io.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kProtocol = 1;
constexpr double kFarewell_s = 5;  // docs/outside_systems.md

/// A folder of its own in memory where there is such a place, removed in the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code error;
    const fs::path memory = "/dev/shm";
    const bool there = fs::is_directory(memory, error) && access(memory.c_str(), W_OK) == 0;
    std::string name =
        ((there ? memory : fs::temp_directory_path()) / "modelhouse-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw MachineError(fmt::format("{}: no temporary folder can be made", name));
    path = name;
  }
  ~ScratchFolder() {
    std::error_code error;
    fs::remove_all(path, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  fs::path path;
};

std::string shortened(std::string_view line) {
  constexpr std::size_t kMost = 120;
  std::string text(line.substr(0, kMost));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  return line.size() > kMost ? text + "..." : text;
}

/// The exchange of lines: numbers requests, checks answers.
class Conversation {
 public:
  Conversation(const OutsideProgram& program, const Camera& camera, std::uint64_t seed,
               const fs::path& log)
      : answer_limit_s_(program.answer_limit_s),
        child_(program, command(program, camera, seed), ChildProcess::Talk::kOverPipes, log,
               scratch_.path) {
    const Distortion& d = camera.distortion;
    Json classes_by_id = Json::array();
    for (const ClassInfo& info : classes()) classes_by_id.push_back(info.name);
    const Json answer = ask("hello",
                            {{"protocol", kProtocol},
                             {"camera",
                              {{"width", camera.width_px},
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
                               {"bf", camera.baseline_m * camera.fx_px}}},
                             {"depth_per_meter", kDepthPerMeter},
                             {"settings", settings().string()},
                             {"classes", classes_by_id}},
                            {"protocol", "name"});
    if (const auto it = answer.find("protocol"); it == answer.end() || *it != kProtocol)
      fail(fmt::format("does not speak protocol {}", kProtocol));
  }

  /// Sends a request and returns its answer, which has this request's number and no other keys
  /// than `known`.
  Json ask(const std::string& what, const Json& fields, const std::set<std::string>& known) {
    const std::lock_guard lock(mutex_);
    doing_ = fmt::format("{} (request {})", what, ++number_);
    Json request = {{"id", number_}, {"do", what}};
    request.update(fields);
    child_.send(request.dump(), doing_);
    const std::string line = child_.read_line(answer_limit_s_, doing_);
    Json answer = parse(line);
    if (const auto it = answer.find("error"); it != answer.end())
      fail(fmt::format("reported an error: {}", shortened(it->dump())));
    const auto id = answer.find("id");
    if (id == answer.end() || !id->is_number_integer())
      fail(fmt::format("gave no request number (\"id\") in '{}'", shortened(line)));
    if (*id != number_) fail(fmt::format("answered request {}, which was not asked", id->dump()));
    for (const auto& [key, value] : answer.items())
      if (key != "id" && !known.contains(key))
        fail(fmt::format("gave an unknown key '{}'", shortened(key)));
    return answer;
  }

  /// Asks about a frame: what every answer to one may hold, as a report. A pose makes it
  /// `with_pose`, no pose kLost.
  SystemReport ask_about(const std::string& what, const RgbdFrame& frame, RandomStream stream,
                         TrackStatus with_pose, Json fields = Json::object()) {
    const FrameFiles files = show(frame, scratch_.path);
    fields["stamp"] = format_stamp(frame.stamp_ns);
    fields["color"] = files.color.string();
    fields["depth"] = files.depth.string();
    if (!files.labels.empty()) fields["labels"] = files.labels.string();
    fields["seed"] = stream.bits(0) >> 33;  // fits an int everywhere
    const Json answer =
        ask(what, fields,
            {"pose", "keypoints", "inliers", "keyframe", "map_reset", "stage", "candidates"});
    SystemReport report;
    report.world_from_camera = pose(answer);
    report.status = report.world_from_camera ? with_pose : TrackStatus::kLost;
    report.keypoints = count(answer, "keypoints");
    report.inliers = count(answer, "inliers");
    report.keyframe_added = flag(answer, "keyframe");
    report.map_reset = flag(answer, "map_reset");
    if (report.map_reset && what != "track") fail("gave up a map that must not change any more");
    report.relocalization = stage(answer);
    report.candidates = candidates(answer);
    return report;
  }

  void finish() { child_.finish(kFarewell_s); }

  [[noreturn]] void fail(const std::string& what) {
    child_.fail(fmt::format("{}, answering {}", what, doing_));
  }

 private:
  fs::path settings() const { return scratch_.path / "settings.yaml"; }
  std::string command(const OutsideProgram& program, const Camera& camera, std::uint64_t seed) {
    write_atomically(settings(), settings_text(camera));
    return expand_command(program.command,
                          {{"settings", settings().string()}, {"seed", std::to_string(seed)}});
  }

  Json parse(const std::string& line) {
    Json answer;
    std::vector<std::set<std::string>> keys;  // of the objects that are open, innermost last
    std::string doubled;
    const auto note_keys = [&](int, Json::parse_event_t event, const Json& parsed) {
      if (event == Json::parse_event_t::object_start) keys.emplace_back();
      if (event == Json::parse_event_t::object_end) keys.pop_back();
      if (event == Json::parse_event_t::key && !keys.back().insert(parsed).second) doubled = parsed;
      return true;
    };
    try {
      answer = Json::parse(line, note_keys);
    } catch (const Json::out_of_range&) {
      fail(fmt::format("wrote a number that is too large: '{}'", shortened(line)));
    } catch (const Json::exception&) {
      std::string small = line;
      std::transform(small.begin(), small.end(), small.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      const bool nan = small.starts_with("{") && (small.find("nan") != std::string::npos ||
                                                  small.find("inf") != std::string::npos);
      fail(fmt::format("wrote {}: '{}'",
                       nan ? "a number that is not finite" : "what is no line of JSON",
                       shortened(line)));
    }
    if (!answer.is_object()) fail(fmt::format("wrote no JSON object: '{}'", shortened(line)));
    if (!doubled.empty())
      fail(fmt::format("gave the key '{}' twice in '{}'", shortened(doubled), shortened(line)));
    return answer;
  }

  std::optional<SE3> pose(const Json& answer) {
    const auto it = answer.find("pose");
    if (it == answer.end()) fail("gave neither a pose nor \"pose\": null");
    if (it->is_null()) return std::nullopt;
    double v[7];
    if (!it->is_array() || it->size() != 7)
      fail(fmt::format("gave a pose of {}: expected [x, y, z, qx, qy, qz, qw]",
                       shortened(it->dump())));
    for (std::size_t k = 0; k < 7; ++k) {
      if (!(*it)[k].is_number())
        fail(fmt::format("gave a pose that is not of numbers: {}", shortened(it->dump())));
      v[k] = (*it)[k];
      if (k < 3 && !(std::abs(v[k]) <= kFarthest_m))
        fail(fmt::format("gave a pose more than {:g} m away: {}", kFarthest_m,
                         shortened(it->dump())));
    }
    const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
    if (std::abs(rotation.norm() - 1.0) > 0.1)
      fail(fmt::format("gave a pose whose quaternion has norm {:g}", rotation.norm()));
    return SE3(rotation, Eigen::Vector3d(v[0], v[1], v[2]));
  }

  bool flag(const Json& answer, const char* key) {
    const auto it = answer.find(key);
    if (it == answer.end()) return false;
    if (!it->is_boolean()) fail(fmt::format("gave a {} of {}", key, shortened(it->dump())));
    return *it;
  }

  std::optional<int> count(const Json& from, const char* key) {
    const auto it = from.find(key);
    if (it == from.end()) return std::nullopt;
    if (!it->is_number_integer() || *it < 0 || *it > 1'000'000'000)
      fail(fmt::format("gave {} of {}: expected a count", key, shortened(it->dump())));
    return it->get<int>();
  }

  std::optional<RelocalizationStage> stage(const Json& answer) {
    const auto it = answer.find("stage");
    if (it == answer.end()) return std::nullopt;
    const auto told = it->is_string()
                          ? value_of(it->get<std::string>(), words(RelocalizationStage{}))
                          : std::nullopt;
    if (!told) fail(fmt::format("gave an unknown stage {}", shortened(it->dump())));
    if (!answer["pose"].is_null() && told != RelocalizationStage::kNone &&
        told != RelocalizationStage::kVerified)
      fail(fmt::format("gave a pose and the stage \"{}\", which is one of failure", name(*told)));
    return told;
  }

  Candidates candidates(const Json& answer) {
    const auto it = answer.find("candidates");
    if (it == answer.end() || it->is_null()) return {};
    if (!it->is_object()) fail(fmt::format("gave candidates of {}", shortened(it->dump())));
    for (const auto& [key, value] : it->items())
      if (!std::set<std::string>{"keyframes", "c1", "c2", "c3", "final"}.contains(key))
        fail(fmt::format("gave an unknown key 'candidates.{}'", shortened(key)));
    const Candidates told{.keyframes = count(*it, "keyframes"),
                          .c1 = count(*it, "c1"),
                          .c2 = count(*it, "c2"),
                          .c3 = count(*it, "c3"),
                          .final = count(*it, "final"),
                          .label_mass = {}};
    std::optional<int> left;
    for (const std::optional<int>& number :
         {told.keyframes, told.c1, told.c2, told.c3, told.final}) {
      if (!number) continue;
      if (left && *number > *left)
        fail(fmt::format("gave candidates of {}: a step cannot leave more than the one before it",
                         shortened(it->dump())));
      left = number;
    }
    return told;
  }

  const ScratchFolder scratch_;
  const double answer_limit_s_;
  std::mutex mutex_;
  std::uint64_t number_ = 0;
  std::string doing_ = "hello";
  ChildProcess child_;
};

class ConversationSystem : public System {
 public:
  ConversationSystem(const OutsideProgram& program, const Camera& camera, std::uint64_t seed,
                     const fs::path& log)
      : talk_(std::make_unique<Conversation>(program, camera, seed, log)) {}

  SystemReport track(const RgbdFrame& frame, RandomStream stream) override {
    assert(!frozen_);
    shown_.insert(frame.stamp_ns);
    const SystemReport report = talk_->ask_about("track", frame, stream, TrackStatus::kTracked);
    if (report.map_reset) poses_.clear();
    if (report.world_from_camera)
      poses_[frame.stamp_ns] = *report.world_from_camera;
    else
      poses_.erase(frame.stamp_ns);  // the last attempt counts
    return report;
  }
  void rewind() override { talk_->ask("rewind", Json::object(), {}); }
  void reset() override {
    talk_->ask("reset", Json::object(), {});
    poses_.clear();
    shown_.clear();
  }
  void freeze() override {
    const Json answer = talk_->ask("freeze", Json::object(), {"trajectory"});
    frozen_ = true;
    if (const auto it = answer.find("trajectory"); it != answer.end()) take_trajectory(*it);
  }
  void finish() override { talk_->finish(); }
  Trajectory trajectory() const override {
    Trajectory trajectory;
    for (const auto& [stamp_ns, pose] : poses_) trajectory.push_back({stamp_ns, pose});
    return trajectory;
  }
  std::unique_ptr<RelocalizationSession> open_session() const override;

  SystemReport relocalize(std::uint64_t session, const RgbdFrame& frame,
                          RandomStream stream) const {
    assert(session == sessions_);  // an older one would have to be remembered by the program
    return talk_->ask_about(is_blank(frame) ? "blank" : "relocalize", frame, stream,
                            TrackStatus::kRelocalized, {{"session", session}});
  }

 private:
  /// Replaces the poses given so far by those of the finished map.
  void take_trajectory(const Json& lines) {
    std::string text;
    if (!lines.is_array()) talk_->fail("gave a trajectory that is no list of lines");
    for (const Json& line : lines) {
      if (!line.is_string()) talk_->fail("gave a trajectory that is no list of lines");
      text += line.get<std::string>() + "\n";
    }
    std::map<Stamp, SE3> poses;
    if (!lines.empty()) {
      Trajectory trajectory;
      try {
        trajectory = parse_tum(text, "trajectory");
      } catch (const InputError& error) {
        talk_->fail(fmt::format("gave a bad trajectory: {}", error.what()));
      }
      for (const TimedPose& pose : trajectory) {
        if (is_too_far(pose))
          talk_->fail(fmt::format("gave a pose more than {:g} m away in its trajectory, at {}",
                                  kFarthest_m, format_stamp(pose.stamp_ns)));
        if (!shown_.contains(pose.stamp_ns))
          talk_->fail(fmt::format("gave a pose at {} in its trajectory, a frame that it never saw",
                                  format_stamp(pose.stamp_ns)));
        poses[pose.stamp_ns] = pose.world_from_camera;
      }
    }
    poses_ = std::move(poses);
  }

  std::unique_ptr<Conversation> talk_;
  std::map<Stamp, SE3> poses_;
  std::set<Stamp> shown_;
  bool frozen_ = false;
  mutable std::uint64_t sessions_ = 0;
};

class ConversationSession : public RelocalizationSession {
 public:
  ConversationSession(const ConversationSystem& system, std::uint64_t number)
      : system_(system), number_(number) {}
  SystemReport feed(const RgbdFrame& frame, RandomStream stream) override {
    return system_.relocalize(number_, frame, stream);
  }

 private:
  const ConversationSystem& system_;  // outlives its sessions
  const std::uint64_t number_;
};

std::unique_ptr<RelocalizationSession> ConversationSystem::open_session() const {
  assert(frozen_);
  return std::make_unique<ConversationSession>(*this, ++sessions_);
}

}  // namespace

std::unique_ptr<System> make_conversation_system(const OutsideProgram& program,
                                                 const Camera& camera, std::uint64_t seed,
                                                 const fs::path& log) {
  validate(program);
  return std::make_unique<ConversationSystem>(program, camera, seed, log);
}

}  // namespace mh
