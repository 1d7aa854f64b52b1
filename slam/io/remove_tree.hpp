// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mh {

/// Removes a folder with all that it contains, at any depth and despite missing permissions of its
/// folders. Links are not followed; what cannot be removed stays. Makes only system calls, so that
/// a forked process may call it.
void remove_tree(const char* folder);

}  // namespace mh
