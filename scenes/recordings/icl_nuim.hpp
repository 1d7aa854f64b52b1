// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/recordings/open_sequence.hpp"

namespace mh {

/// ICL-NUIM's sequences with TUM-compatible images (Handa et al., ICRA 2014): TUM's layout, but
/// with frame numbers in place of stamps, depth listed before color, and true poses in the
/// renderer's left-handed world. The calibration is the published one unless a different one is
/// specified.
extern const SequenceReader kIclNuimReader;

}  // namespace mh
