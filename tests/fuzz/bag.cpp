// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/messages/message_file.hpp"

#include "tests/fuzz/messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mh::read_recording(mh::open_bag, mh::bytes_of(data, size));
  return 0;
}
