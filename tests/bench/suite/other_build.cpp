// SPDX-License-Identifier: Apache-2.0
// Replaces bench/suite/code_version.cpp and bench/suite/fingerprint.cpp: a build whose sources and
// compiler a test may change.
#include "tests/bench/suite/other_build.hpp"

#include "bench/suite/code_version.hpp"
#include "bench/suite/fingerprint.hpp"

namespace mh {

OtherBuild other_build;

std::string_view code_of_light() {
  return "light";
}
std::string_view code_of_run() {
  return other_build.code;
}
std::string_view built_commit() {
  return other_build.commit;
}
nlohmann::ordered_json build_json() {
  return {{"compiler", other_build.compiler}};
}
nlohmann::ordered_json fingerprint_json() {
  return build_json();
}

}  // namespace mh
