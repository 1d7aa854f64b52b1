// SPDX-License-Identifier: Apache-2.0
// The drive behind `modelhouse live`, and the server that shows it.
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "bench/live/foxglove.hpp"
#include "bench/live/live_drive.hpp"
#include "bench/live/live_server.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/suite/cache.hpp"
#include "scenes/floor.hpp"
#include "scenes/load.hpp"
#include "scenes/recordings/ros/names.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using Json = nlohmann::json;
using testing::HasSubstr;

std::unique_ptr<LiveDrive> made_drive() {
  static const std::vector<SimulatedScene> scenes = {
      load_simulated_scene(MH_SOURCE_DIR "/bench/scenarios/room.yaml", Cache(MH_TEST_CACHE)),
      load_simulated_scene(MH_SOURCE_DIR "/bench/scenarios/room_moved.yaml", Cache(MH_TEST_CACHE))};
  static const auto vocabulary = std::make_shared<const Vocabulary>(
      Vocabulary::load(MH_SOURCE_DIR "/assets/vocabulary.mhvoc"));
  return std::make_unique<LiveDrive>(
      scenes, load_robot(MH_SOURCE_DIR "/robots/pepper/pepper.yaml"),
      load_sensor_config(MH_SOURCE_DIR "/sim/sensors/levels/ideal.yaml"), vocabulary, 3);
}

/// Repeats a command for some steps. @returns the last state
Json held(LiveDrive& drive, const std::string& command, int steps) {
  Json state;
  for (int i = 0; i < steps; ++i) {
    if (!command.empty()) {
      EXPECT_EQ(drive.take(command), "");
    }
    state = Json::parse(drive.step().state);
  }
  return state;
}

TEST(LiveDrive, GreetsWithThePlan) {
  const Json hello = Json::parse(made_drive()->greeting()).at("hello");
  EXPECT_EQ(hello.at("robot"), "pepper");
  ASSERT_EQ(hello.at("rooms").size(), 1U);
  EXPECT_GE(hello.at("rooms")[0].at("outline").size(), 4U);
  EXPECT_GT(hello.at("things").size(), 3U);
  EXPECT_EQ(hello.at("classes")[5][0], "chair");
}

TEST(LiveDrive, MapsWhileItIsDrivenAndStopsWithoutADriver) {
  const auto drive = made_drive();
  const Json first = held(*drive, "", 1);
  EXPECT_EQ(first.at("status"), "initialized");
  const Json turned = held(*drive, R"({"drive": [0, 0, 0.8]})", 30);
  EXPECT_EQ(turned.at("status"), "tracked");
  EXPECT_LT(turned.at("error_m"), 0.05);
  EXPECT_GT(turned.at("keyframes"), 2);
  EXPECT_NE(turned.at("base")[2], first.at("base")[2]);
  const double stopped_rad = held(*drive, "", 25).at("base")[2];
  EXPECT_NEAR(held(*drive, "", 15).at("base")[2].get<double>(), stopped_rad, 0.02);
}

TEST(LiveDrive, AKidnappedRobotIsLostAndFindsItself) {
  const auto drive = made_drive();
  held(*drive, R"({"drive": [0, 0, 0.8]})", 140);  // a full turn
  EXPECT_EQ(drive->take(R"({"do": "kidnap"})"), "");
  const Json dark = held(*drive, "", 3);
  EXPECT_EQ(dark.at("light"), false);
  EXPECT_EQ(dark.at("status"), "lost");
  Json found;
  for (int i = 0; i < 160 && (found.is_null() || found.at("status") != "relocalized"); ++i)
    found = held(*drive, R"({"drive": [0, 0, 0.5]})", 1);
  EXPECT_EQ(found.at("status"), "relocalized");
  EXPECT_LT(found.at("error_m"), 0.1);
}

