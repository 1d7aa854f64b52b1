// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/annotation.hpp"

#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = mh::bytes_of(data, size);
  mh::try_input([&] { mh::parse_segments(bytes, "fuzz.segs.json"); });
  mh::try_input([&] { mh::parse_aggregation(bytes, "fuzz.aggregation.json"); });
  return 0;
}
