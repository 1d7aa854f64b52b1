// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// The topic for each use. Users name them as "color=/a,depth=/b,labels=/c,info=/d,truth=/e".
struct TopicNames {
  std::string color, depth, labels, info, truth;
};
/// @throws InputError on an unknown key, a key given twice, or a missing topic.
TopicNames parse_topic_names(const std::string& text);

}  // namespace mh