TEST(LiveDrive, ObeysTheSwitches) {
  const auto drive = made_drive();
  EXPECT_EQ(drive->take(R"({"gamma": 2.5})"), "");
  EXPECT_EQ(drive->take(R"({"xi": 1.25})"), "");
  EXPECT_EQ(drive->take(R"({"wheels": false})"), "");
  EXPECT_EQ(drive->take(R"({"light": false})"), "");
  const Json dark = held(*drive, "", 1);
  EXPECT_EQ(dark.at("gamma"), 2.5);
  EXPECT_EQ(dark.at("xi"), 1.25);
  EXPECT_EQ(dark.at("wheels"), false);
  EXPECT_EQ(dark.at("light"), false);
  EXPECT_EQ(dark.at("keypoints"), 0);
  EXPECT_EQ(drive->take(R"({"light": true})"), "");
  EXPECT_EQ(held(*drive, "", 2).at("status"), "tracked");
  EXPECT_EQ(drive->take(R"({"do": "restart"})"), "");
  const Json anew = held(*drive, "", 1);
  EXPECT_EQ(anew.at("status"), "initialized");
  EXPECT_EQ(anew.at("keyframes"), 1);
  EXPECT_EQ(anew.at("gamma"), 2.5) << "the dials stay";
}

TEST(LiveDrive, SwitchesToAnotherStateOfTheScene) {
  const auto drive = made_drive();
  EXPECT_EQ(Json::parse(drive->greeting())["hello"]["scenes"].size(), 2U);
  const Json before = held(*drive, R"({"drive": [0, 0, 0.8]})", 140);  // a full turn
  EXPECT_EQ(before.at("scene"), 0);
  EXPECT_EQ(drive->take(R"({"scene": 1})"), "");
  const Json after = held(*drive, R"({"drive": [0, 0, 0.8]})", 140);
  EXPECT_EQ(after.at("scene"), 1);
  EXPECT_EQ(after.at("status"), "tracked") << "what has not moved is enough";
  EXPECT_GT(after.at("time_s"), before.at("time_s"));
  EXPECT_NE(drive->take(R"({"scene": 2})"), "");
  EXPECT_NE(drive->take(R"({"scene": -1})"), "");
}

TEST(LiveDrive, RefusesWhatItDoesNotUnderstand) {
  const auto drive = made_drive();
  const std::string deep(5000, '[');
  for (const std::string& message :
       {std::string("nonsense"), std::string("[1]"), std::string("{}"), deep,
        std::string(R"({"drive": [0, 0]})"), std::string(R"({"drive": [0, 0, "x"]})"),
        std::string(R"({"drive": [0, 0, 1], "do": "kidnap"})"), std::string(R"({"do": "format"})"),
        std::string(R"({"gamma": "high"})"), std::string(R"({"light": 1})")})
    EXPECT_NE(drive->take(message), "") << message;
  EXPECT_EQ(drive->take(R"({"drive": [1e300, 0, 0]})"), "") << "it is bounded";
  EXPECT_EQ(held(*drive, "", 1).at("status"), "initialized");
}

TEST(LiveDrive, TheSameCommandsGiveTheSameBits) {
  const auto a = made_drive(), b = made_drive();
  for (int i = 0; i < 20; ++i) {
    for (LiveDrive* drive : {a.get(), b.get()}) drive->take(R"({"drive": [0.2, 0, 0.4]})");
    const LiveDrive::Shown x = a->step(), y = b->step();
    EXPECT_EQ(x.state, y.state);
    EXPECT_EQ(x.images.color, y.images.color);
    EXPECT_EQ(x.images.labels, y.images.labels);
  }
}

TEST(LiveDrive, PublishesWhatARobotOfRos2Would) {
  const auto drive = made_drive();
  std::map<std::string, std::size_t> count;
  Stamp last_ns = 0;
  std::string pose;
  for (int i = 0; i < 20; ++i) {
    drive->take(R"({"drive": [0, 0, 0.4]})");
    const LiveDrive::Shown shown = drive->step(LiveDrive::kMessages);
    EXPECT_EQ(shown.state + shown.images.color, "") << "nobody watches the page";
    for (const MessageLog::Entry& entry : shown.messages) {
      EXPECT_GE(entry.stamp_ns, last_ns);
      last_ns = entry.stamp_ns;
      ++count[drive->topics()[entry.topic].name];
      if (drive->topics()[entry.topic].name == "/slam/pose") pose = entry.message;
      if (drive->topics()[entry.topic].name == "/slam/landmarks") {
        const auto cloud = ros::parsed<ros::PointCloud2>(entry.message, ros::Wire::kCdr);
        EXPECT_GT(cloud.width, 100U);
        EXPECT_EQ(cloud.data.size(), cloud.width * cloud.point_step);
      }
    }
  }
  for (const char* each :
       {"/camera/color/image_raw", "/camera/depth_registered/image", "/camera/labels/image",
        "/odom", "/scan/front", "/imu/data", "/tf", "/ground_truth/pose", "/slam/pose"})
    EXPECT_EQ(count[each], 20U) << each;
  for (const char* once : {"/map", "/tf_static", "/camera/labels/names"})
    EXPECT_GE(count[once], 1U) << once;
  EXPECT_EQ(count["/slam/landmarks"], 2U) << "once a second";
  const SE3 estimate = ros::pose_of(ros::parsed<ros::PoseStamped>(pose, ros::Wire::kCdr).pose);
  EXPECT_LT((estimate.translation()).norm(), 20) << "in the frame of the house";
}

