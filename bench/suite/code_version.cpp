// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/code_version.hpp"

#include "code_version_made.hpp"

namespace mh {

std::string_view code_of_light() {
  return MH_CODE_LIGHT;
}
std::string_view code_of_detections() {
  return MH_CODE_DETECT;
}
std::string_view code_of_run() {
  return MH_CODE_RUN;
}
std::string_view code_of_audit() {
  return MH_CODE_AUDIT;
}
std::string_view built_commit() {
  return MH_COMMIT;
}

}  // namespace mh
