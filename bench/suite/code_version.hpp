// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace mh {

/// Digest of the sources that determine a scene's baked light.
std::string_view code_of_light();
/// Digest of the sources that determine what a detector finds.
std::string_view code_of_detections();
/// Digest of the sources that determine a run's result.
std::string_view code_of_run();
/// Digest of the additional sources that determine an audit of a run.
std::string_view code_of_audit();
/// `git describe` of what was built; empty outside a repository.
std::string_view built_commit();

}  // namespace mh