TEST(LiveDrive, DrivesToAnObjectOfItsOwnMap) {
  const auto drive = made_drive();
  EXPECT_EQ(drive->take(R"({"go": "chair"})"), "");
  EXPECT_THAT(held(*drive, "", 1).at("note").get<std::string>(), HasSubstr("no map yet"));
  held(*drive, R"({"drive": [0, 0, 0.8]})", 140);  // a full turn
  EXPECT_EQ(drive->take(R"({"go": "elephant"})"), "");
  EXPECT_THAT(held(*drive, "", 1).at("note").get<std::string>(), HasSubstr("elephant"));
  EXPECT_EQ(drive->take(R"({"go": "chair"})"), "");
  Json state = held(*drive, "", 1);
  ASSERT_TRUE(state.contains("errand")) << state.dump();
  bool had_path = false;
  for (int i = 0; i < 900 && state.at("errand").at("state") != "arrived"; ++i) {
    state = held(*drive, "", 1);
    had_path = had_path || !state.at("errand").at("path").empty();
  }
  EXPECT_EQ(state.at("errand").at("state"), "arrived");
  EXPECT_TRUE(had_path);
  const Json hello = Json::parse(drive->greeting()).at("hello");
  double nearest_m = 100;
  for (const Json& thing : hello.at("things")) {
    if (hello.at("classes")[thing[4].get<std::size_t>()][0] != "chair") continue;
    const auto beyond = [&](int axis) {
      const double at = state.at("base")[axis];
      return std::max({0.0, thing[axis].get<double>() - at, at - thing[axis + 2].get<double>()});
    };
    nearest_m = std::min(nearest_m, std::hypot(beyond(0), beyond(1)));
  }
  EXPECT_LT(nearest_m, 1.0);
  held(*drive, R"({"drive": [0, 0, 0.3]})", 1);
  EXPECT_FALSE(held(*drive, "", 1).contains("errand")) << "its driver is back";
}

TEST(LiveDrive, WhatWasDrivenCanBeDrivenAgain) {
  const auto drive = made_drive();
  held(*drive, R"({"drive": [0.3, 0, 0]})", 3);
  drive->take(R"({"do": "kidnap"})");
  Json last;
  for (const auto& [command, steps] : std::vector<std::pair<const char*, int>>{
           {R"({"drive": [0, 0, 0.8]})", 9}, {R"({"drive": [0.3, 0.1, -0.2]})", 12}, {"", 5}})
    last = held(*drive, command, steps);
  const fs::path file = fs::temp_directory_path() / fmt::format("mh_driven_{}.yaml", getpid());
  write_atomically(file, commands_text(drive->driven()));
  const CommandScript script = load_commands(file);
  fs::remove(file);
  ASSERT_EQ(script.commands.size(), 2U) << "the last command is held for half a second";
  const Scene scene = load_scene(MH_SOURCE_DIR "/bench/scenarios/room.yaml");
  const CommandedDrive again =
      mh::drive(*LevelScene(scene), load_robot(MH_SOURCE_DIR "/robots/pepper/pepper.yaml"), script);
  const Eigen::Vector3d end_m = again.path.base.back().world_from_camera.translation();
  EXPECT_NEAR(end_m.x(), last.at("base")[0].get<double>(), 6e-4);  // the state is in mm
  EXPECT_NEAR(end_m.y(), last.at("base")[1].get<double>(), 6e-4);
}

class LiveServing : public testing::Test {
 protected:
  LiveServing() {
    fs::create_directories(folder_);
    for (const char* name : {"index.html", "live.js", "live.css"})
      write_atomically(folder_ / name, fmt::format("this is {}", name));
  }
  ~LiveServing() override { fs::remove_all(folder_); }

