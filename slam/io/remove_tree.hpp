// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mh {

/// Removes a folder with all that it contains, however deep it is and whatever its folders forbid.
/// Links are not followed; what may not be removed stays. It makes system calls alone, so that a
/// forked process may call it.
void remove_tree(const char* folder);

}  // namespace mh
