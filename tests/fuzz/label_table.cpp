// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/label_table.hpp"

#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mh::try_input([&] { mh::parse_label_table(mh::bytes_of(data, size), "fuzz.tsv"); });
  return 0;
}