  std::unique_ptr<LiveServer> serve(const LiveAddress& address = {}) {
    return std::make_unique<LiveServer>(
        address, LiveShow{.page = folder_,
                          .greeting = [] { return std::string("hello"); },
                          .take =
                              [this](const std::string& message) {
                                heard_ = message;
                                return message == "quiet" ? "" : "heard " + message;
                              },
                          .topics = {topic_spec<ros::String>("/said", ros::Wire::kCdr),
                                     topic_spec<ros::String>("/kept", ros::Wire::kCdr, true)}});
  }

  static asio::ip::tcp::socket connect(asio::io_context& io, int port) {
    asio::ip::tcp::socket socket(io);
    socket.connect({asio::ip::make_address("127.0.0.1"), static_cast<unsigned short>(port)});
    return socket;
  }
  /// Status and body of a GET.
  static std::pair<int, std::string> get(int port, const std::string& target,
                                         const std::string& host = "",
                                         const std::string& origin = "") {
    asio::io_context io;
    beast::tcp_stream stream(connect(io, port));
    http::request<http::empty_body> request{http::verb::get, target, 11};
    request.set(http::field::host, host.empty() ? fmt::format("127.0.0.1:{}", port) : host);
    if (!origin.empty()) request.set(http::field::origin, origin);
    http::write(stream, request);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(stream, buffer, response);
    return {response.result_int(), response.body()};
  }

  struct Viewer {
    explicit Viewer(int port, const std::string& target = "/ws", const std::string& protocol = "",
                    const std::string& origin = "")
        : socket(connect(io, port)) {
      socket.set_option(
          beast::websocket::stream_base::decorator([&](beast::websocket::request_type& request) {
            if (!protocol.empty()) request.set(http::field::sec_websocket_protocol, protocol);
            if (!origin.empty()) request.set(http::field::origin, origin);
          }));
      socket.handshake(fmt::format("127.0.0.1:{}", port), target);
    }
    void write(const Json& message) { socket.write(asio::buffer(message.dump())); }
    void write_bytes(const std::string& bytes) {
      socket.binary(true);
      socket.write(asio::buffer(bytes));
      socket.binary(false);
    }
    std::string read() {
      beast::flat_buffer buffer;
      socket.read(buffer);
      return beast::buffers_to_string(buffer.data());
    }
    asio::io_context io;
    beast::websocket::stream<asio::ip::tcp::socket> socket;
  };

  const fs::path folder_ = fs::temp_directory_path() / ("mh_live_" + std::to_string(getpid()));
  std::string heard_;  // read after an answer alone: another thread writes it
};

const std::string kFoxglove(FoxgloveClient::kSubprotocol);

TEST_F(LiveServing, ThePageIsAllThatItServes) {
  const auto server = serve();
  EXPECT_EQ(server->url(), fmt::format("http://127.0.0.1:{}/", server->port()));
  EXPECT_EQ(get(server->port(), "/"), std::pair(200, std::string("this is index.html")));
  EXPECT_EQ(get(server->port(), "/live.js").second, "this is live.js");
  for (const char* target :
       {"/other", "/../live.js", "/%2e%2e/x", "//", "/index.html", "/live.js/"})
    EXPECT_EQ(get(server->port(), target).first, 404) << target;
}

TEST_F(LiveServing, WhoeverIsNotMeantIsRefused) {
  const auto server = serve();
  const int port = server->port();
  EXPECT_EQ(get(port, "/", fmt::format("localhost:{}", port)).first, 200);
  EXPECT_EQ(get(port, "/", fmt::format("rebound.example:{}", port)).first, 403);
  EXPECT_EQ(get(port, "/", "", "http://elsewhere.example").first, 403);
  EXPECT_EQ(get(port, "/", "", fmt::format("http://127.0.0.1:{}", port)).first, 200);
  const auto asking = serve({.token = "secret"});
  EXPECT_EQ(get(asking->port(), "/").first, 403);
  EXPECT_EQ(get(asking->port(), "/?token=secre").first, 403);
  EXPECT_EQ(get(asking->port(), "/?xtoken=secret").first, 403);
  EXPECT_EQ(get(asking->port(), "/?a=b&token=secret").first, 200);
  EXPECT_EQ(get(asking->port(), "/?token=secret").first, 200);
  EXPECT_THAT(asking->url(), HasSubstr("?token=secret"));
  EXPECT_THROW(Viewer(asking->port(), "/ws"), boost::system::system_error);
  EXPECT_EQ(Viewer(asking->port(), "/ws?token=secret").read(), "hello");
  EXPECT_THROW(serve({.host = "0.0.0.0"}), InputError) << "without a token";
  EXPECT_THROW(Viewer(port, "/other"), boost::system::system_error);
  EXPECT_THROW(serve({.host = "nowhere"}), InputError);
  EXPECT_THROW(serve({.token = "a&b"}), InputError);
  EXPECT_THROW(serve({.port = port}), InputError) << "it is taken";
}

