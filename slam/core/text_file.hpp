// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mh {

/// A file's text without the byte-order mark that some editors put before UTF-8.
/// @throws InputError naming the file if the mark is that of UTF-16.
std::string_view without_mark(std::string_view text, const std::filesystem::path& file);

/// Whole content of a text file, without_mark(). @throws InputError naming it.
std::string read_text(const std::filesystem::path& file);

}  // namespace mh
