// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/tum_list.hpp"
#include "slam/core/trajectory_io.hpp"
#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(mh::bytes_of(data, size));
  mh::try_input([&] { mh::parse_tum_list(text, "rgb.txt"); });
  mh::try_input([&] { mh::parse_tum_list(text, "associations.txt", 2); });
  mh::try_input([&] { mh::parse_trajectory(text, "groundtruth.txt"); });
  return 0;
}
