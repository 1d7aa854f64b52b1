// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/ros_output.hpp"
#include "bench/cli/scene_option.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/live/live_drive.hpp"
#include "bench/live/live_server.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/run/signal_watch.hpp"
#include "bench/suite/shipped.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "slam/io/files.hpp"

namespace mh::cli {
namespace {

struct LiveArguments {
  std::string scene, robot = "pepper", level = "pepper", vocabulary = "vocabulary", pedestrian;
  std::vector<std::string> other_scenes;
  LiveAddress address{.port = 8642};
  std::filesystem::path out;
  std::uint64_t seed = 0;
  bool fast = false;
};

constexpr const char* kScript = "driven.yaml";

/// What is driven, in a folder: messages as NAME.mcap, and the commands since the robot was last
/// put down, as a script.
class LiveRecording {
 public:
  LiveRecording(const std::filesystem::path& out, const std::vector<TopicSpec>& topics)
      : out_(out),
        folder_(out, "live", {ros_file("mcap", out).filename().string(), kScript}),
        file_(RosOption().open("mcap", out)) {
    for (const TopicSpec& topic : topics) topics_.push_back(file_->add_topic(topic));
  }
  void add(const std::vector<MessageLog::Entry>& messages) {
    for (const MessageLog::Entry& entry : messages)
      file_->write(topics_[entry.topic], entry.stamp_ns, entry.message);
  }
  void finish(const CommandScript& driven) {
    file_->finish();
    write_atomically(out_ / kScript, commands_text(driven));
    fmt::print("live: recorded in {}\n", out_.string());
  }

 private:
  std::filesystem::path out_;
  OutputFolder folder_;
  std::unique_ptr<MessageWriter> file_;
  std::vector<std::uint16_t> topics_;
};

std::string new_token() {
  std::random_device draw;
  return fmt::format("{:08x}{:08x}", draw(), draw());
}

void run(LiveArguments options) {
  resolve(options.scene, Shipped::kScene);
  resolve(options.robot, Shipped::kRobot);
  resolve(options.level, Shipped::kLevel);
  resolve(options.vocabulary, Shipped::kVocabulary);
  std::vector<std::string> warnings;
  const Robot robot = load_robot(options.robot, &warnings);
  const SensorConfig level = load_sensor_config(options.level);
  const auto vocabulary = std::make_shared<const Vocabulary>(Vocabulary::load(options.vocabulary));
  std::vector<std::string> files = {options.scene};
  for (std::string& other : options.other_scenes) {
    resolve(other, Shipped::kScene);
    files.push_back(other);
  }
  std::vector<SimulatedScene> scenes;
  for (const std::string& file : files) {
    SimulatedScene& scene = scenes.emplace_back(load_simulated_scene(
        file, usual_cache(), [](std::string_view line) { fmt::print(stderr, "live: {}\n", line); },
        &warnings));
    if (!options.pedestrian.empty())
      scene.pedestrian =
          make_pedestrian_scene(*scene.scene, scene.renderer, load_pedestrian(options.pedestrian));
  }
  print_warnings(warnings);
  LiveDrive drive(std::move(scenes), robot, level, vocabulary, options.seed);
  if (options.address.host != "127.0.0.1" && options.address.token.empty())
    options.address.token = new_token();

  LiveServer server(options.address,
                    {.page = data_folder() / "bench/live/page",
                     .greeting = [&] { return drive.greeting(); },
                     .take = [&](const std::string& command) { return drive.take(command); },
                     .topics = drive.topics()});
  fmt::print("live: {}\n", server.url());
  std::fflush(stdout);
  std::optional<LiveRecording> recording;
  if (!options.out.empty()) recording.emplace(options.out, drive.topics());

  const SignalWatch watch;
  using Clock = std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(LiveDrive::kStep_s));
  auto due = Clock::now();
  while (watch.signal() == 0) {
    LiveDrive::Shown shown =
        drive.step((server.viewers() > 0 ? LiveDrive::kPage : 0) |
                   (server.subscriptions() > 0 || recording ? LiveDrive::kMessages : 0));
    if (recording) recording->add(shown.messages);
    server.send_messages(std::move(shown.messages));
    if (!shown.state.empty()) {
      server.send_text(std::move(shown.state));
      server.send_images(shown.images);
    }
    // On a machine that is too slow, the robot drives in slow motion instead of in leaps.
    due = std::max(due + period, Clock::now() - period);
    if (!options.fast) std::this_thread::sleep_until(due);
  }
  if (recording) recording->finish(drive.driven());
}

}  // namespace

void add_live(CLI::App& app) {
  auto options = std::make_shared<LiveArguments>();
  CLI::App* command =
      app.add_subcommand("live", "Drives the robot from a browser while SLAM maps what it sees.");
  command
      ->add_option("scene", options->scene,
                   "Scene (YAML), mesh file, or the name of a shipped scene")
      ->required();
  command->add_option("--robot", options->robot, "Robot (YAML), or the name of a shipped one");
  command->add_option("--level", options->level,
                      "Sensor level (YAML), or the name of a shipped one");
  command->add_option("--pedestrian", options->pedestrian,
                      "Adds a pedestrian (YAML) who walks through the scene");
  command->add_option("--other-scene", options->other_scenes,
                      "Another state of the scene, such as furniture moved or evening, that the "
                      "page can switch to; may be repeated");
  command->add_option("--vocabulary", options->vocabulary,
                      "Vocabulary file, or the name of the shipped one");
  command->add_option("--port", options->address.port, "Port to listen on; 0: any free one")
      ->check(CLI::Range(0, 65535));
  command->add_option("--host", options->address.host,
                      "Address to listen on; any other than 127.0.0.1 requires a token");
  command->add_option("--token", options->address.token,
                      "Token required from every browser (default: random if one is required)");
  command->add_option("--out", options->out,
                      "Folder that receives what is driven: all messages as NAME.mcap, and the "
                      "commands since the last kidnapping as driven.yaml, for motion "
                      "commands:FILE");
  command->add_option("--seed", options->seed, "Seed of the start and of all noise")
      ->check(seed_number());
  command->add_flag("--fast", options->fast, "Runs as fast as the machine can, not in real time");
  command->footer("Example:\n  modelhouse live model_house");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
