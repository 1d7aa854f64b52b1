// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/label_images.hpp"

#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mh::try_input([&] {
    const auto images =
        mh::open_label_zip(mh::hold(std::string(mh::bytes_of(data, size))), "fuzz.zip");
    for (std::uint32_t number = 0; number < 4; ++number)
      mh::try_input([&] { images->read(number); });
  });
  return 0;
}
