// SPDX-License-Identifier: Apache-2.0
// The drive behind `modelhouse live`, and the server that shows it.
#include <filesystem>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "bench/live/live_drive.hpp"
#include "bench/live/live_server.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/suite/cache.hpp"
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
  static const SimulatedScene scene =
      load_simulated_scene(MH_SOURCE_DIR "/bench/scenarios/room.yaml", Cache(MH_TEST_CACHE));
  static const auto vocabulary = std::make_shared<const Vocabulary>(
      Vocabulary::load(MH_SOURCE_DIR "/assets/vocabulary.mhvoc"));
  return std::make_unique<LiveDrive>(
      scene, load_robot(MH_SOURCE_DIR "/robots/pepper/pepper.yaml"),
      load_sensor_config(MH_SOURCE_DIR "/sim/sensors/levels/ideal.yaml"), vocabulary, 3);
}

/// Repeats a command for some steps. @returns the last state
Json held(LiveDrive& drive, const std::string& command, int steps) {
  Json state;
  for (int i = 0; i < steps; ++i) {
    if (!command.empty()) EXPECT_EQ(drive.take(command), "");
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
    EXPECT_EQ(x.color, y.color);
    EXPECT_EQ(x.labels, y.labels);
  }
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
        address, folder_, [] { return std::string("hello"); },
        [](const std::string& message) { return message == "quiet" ? "" : "heard " + message; });
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
    explicit Viewer(int port, const std::string& target = "/ws") : socket(connect(io, port)) {
      socket.handshake(fmt::format("127.0.0.1:{}", port), target);
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
};

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
  EXPECT_EQ(first.read(), "heard me");
  server->send_text("state");
  server->send_image(std::string(100'000, 'x'));
  for (Viewer* viewer : {&first, &second}) {
    EXPECT_EQ(viewer->read(), "state");
    EXPECT_EQ(viewer->read(), std::string(100'000, 'x'));
    EXPECT_TRUE(viewer->socket.got_binary());
  }
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
  EXPECT_EQ(good.read(), "heard me");
  EXPECT_EQ(get(server->port(), "/").first, 200);
}

}  // namespace
}  // namespace mh
