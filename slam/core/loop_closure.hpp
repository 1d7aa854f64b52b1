// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"
#include "slam/io/fields.hpp"

namespace mh {

/// A closed loop: two keyframes and their relative pose, estimated from what both see. For
/// evaluation against ground truth.
struct LoopClosure {
  Stamp stamp_ns = 0, old_stamp_ns = 0;  ///< of the newest keyframe and of the recognized one
  SE3 old_from_new;                      ///< old camera from new camera
};

template <MaybeConst<LoopClosure> L, class Visit>
void fields(L& loop, Visit& v) {
  auto& [stamp_ns, old_stamp_ns, old_from_new] = loop;
  v("stamp_ns", stamp_ns);
  v("old_stamp_ns", old_stamp_ns);
  v("old_from_new", old_from_new);
}

}  // namespace mh
