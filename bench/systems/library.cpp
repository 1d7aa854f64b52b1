// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/library.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cfenv>
#include <clocale>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <locale>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/systems/child_process.hpp"
#include "bench/systems/outside_error.hpp"
#include "bench/systems/outside_system.hpp"
#include "include/modelhouse/system.h"
#include "scenes/recordings/frame_files.hpp"
#include "slam/core/labels.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/printable.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// An open file that receives what is printed.
class Log {
 public:
  explicit Log(const fs::path& file) : descriptor_(new_log(file)) {
    if (descriptor_ < 0)
      throw MachineError(fmt::format("{}: {}", file.string(), std::strerror(errno)));
  }
  ~Log() { close(descriptor_); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Scope of a call into the library. What the library prints goes to the log: our own output is
/// read by the bench. What belongs to the whole process is restored afterward: the floating-point
/// mode (code built with -ffast-math changes it when loaded, and frames would come out with
/// different bits), the locale, the working directory and the mask of new files' modes.
class Visit {
 public:
  explicit Visit(const Log& log) {
    flush();
    folder_ = open(".", O_PATH | O_CLOEXEC);
    std::fegetenv(&floating_point_);
    mode_mask_ = umask(0);
    umask(mode_mask_);
    for (std::size_t k = 0; k < kOurs.size(); ++k) {
      ours_[k] = fcntl(kOurs[k], F_DUPFD_CLOEXEC, 0);
      dup2(log.descriptor(), kOurs[k]);
    }
  }
  ~Visit() {
    flush();
    std::fesetenv(&floating_point_);
    umask(mode_mask_);
    if (std::locale() != locale_) std::locale::global(locale_);
    if (const char* now = std::setlocale(LC_ALL, nullptr); now == nullptr || now != c_locale_)
      std::setlocale(LC_ALL, c_locale_.c_str());
    // Relative paths must lead where they led before.
    if (fchdir(folder_) != 0) std::abort();
    close(folder_);
    for (std::size_t k = 0; k < kOurs.size(); ++k) {
      dup2(ours_[k], kOurs[k]);
      close(ours_[k]);
    }
  }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

 private:
  static constexpr std::array kOurs = {STDOUT_FILENO, STDERR_FILENO};
  static void flush() {
    std::fflush(stdout);
    std::cout.flush();
  }
  std::array<int, kOurs.size()> ours_{};
  std::fenv_t floating_point_{};
  mode_t mode_mask_ = 0;
  const std::locale locale_;
  const std::string c_locale_ = std::setlocale(LC_ALL, nullptr);
  int folder_ = -1;
};

/// The mh_setup that the library is created from, with everything that it points to.
class Setup {
 public:
  Setup(const OutsideProgram& program, const Camera& camera, std::uint64_t seed) {
    if (!program.settings.empty())
      settings_ = fs::absolute(program.folder / program.settings).lexically_normal().string();
    for (const ClassInfo& info : mh::classes()) classes_.emplace_back(info.name);
    for (const std::string& one : classes_) class_names_.push_back(one.c_str());
    const Distortion& d = camera.distortion;
    reported_ = {.version = MH_SYSTEM_VERSION,
                 .camera = {.width_px = camera.width_px,
                            .height_px = camera.height_px,
                            .fx_px = camera.fx_px,
                            .fy_px = camera.fy_px,
                            .cx_px = camera.cx_px,
                            .cy_px = camera.cy_px,
                            .k1 = d.k1,
                            .k2 = d.k2,
                            .p1 = d.p1,
                            .p2 = d.p2,
                            .k3 = d.k3,
                            .rate_hz = camera.rate_hz,
                            .baseline_m = camera.baseline_m,
                            .depth_per_meter = kDepthPerMeter},
                 .seed = seed,
                 .settings = settings_.empty() ? nullptr : settings_.c_str(),
                 .class_count = static_cast<std::int32_t>(class_names_.size()),
                 .classes = class_names_.data(),
                 .message = message_.data(),
                 .k4 = d.k4,
                 .k5 = d.k5,
                 .k6 = d.k6};
  }
  Setup(const Setup&) = delete;
  Setup& operator=(const Setup&) = delete;

  const mh_setup* reported() const { return &reported_; }
  void clear_message() { message_.fill('\0'); }
  /// Returns ": what the library wrote", or an empty string.
  std::string message() const {
    const std::string text(message_.data(), strnlen(message_.data(), message_.size()));
    return text.empty() ? text : ": " + printable(text);
  }

 private:
  std::string settings_;
  std::vector<std::string> classes_;
  std::vector<const char*> class_names_;
  std::array<char, MH_MESSAGE_SIZE> message_{};
  mh_setup reported_{};
};

class LibrarySystem : public OutsideSystem {
 public:
  LibrarySystem(const OutsideProgram& program, const Camera& camera, std::uint64_t seed,
                const fs::path& log, std::function<void(std::string_view)> on_call)
      : program_(program), log_(log), setup_(program, camera, seed), on_call_(std::move(on_call)) {
    const fs::path file = fs::absolute(program.folder / program.library);
    if (const char* reason = why_unreadable(file); reason != nullptr)
      fail(fmt::format("cannot be loaded: {}", reason));
    void* loaded = nullptr;
    visit("loading", [&] { loaded = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL); });
    if (loaded == nullptr) {
      std::string reason = dlerror();  // starts with the file's path, which differs by machine
      if (reason.starts_with(file.string() + ": ")) reason.erase(0, file.string().size() + 2);
      fail(fmt::format("cannot be loaded: {}", printable(reason)));
    }
    constexpr const char* kMake = "mh_make_system";
    const auto make = reinterpret_cast<decltype(&mh_make_system)>(dlsym(loaded, kMake));
    if (make == nullptr) fail(fmt::format("has no function {}: is it extern \"C\"?", kMake));
    visit(kMake, [&] { system_ = make(setup_.reported()); });
    if (system_ == nullptr) fail(fmt::format("made no system{}", setup_.message()));
    if (system_->version != MH_SYSTEM_VERSION)
      fail(fmt::format("was built with version {} of modelhouse/system.h, the bench has version {}",
                       system_->version, MH_SYSTEM_VERSION));
    for (const auto& [name, there] : {std::pair("track", system_->track != nullptr),
                                      {"rewind", system_->rewind != nullptr},
                                      {"reset", system_->reset != nullptr},
                                      {"freeze", system_->freeze != nullptr},
                                      {"relocalize", system_->relocalize != nullptr},
                                      {"destroy", system_->destroy != nullptr}})
      if (!there) fail(fmt::format("left the function {} empty", name));
  }
  ~LibrarySystem() override {
    try {
      finish();
    } catch (const OutsideError&) {
      // The run has failed for another reason, or is over.
    }
  }

  void rewind() override {
    call("rewind", [&] { return system_->rewind(system_->self); });
  }
  void finish() override {
    if (system_ == nullptr) return;
    mh_system* ending = std::exchange(system_, nullptr);
    visit("destroy", [&] { ending->destroy(ending->self); });
  }

 private:
  SystemReport ask(Question what, std::uint64_t, const RgbdFrame& frame,
                   RandomStream stream) const override {
    std::vector<std::uint16_t> depth(frame.depth_m.size());
    std::transform(frame.depth_m.begin(), frame.depth_m.end(), depth.begin(), depth_units);
    const Grid2d<ClassId> labels = class_image(frame.semantics);
    static_assert(sizeof(Rgb8) == 3 && sizeof(ClassId) == 1);
    const mh_frame shown = {.stamp_ns = frame.stamp_ns,
                            .width_px = frame.color.width(),
                            .height_px = frame.color.height(),
                            .color = reinterpret_cast<const std::uint8_t*>(frame.color.data()),
                            .depth = depth.data(),
                            .labels = labels.empty() ? nullptr : labels.data(),
                            .seed = told_seed(stream)};
    mh_reply reply{};
    for (std::int32_t* unknown : {&reply.keypoints, &reply.inliers, &reply.keyframes, &reply.c1,
                                  &reply.c2, &reply.c3, &reply.final})
      *unknown = MH_UNKNOWN;
    const auto [doing, function] = what == Question::kTrack ? std::pair("track", system_->track)
                                   : what == Question::kBlank
                                       ? std::pair("blank", system_->blank)
                                       : std::pair("relocalize", system_->relocalize);
    if (function != nullptr) call(doing, [&] { return function(system_->self, &shown, &reply); });
    return report_of(reply);
  }

  SystemReport report_of(const mh_reply& reply) const {
    SystemReport report;
    if (reply.has_pose != 0) report.world_from_camera = pose_of(reply.pose);
    const auto count = [&](const char* what, std::int32_t reported) -> std::optional<int> {
      if (reported == MH_UNKNOWN) return std::nullopt;
      if (reported < 0) fail(fmt::format("gave {} of {}: expected a count", what, reported));
      return reported;
    };
    report.keypoints = count("keypoints", reply.keypoints);
    report.inliers = count("inliers", reply.inliers);
    report.keyframe_added = reply.keyframe_added != 0;
    report.map_reset = reply.map_reset != 0;
    static_assert(static_cast<int>(RelocalizationStage::kVerified) == MH_STAGE_VERIFIED);
    if (reply.stage < MH_STAGE_UNKNOWN || reply.stage > MH_STAGE_VERIFIED)
      fail(fmt::format("gave an unknown stage {}", reply.stage));
    if (reply.stage != MH_STAGE_UNKNOWN)
      report.relocalization = static_cast<RelocalizationStage>(reply.stage);
    report.candidates = {.keyframes = count("keyframes", reply.keyframes),
                         .c1 = count("c1", reply.c1),
                         .c2 = count("c2", reply.c2),
                         .c3 = count("c3", reply.c3),
                         .final = count("final", reply.final),
                         .label_mass = {},
                         .gamma = {}};
    return report;
  }

  SE3 pose_of(const mh_pose& pose) const {
    return told_pose(std::to_array(pose.values), [this](const std::string& what) { fail(what); });
  }

  void forget() override {
    call("reset", [&] { return system_->reset(system_->self); });
  }
  std::optional<Trajectory> end_mapping() override {
    call("freeze", [&] { return system_->freeze(system_->self); });
    if (system_->trajectory == nullptr) return std::nullopt;
    std::vector<std::pair<Stamp, mh_pose>> reported;
    const mh_add_pose add = [](void* to, std::int64_t stamp_ns, const mh_pose* pose) {
      static_cast<decltype(reported)*>(to)->emplace_back(stamp_ns, *pose);
    };
    call("trajectory", [&] { return system_->trajectory(system_->self, add, &reported); });
    Trajectory trajectory;
    for (const auto& [stamp_ns, pose] : reported) trajectory.push_back({stamp_ns, pose_of(pose)});
    return trajectory;
  }
  void begin_session(std::uint64_t) const override {
    if (system_->begin_query != nullptr)
      call("begin_query", [&] { return system_->begin_query(system_->self); });
  }

  /// Runs a function of the library.
  template <class Function>
  void visit(std::string_view doing, const Function& function) const {
    doing_ = doing;
    setup_.clear_message();
    if (on_call_) on_call_(fmt::format("{} (call {})", doing, ++calls_));
    std::string escaped;
    {
      const Visit here(log_);
      try {
        function();
        return;
      } catch (const std::exception& exception) {
        escaped = fmt::format("let an exception escape: {}", printable(exception.what()));
      } catch (...) {
        escaped = "let an exception escape";
      }
    }
    fail(escaped);
  }
  /// The same for a function that returns a status.
  template <class Function>
  void call(std::string_view doing, const Function& function) const {
    int status = 0;
    visit(doing, [&] { status = function(); });
    if (status != 0) fail(fmt::format("reported an error ({}){}", status, setup_.message()));
  }

  [[noreturn]] void fail(const std::string& what) const override {
    system_ = nullptr;  // its state is unknown
    throw OutsideError(fmt::format("outside library '{}' ({}) {}, in {}", program_.name,
                                   program_.library, what, doing_));
  }

  const OutsideProgram program_;
  const Log log_;
  mutable Setup setup_;
  const std::function<void(std::string_view)> on_call_;
  mutable std::size_t calls_ = 0;
  mutable mh_system* system_ = nullptr;  ///< null after it failed or ended
  mutable std::string doing_ = "loading";
};

}  // namespace

std::unique_ptr<System> make_library_system(const OutsideProgram& program, const Camera& camera,
                                            std::uint64_t seed, const fs::path& log,
                                            std::function<void(std::string_view)> on_call) {
  validate(program);
  return std::make_unique<LibrarySystem>(program, camera, seed, log, std::move(on_call));
}

}  // namespace mh
