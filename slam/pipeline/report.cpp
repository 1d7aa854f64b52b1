// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/report.hpp"

#include "slam/pipeline/observe.hpp"

namespace mh {

std::string_view name(TrackStatus status) {
  switch (status) {
    case TrackStatus::kInitialized:
      return "initialized";
    case TrackStatus::kTracked:
      return "tracked";
    case TrackStatus::kRelocalized:
      return "relocalized";
    case TrackStatus::kLost:
      return "lost";
  }
  return "?";
}

std::string_view name(Stage stage) {
  switch (stage) {
    case Stage::kFeatures:
      return "features";
    case Stage::kWords:
      return "words";
    case Stage::kTracking:
      return "tracking";
    case Stage::kRelocalization:
      return "relocalization";
    case Stage::kLocalMap:
      return "local_map";
    case Stage::kMapping:
      return "mapping";
    case Stage::kLoop:
      return "loop";
    case Stage::kCount:
      break;
  }
  return "?";
}

}  // namespace mh
