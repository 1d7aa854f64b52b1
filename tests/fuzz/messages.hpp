// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "scenes/recordings/ros/sequence.hpp"
#include "slam/core/random.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace mh {

/// Opens a file of messages as a recording and reads each of its frames.
inline void read_recording(OpenMessages open, std::string_view bytes) {
  try_input([&] {
    const OpenedRecording opened =
        open_messages(open, {{"fuzz", hold(std::string(bytes))}}, "fuzz", {});
    for (std::size_t i = 0; i < opened.sequence->size(); ++i)
      try_input([&] { opened.sequence->frame(i, RandomStream(0)); });
  });
}

}  // namespace mh
