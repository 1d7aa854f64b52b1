// SPDX-License-Identifier: Apache-2.0
// Conversation mode: a line of JSON in, a line of JSON out (docs/outside_systems.md). This file is
// all that a system needs to take part; OpenCV parses the requests.
#include <unistd.h>

#include <array>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include "odometry.hpp"

namespace {

/// Opens the conversation's output. What libraries print to standard output goes to the log.
FILE* open_replies() {
  FILE* replies = fdopen(dup(STDOUT_FILENO), "w");
  dup2(STDERR_FILENO, STDOUT_FILENO);
  return replies;
}

/// The camera's pose from wheel odometry, if the request contains it.
std::optional<cv::Affine3d> wheels_of(const cv::FileStorage& request) {
  const cv::FileNode told = request["odometry"];
  if (told.size() != 7) return {};
  std::array<double, 7> values{};
  for (int i = 0; i < 7; ++i) values[static_cast<std::size_t>(i)] = told[i].real();
  return example::pose_of(values);
}

std::string about(const example::Found& found) {
  const auto& pose = found.world_from_camera;
  return ",\"pose\":" + (pose ? "[" + example::pose_numbers(*pose, ',') + "]" : "null") +
         ",\"inliers\":" + std::to_string(found.inliers) +
         ",\"keyframe\":" + (found.keyframe_added ? "true" : "false") +
         (found.candidates == 0
              ? ""
              : ",\"candidates\":{\"keyframes\":" + std::to_string(found.keyframes) +
                    ",\"final\":" + std::to_string(found.candidates) + "}");
}

}  // namespace

int main() try {
  FILE* replies = open_replies();
  std::unique_ptr<example::VisualOdometry> odometry;
  std::string line;
  while (std::getline(std::cin, line)) {
    const cv::FileStorage request(
        line, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_JSON);
    const std::string what = request["do"].string();
    cv::Mat color, depth;
    if (!request["color"].empty()) {
      color = cv::imread(request["color"].string());
      depth = cv::imread(request["depth"].string(), cv::IMREAD_UNCHANGED);
    }
    std::string reply;
    if (what == "hello") {
      odometry = std::make_unique<example::VisualOdometry>(
          example::read_settings(request["settings"].string()));
      reply = R"(,"protocol":1,"name":"visual odometry")";
    } else if (!odometry) {
      reply = R"(,"error":"hello comes first")";
    } else if (what == "track") {
      reply = about(odometry->track(color, depth, wheels_of(request)));
    } else if (what == "rewind") {
      odometry->lose();
    } else if (what == "reset") {
      odometry->forget_map();
    } else if (what == "freeze") {
      // The map is a list of keyframes that relocalize() only reads: it stays unchanged.
    } else if (what == "blank") {
      reply = R"(,"pose":null)";  // relocalize() keeps no state: nothing to lose
    } else if (what == "relocalize") {
      reply = about(odometry->relocalize(color, depth));
    } else {
      reply = R"(,"error":"unknown request ')" + what + "'\"";
    }
    const auto id = static_cast<int>(request["id"]);
    std::fprintf(replies, "{\"id\":%d%s}\n", id, reply.c_str());
    std::fflush(replies);
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
