// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/fingerprint.hpp"

#include <fstream>
#include <string>

#include <LinearMath/btScalar.h>
#include <ceres/version.h>
#include <embree3/rtcore_config.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <Eigen/Core>
#include <opencv2/core/version.hpp>

namespace mh {
namespace {

/// The processor's name as Linux reports it; "unknown" elsewhere.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line))
    if (line.starts_with("model name"))
      if (const auto colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  return "unknown";
}

}  // namespace

nlohmann::ordered_json build_json() {
  return {{"modelhouse", MH_VERSION},
          {"compiler", __VERSION__},
          {"build_type", MH_BUILD_TYPE},
          {"embree", RTC_VERSION_STRING},
          {"opencv", CV_VERSION},
          {"eigen",
           fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"ceres", CERES_VERSION_STRING},
          {"bullet", fmt::format("{}.{}", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100)},
          {"octomap", MH_OCTOMAP},
          {"assimp", MH_ASSIMP},
          {"sdformat", MH_SDFORMAT},
          {"yaml-cpp", MH_YAML_CPP},
          {"sqlite", SQLITE_VERSION}};
}

nlohmann::ordered_json fingerprint_json() {
  nlohmann::ordered_json json = build_json();
  json["processor"] = processor();
  return json;
}

}  // namespace mh
