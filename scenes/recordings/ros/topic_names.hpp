// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// What each topic is used for. To name them: "color=/a,depth=/b,labels=/c,info=/d,truth=/e".
struct TopicNames {
  std::string color, depth, labels, info, truth;
};
/// @throws InputError on another key, one given twice, or no topic.
TopicNames parse_topic_names(const std::string& text);

}  // namespace mh
