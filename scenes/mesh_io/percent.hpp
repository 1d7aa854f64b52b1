// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mh {

/// A URI's path with its percent codes replaced: "my%20image.png" is "my image.png". A percent sign
/// that does not begin a code is kept.
std::string percent_decoded(std::string_view uri);

/// What a URI in a file of this folder names: the file of exactly this name if there is one,
/// because some programs do not encode names; otherwise the decoded name.
std::string named_by_uri(const std::filesystem::path& folder, const std::string& uri);

}  // namespace mh
