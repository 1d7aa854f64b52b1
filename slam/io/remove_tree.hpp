// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mh {

/// Removes a folder and everything in it, at any depth, even if folders in it lack permissions.
/// Links are not followed; what cannot be removed stays. Makes only system calls, so that a forked
/// process may call it.
void remove_tree(const char* folder);

}  // namespace mh
