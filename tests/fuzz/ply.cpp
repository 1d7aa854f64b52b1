// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/ply.hpp"

#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = mh::bytes_of(data, size);
  mh::try_input([&] { mh::parse_ply(bytes, "fuzz.ply"); });
  mh::try_input([&] { mh::parse_ply(bytes, "fuzz.ply", {.geometry = false}); });
  return 0;
}
