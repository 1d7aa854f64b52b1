// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/observe.hpp"

namespace mh {

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
