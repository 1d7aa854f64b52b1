// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/arguments.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <exception>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/suggest.hpp"

namespace mh::cli {

namespace fs = std::filesystem;

namespace {

/// Parses the whole text as a number; nullopt if it is not one.
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
          return fmt::format("'{}' is not a finite number", text);
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
                                  : fmt::format("'{}' is not an integer from 0 to 2^64 - 1", text);
      },
      "", "seed");
}

CLI::Validator one_of_words(std::vector<std::string> words) {
  std::string described = fmt::format("{{{}}}", fmt::join(words, ","));
  return CLI::Validator(
      [words = std::move(words)](std::string& text) {
        if (std::ranges::find(words, text) != words.end()) return std::string();
        return fmt::format("'{}' is not one of {}{}", text, fmt::join(words, ", "),
                           did_you_mean(text, words));
      },
      std::move(described), "word");
}

CLI::Validator not_empty() {
  return CLI::Validator(
      [](std::string& text) { return text.empty() ? std::string("is empty") : std::string(); }, "",
      "not empty");
}

void resolve(std::string& word, Shipped what) {
  word = (what == Shipped::kScene ? find_scene(word) : find_shipped(word, what)).string();
}

namespace {

/// The first bytes that a file with this extension must have; empty if the extension implies none.
std::string_view head_of(const fs::path& file) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kHeads = {
      {{".png", "\x89PNG"},
       {".pdf", "%PDF"},
       {".glb", "glTF"},
       {".ply", "ply"},
       {".mhvoc", "MHVOCAB"}}};
  for (const auto& [ending, head] : kHeads)
    if (file.extension() == ending) return head;
  return {};
}

/// Whether a file begins with `head`. Also true if the file is empty or missing.
bool begins_with(const fs::path& file, std::string_view head) {
  std::string start(head.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  return in.gcount() == 0 || start == head;
}

void require_other_file(const fs::path& file, const fs::path& input) {
  std::error_code error;
  if (fs::equivalent(file, input, error) && !error)
    throw InputError(
        fmt::format("{}: is read by this command: name another file to write", file.string()));
}

}  // namespace

void require_not_read(const fs::path& file, const ReadRecord& record) {
  for (const FileObservation& seen : record.observations)
    if (seen.kind == FileObservation::Kind::kRead) require_other_file(file, seen.path);
}

void require_writable(const fs::path& file, const std::vector<fs::path>& read) {
  std::error_code error;
  if (fs::exists(file, error) && !fs::is_regular_file(file, error))
    throw InputError(fmt::format("{}: cannot be written: it is {}", file.string(),
                                 fs::is_directory(file, error) ? "a folder" : "not a file"));
  for (const fs::path& input : read) require_other_file(file, input);
  if (!begins_with(file, head_of(file)))
    throw InputError(fmt::format("{}: already exists and is not a file of this kind: name another",
                                 file.string()));
  make_output_folder(file.has_parent_path() ? file.parent_path() : fs::path("."));
}

void require_replaceable(const fs::path& file, std::string_view head, std::string_view kind,
                         const std::vector<fs::path>& read) {
  require_replaceable(
      file, [&](const std::string& text) { return text.starts_with(head); }, kind, read);
}

void require_replaceable(const fs::path& file,
                         const std::function<bool(const std::string&)>& is_ours,
                         std::string_view kind, const std::vector<fs::path>& read) {
  if (!is_file(file)) return require_writable(file, read);
  if (const std::string text = read_file(file); !text.empty() && !is_ours(text))
    throw InputError(fmt::format("{}: already exists and was not written by {}: name another",
                                 file.string(), kind));
  require_writable(file, read);
}

namespace {

constexpr std::string_view kMarkHead = "Written here, and replaced when it is written anew, by:\n";

std::string mark_in(const fs::path& folder) {
  const fs::path file = folder / kOutputMark;
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) return {};
  const ReadScope no_input(ReadScope::Outer::kIgnores);
  std::string mark = read_file(file);
  if (!mark.starts_with(kMarkHead))
    throw InputError(
        fmt::format("{}: was not written by modelhouse: name another folder", file.string()));
  return mark;
}

}  // namespace

NewFolders::NewFolders(fs::path folder) {
  std::error_code error;
  for (; !folder.empty() && !fs::exists(folder, error); folder = folder.parent_path())
    missing_.push_back(folder);
}

NewFolders::~NewFolders() {
  std::error_code error;
  for (const fs::path& folder : missing_) fs::remove(folder, error);  // one that holds files stays
}

OutputFolder::OutputFolder(const fs::path& folder, const std::string& command,
                           std::vector<std::string> names, Others others)
    : folder_(folder), names_(std::move(names)), made_(folder), hold_(folder) {
  const std::string line = "modelhouse " + command + "\n", mark = mark_in(folder);
  const bool ours = mark.find("\n" + line) != std::string::npos;
  std::error_code error;
  if (!ours)
    for (const std::string& name : names_)
      if (fs::exists(fs::symlink_status(folder / name, error)))
        throw InputError(fmt::format(
            "{}: already exists and was not written by `modelhouse {}`: name another folder",
            (folder / name).string(), command));
  make_output_folder(folder);
  if (others == Others::kNone) hold_.take();
  if (ours) return;
  write_atomically(folder / kOutputMark, (mark.empty() ? std::string(kMarkHead) : mark) + line);
  mark_before_ = mark;
}

bool OutputFolder::holds_any() const {
  std::error_code error;
  return std::any_of(names_.begin(), names_.end(), [&](const std::string& name) {
    return fs::exists(fs::symlink_status(folder_ / name, error));
  });
}

OutputFolder::~OutputFolder() {
  std::error_code error;
  if (mark_before_ && !holds_any()) {
    try {
      if (!mark_before_->empty()) write_atomically(folder_ / kOutputMark, *mark_before_);
    } catch (const std::exception&) {  // a leftover mark does no harm
    }
    if (mark_before_->empty()) fs::remove(folder_ / kOutputMark, error);
  }
}

}  // namespace mh::cli
