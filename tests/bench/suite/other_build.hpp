// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// What a different build of the program would report about itself.
struct OtherBuild {
  std::string code = "1", commit = "a", compiler = "12.2";
};
extern OtherBuild other_build;

}  // namespace mh
