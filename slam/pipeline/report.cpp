// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/report.hpp"

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

}  // namespace mh
