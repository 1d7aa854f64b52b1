// SPDX-License-Identifier: Apache-2.0
// What a client of Foxglove's protocol may send: lines that are texts ("t...") or bytes ("b...").
#include <algorithm>
#include <string_view>
#include <vector>

#include "bench/live/foxglove.hpp"
#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<mh::TopicSpec> topics{
      mh::topic_spec<mh::ros::String>("/said", mh::ros::Wire::kCdr),
      mh::topic_spec<mh::ros::TfMessage>("/moved", mh::ros::Wire::kCdr)};
  mh::FoxgloveClient client(topics);
  std::string_view left(reinterpret_cast<const char*>(data), size);
  while (!left.empty()) {
    const std::string_view line = left.substr(0, left.find('\n'));
    left.remove_prefix(std::min(left.size(), line.size() + 1));
    if (line.empty()) continue;
    const auto heard =
        line[0] == 't' ? client.take_text(line.substr(1)) : client.take_binary(line.substr(1));
    for (const std::size_t topic : heard.begun)
      if (!client.head(topic, 1)) __builtin_trap();  // subscribed to, so it has a head
  }
  if (client.subscriptions() > topics.size()) __builtin_trap();
  return 0;
}