TEST_F(LiveServing, ViewersAreGreetedHeardAndShownEverything) {
  const auto server = serve();
  Viewer first(server->port()), second(server->port());
  EXPECT_EQ(first.read(), "hello");
  EXPECT_EQ(second.read(), "hello");
  EXPECT_EQ(server->viewers(), 2);
  first.socket.write(asio::buffer(std::string("quiet")));
  first.socket.write(asio::buffer(std::string("me")));
  EXPECT_EQ(first.read(), R"({"error":"heard me"})");
  server->send_text("state");
  server->send_image(std::string(100'000, 'x'));
  for (Viewer* viewer : {&first, &second}) {
    EXPECT_EQ(viewer->read(), "state");
    EXPECT_EQ(viewer->read(), std::string(100'000, 'x'));
    EXPECT_TRUE(viewer->socket.got_binary());
  }
}

TEST_F(LiveServing, FoxglovesClientsAreToldTheTopicsAndGetWhatTheySubscribeTo) {
  const auto server = serve();
  server->send_messages({{5, 1, "old"}});  // nobody is there; it is kept
  Viewer viewer(server->port()), client(server->port(), "/", kFoxglove);
  EXPECT_EQ(viewer.read(), "hello");
  const Json info = Json::parse(client.read()), channels = Json::parse(client.read());
  EXPECT_EQ(info.at("op"), "serverInfo");
  EXPECT_EQ(channels.at("op"), "advertise");
  ASSERT_EQ(channels.at("channels").size(), 2U);
  EXPECT_EQ(channels.at("channels")[0],
            Json::parse(R"({"id": 0, "topic": "/said", "encoding": "cdr",
      "schemaName": "std_msgs/msg/String", "schema": "string data\n", "schemaEncoding": "ros2msg"})"));
  EXPECT_EQ(server->viewers(), 1) << "the page's alone";
  EXPECT_EQ(server->subscriptions(), 0);
  client.write({{"op", "subscribe"},
                {"subscriptions", {{{"id", 7}, {"channelId", 1}}, {{"id", 8}, {"channelId", 0}}}}});
  EXPECT_EQ(client.read(), std::string("\1\7\0\0\0\5\0\0\0\0\0\0\0old", 16)) << "latched";
  EXPECT_TRUE(client.socket.got_binary());
  EXPECT_EQ(server->subscriptions(), 2);
  server->send_messages({{258, 0, "new"}});
  EXPECT_EQ(client.read(), std::string("\1\10\0\0\0\2\1\0\0\0\0\0\0new", 16));
  client.write({{"op", "unsubscribe"}, {"subscriptionIds", {8}}});
  client.write({{"op", "sing"}});
  EXPECT_THAT(client.read(), HasSubstr("'sing': is not supported"));
  EXPECT_EQ(server->subscriptions(), 1);
  server->send_messages({{9, 0, "missed"}, {9, 1, "kept"}});
  EXPECT_THAT(client.read(), testing::EndsWith("kept"));
}

TEST_F(LiveServing, FoxglovesClientsDriveTheRobot) {
  const auto server = serve();
  Viewer client(server->port(), "/", kFoxglove);
  client.read();
  client.read();
  client.write({{"op", "advertise"},
                {"channels",
                 {{{"id", 3}, {"topic", "/cmd_vel"}, {"encoding", "cdr"}, {"schemaName", "x"}},
                  {{"id", 4}, {"topic", "/cmd_vel"}, {"encoding", "json"}, {"schemaName", "x"}},
                  {{"id", 5}, {"topic", "/other"}, {"encoding", "json"}, {"schemaName", "x"}}}}});
  const auto published = [](char id, const std::string& data) {
    return std::string("\1", 1) + id + std::string(3, '\0') + data;
  };
  client.write_bytes(
      published(3, ros::serialized(ros::Twist{{0.25, -0.5, 9}, {9, 9, 0.75}}, ros::Wire::kCdr)));
  EXPECT_THAT(client.read(), HasSubstr("heard"));
  EXPECT_EQ(Json::parse(heard_), Json::parse(R"({"drive": [0.25, -0.5, 0.75]})"));
  client.write_bytes(
      published(4, R"({"linear": {"x": 1, "y": 2, "z": 0}, "angular": {"x": 0, "y": 0, "z": 3}})"));
  EXPECT_THAT(client.read(), HasSubstr("heard"));
  EXPECT_EQ(Json::parse(heard_), Json::parse(R"({"drive": [1.0, 2.0, 3.0]})"));
  client.write_bytes(published(5, "{}"));  // nobody listens
  for (const auto& [sent, answer] : std::map<std::string, std::string>{
           {published(3, "short"), "/cmd_vel: is not in CDR"},
           {published(3, ros::serialized(ros::Twist{{NAN, 0, 0}, {}}, ros::Wire::kCdr)), "finite"},
           {published(4, "{}"), "has no number linear.x"},
           {published(4, std::string(5000, '[')), "has no number linear.x"},
           {published(6, ""), "channel 6: was not advertised"},
           {"", "expected the data of a message"},
           {"\2", "expected the data of a message"}}) {
    client.write_bytes(sent);
    EXPECT_THAT(client.read(), HasSubstr(answer));
  }
  for (const auto& [sent, answer] : std::map<std::string, std::string>{
           {"[]", "expected an object"},
           {std::string(5000, '['), "expected an object"},
           {R"({"op": 1})", "expected an object"},
           {R"({"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 2}]})", "subscribe:"},
           {R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 0}]})", "subscribe:"},
           {R"({"op": "subscribe", "subscriptions": [3]})", "subscribe:"},
           {R"({"op": "advertise", "channels": [{"id": 1, "topic": "/x", "encoding": "xml"}]})",
            "'xml' is neither"},
           {R"({"op": "advertise", "channels": [7]})", "advertise:"}}) {
    client.socket.write(asio::buffer(sent));
    EXPECT_THAT(client.read(), HasSubstr(answer)) << sent;
  }
}

