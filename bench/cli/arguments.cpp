// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/arguments.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh::cli {
namespace {

/// The whole text as a number, or nothing.
template <class T>
bool parse(const std::string& text, T& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

}  // namespace

CLI::Validator number_between(double least, double greatest) {
  const std::string range = fmt::format("[{:g} - {:g}]", least, greatest);
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        if (!parse(text, value) || !std::isfinite(value))
          return fmt::format("'{}' is no finite number", text);
        if (value < least || value > greatest)
          return fmt::format("Value {} not in range {}", text, range);
        return std::string();
      },
      "FLOAT in " + range, "number");
}

CLI::Validator seed_number() {
  return CLI::Validator(
      [](std::string& text) {
        std::uint64_t value = 0;
        return parse(text, value) ? std::string()
                                  : fmt::format("'{}' is no whole number from 0 to 2^64 - 1", text);
      },
      "", "seed");
}

void need_writable(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    throw InputError(
        fmt::format("{}: cannot be written: it is {}", file.string(),
                    std::filesystem::is_directory(file, error) ? "a folder" : "no file"));
  make_output_folder(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."));
}

OutputFolder::OutputFolder(const std::filesystem::path& folder) {
  std::error_code error;
  for (std::filesystem::path p = folder; !p.empty() && !std::filesystem::exists(p, error);
       p = p.parent_path())
    made_.push_back(p);
  make_output_folder(folder);
}

OutputFolder::~OutputFolder() {
  std::error_code error;  // a folder that holds something stays
  for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, error);
}

}  // namespace mh::cli
