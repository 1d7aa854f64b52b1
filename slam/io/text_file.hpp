// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mh {

/// A file's text without the UTF-8 byte-order mark that some editors prepend.
/// @throws InputError naming the file if the mark is UTF-16's.
std::string_view without_mark(std::string_view text, const std::filesystem::path& file);

/// Returns the whole content of a text file, without_mark(), its lines ending in \n (or \r\n) even
/// where a bare \r ends them. @throws InputError naming it.
std::string read_text(const std::filesystem::path& file);

}  // namespace mh
