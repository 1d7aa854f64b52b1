// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/ros/topic_names.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {

TopicNames parse_topic_names(const std::string& text) {
  TopicNames names;
  const std::vector<std::pair<std::string, std::string*>> keys = {{"color", &names.color},
                                                                  {"depth", &names.depth},
                                                                  {"labels", &names.labels},
                                                                  {"info", &names.info},
                                                                  {"truth", &names.truth}};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    at = end + 1;
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    const auto known = std::ranges::find(keys, key, &std::pair<std::string, std::string*>::first);
    if (equals == std::string::npos || equals + 1 == part.size() || known == keys.end())
      throw InputError(
          fmt::format("topics '{}': '{}' is not KEY=TOPIC with color, depth, labels, info or truth",
                      text, part));
    if (!known->second->empty())
      throw InputError(fmt::format("topics '{}': {} is named twice", text, key));
    *known->second = part.substr(equals + 1);
  }
  return names;
}

}  // namespace mh
