// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "source_dir.hpp"

// Shared by tests of the program as a user sees it.

namespace mh::test {

/// Content of a file; "" if it does not exist.
inline std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// Exit code of a program, or minus the signal that ended it.
inline int code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// Writes a Pepper whose images have a quarter of the pixels, so that they render in a quarter of
/// the time.
inline std::string write_small_pepper(const std::filesystem::path& file) {
  const std::filesystem::path whole = MH_SOURCE_DIR "/robots/pepper/pepper.yaml";
  std::string text = content(whole);
  const auto exchange = [&](const std::string& old, const std::string& with) {
    text.replace(text.find(old), old.size(), with);
  };
  exchange("width_px: 640", "width_px: 320");
  exchange("height_px: 480", "height_px: 240");
  exchange("urdf: ", "urdf: " + whole.parent_path().string() + "/");
  std::ofstream(file) << text;
  return file.string();
}

/// Three short runs per trial in a small room.
struct SmallSuite {
  std::string scene = MH_SOURCE_DIR "/bench/scenarios/room.yaml";
  std::string systems = "[semantic, plain]", labels = "[exact, boxes]", level = "pepper";
  std::string robot = MH_SOURCE_DIR "/bench/scenarios/robot.yaml";
  std::string more = "";

  void write(const std::filesystem::path& file) const {
    const std::string root = MH_SOURCE_DIR;
    std::ofstream(file) << "environments:\n- {category: room, scene: " << scene
                        << ", mapping_tour: " << root
                        << "/bench/scenarios/tours/room.yaml, query_tour: " << root
                        << "/bench/scenarios/tours/room_query.yaml}\nrobot: " << robot
                        << "\nvocabulary: " << root << "/assets/vocabulary.mhvoc\nlevels: [" << root
                        << "/sim/sensors/levels/" << level << ".yaml]\nsystems: " << systems
                        << "\nlabels: " << labels << "\nprotocol: {test_interval: 10}\n"
                        << more;
  }
};

}  // namespace mh::test
