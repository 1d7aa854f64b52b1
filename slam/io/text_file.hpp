// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mh {

/// A file's text without the UTF-8 byte-order mark that some editors prepend.
/// @throws InputError naming the file if the mark is UTF-16's.
std::string_view without_mark(std::string_view text, const std::filesystem::path& file);

/// Returns the whole content of a text file, without_mark(). Lines end in \n or \r\n; in a
/// file without any \n, each \r is replaced by one. @throws InputError naming the file.
std::string read_text(const std::filesystem::path& file);

}  // namespace mh