TEST_F(LiveServing, AForeignPageNeedsTheToken) {
  const auto open = serve(), asking = serve({.token = "secret"});
  const std::string foreign = "https://app.foxglove.dev";
  EXPECT_THROW(Viewer(open->port(), "/", kFoxglove, foreign), boost::system::system_error);
  EXPECT_THROW(Viewer(asking->port(), "/", kFoxglove, foreign), boost::system::system_error);
  EXPECT_THAT(Viewer(asking->port(), "/?token=secret", kFoxglove, foreign).read(),
              HasSubstr("serverInfo"));
  EXPECT_THROW(Viewer(open->port(), "/", "other.protocol"), boost::system::system_error);
}

TEST_F(LiveServing, AHostileClientHarmsNobody) {
  const auto server = serve();
  Viewer good(server->port());
  EXPECT_EQ(good.read(), "hello");
  Viewer large(server->port());
  large.read();
  boost::system::error_code no_matter;
  large.socket.write(asio::buffer(std::string(1'000'000, 'x')), no_matter);  // too long a message
  EXPECT_THROW(
      {
        while (true) large.read();
      },
      boost::system::system_error);
  Viewer slow(server->port());  // reads nothing more
  asio::io_context io;
  std::vector<asio::ip::tcp::socket> many;
  for (int i = 0; i < 100; ++i) {
    many.push_back(connect(io, server->port()));
    const std::string garbage(20'000, static_cast<char>(i));
    if (i % 2 == 0) many.back().write_some(asio::buffer(garbage), no_matter);
  }
  many.clear();
  for (int i = 0; i < 200; ++i) server->send_image(std::string(100'000, 'x'));
  server->send_text("last");
  std::string read;
  while (read != "last") read = good.read();
  good.socket.write(asio::buffer(std::string("me")));
  EXPECT_EQ(good.read(), R"({"error":"heard me"})");
  EXPECT_EQ(get(server->port(), "/").first, 200);
}

}  // namespace
}  // namespace mh
