// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/check_labels.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "slam/core/labels.hpp"
#include "slam/io/error.hpp"
#include "tests/scenes/scanned_room.hpp"

namespace mh {
namespace {

using test::ScannedRoom;

TEST(CheckLabels, BoxesNeedObjects) {
  Scene room = ScannedRoom{}.build();
  for (const LabelMode labels : {LabelMode::kBoxes, LabelMode::kDetector}) {
    EXPECT_NE(check_labels(room, labels).find("none of its 2 objects"), std::string::npos);
    Scene without = room;
    std::ranges::fill(without.instance_of, InstanceId{0});
    EXPECT_THROW(check_labels(without, labels), InputError);
    without.instances.clear();
    EXPECT_EQ(check_labels(without, LabelMode::kExact), "");
  }
  room.instances[1].class_id = *class_by_name("sofa");
  EXPECT_EQ(check_labels(room, LabelMode::kBoxes), "");
}

}  // namespace
}  // namespace mh
