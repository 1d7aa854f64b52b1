// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/sens.hpp"

#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mh::try_input([&] {
    const auto recording =
        mh::open_sens(mh::hold(std::string(mh::bytes_of(data, size))), "fuzz.sens");
    for (std::size_t i = 0; i < recording->size(); ++i) mh::try_input([&] { recording->frame(i); });
  });
  return 0;
}
