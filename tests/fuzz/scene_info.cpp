// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/scene_info.hpp"

#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mh::try_input([&] { mh::parse_scannet_info(mh::bytes_of(data, size), "fuzz.txt"); });
  return 0;
}
