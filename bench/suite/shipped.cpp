// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/shipped.hpp"

#include <dlfcn.h>

#include <map>
#include <string_view>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, fs::path>;

/// Adds the files in `folder` that have this extension, by name.
void collect(const fs::path& folder, std::string_view ending, Files& files) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error) && entry.path().extension() == ending)
      files[entry.path().stem().string()] = entry.path();
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_directory(error)) folders.push_back(entry.path());
  return folders;
}

Files scenes_of(const fs::path& data) {
  Files files;
  for (const char* folder : {"model_house", "rooms"})
    collect(data / "scenes" / folder, ".yaml", files);
  // A house is named by its folder.
  if (auto house = files.extract("house"); !house.empty())
    files[house.mapped().parent_path().filename().string()] = house.mapped();
  return files;
}

Files tours_of(const fs::path& data) {
  Files files;
  for (const char* folder : {"model_house", "rooms"}) {
    Files tours;
    collect(data / "scenes" / folder / "tours", ".yaml", tours);
    for (const auto& [name, file] : tours) files[fmt::format("{}/{}", folder, name)] = file;
  }
  return files;
}

Files files_of(Shipped what) {
  const fs::path data = data_folder();
  Files files;
  switch (what) {
    case Shipped::kSuite:
      for (const char* folder : {"bench/suites", "bench/studies"})
        collect(data / folder, ".yaml", files);
      break;
    case Shipped::kScene:
      return scenes_of(data);
    case Shipped::kTour:
      return tours_of(data);
    case Shipped::kRobot:
      for (const fs::path& folder : folders_in(data / "robots")) collect(folder, ".yaml", files);
      break;
    case Shipped::kLevel:
      collect(data / "sim/sensors/levels", ".yaml", files);
      break;
    case Shipped::kVocabulary:
      collect(data / "assets", ".mhvoc", files);
      break;
    case Shipped::kSettings:
      collect(data / "assets/cameras", ".yaml", files);
      break;
  }
  return files;
}

std::string_view noun(Shipped what) {
  switch (what) {
    case Shipped::kSuite:
      return "suite";
    case Shipped::kScene:
      return "scene";
    case Shipped::kTour:
      return "tour";
    case Shipped::kRobot:
      return "robot";
    case Shipped::kLevel:
      return "sensor level";
    case Shipped::kVocabulary:
      return "vocabulary";
    case Shipped::kSettings:
      return "settings file";
  }
  return "file";
}

/// A scene may be a folder; everything else is a file.
bool is_there(const fs::path& file, Shipped what) {
  std::error_code error;
  return what == Shipped::kScene ? fs::exists(file, error)
                                 : fs::exists(file, error) && !fs::is_directory(file, error);
}

}  // namespace

fs::path data_folder() {
  static const fs::path folder = [] {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path installed = (program.parent_path() / MH_DATA_FROM_PROGRAM).lexically_normal();
    if (!error && fs::is_directory(installed / "bench/suites", error)) return installed;
    // The Python package is installed among the data, or by pip with the data in it.
    if (Dl_info here{}; dladdr(reinterpret_cast<const void*>(&data_folder), &here) != 0)
      for (const char* from_package : {"../..", "data"}) {
        const fs::path data =
            (fs::absolute(here.dli_fname).parent_path() / from_package).lexically_normal();
        if (fs::is_directory(data / "bench/suites", error)) return data;
      }
    return fs::path(MH_SOURCE_DIR);
  }();
  return folder;
}

std::vector<std::string> shipped_names(Shipped what) {
  return words_of(files_of(what), [](const auto& file) { return file.first; });
}

fs::path shipped_file(const std::string& name, Shipped what) {
  const Files files = files_of(what);
  const auto found = files.find(name);
  return found == files.end() ? fs::path() : found->second;
}

bool is_bare_name(const std::string& word) {
  return !word.empty() && word.find_first_of("./:") == std::string::npos;
}

fs::path find_shipped(const std::string& word, Shipped what) {
  if (word.empty() || is_there(word, what)) return word;
  if (const fs::path file = shipped_file(word, what); !file.empty()) return file;
  if (const fs::path below = data_folder() / word; is_there(below, what)) return below;
  if (!is_bare_name(word)) return word;
  std::error_code error;
  if (fs::is_directory(word, error))
    throw InputError(
        fmt::format("'{}' is a folder, and no {} of that name is shipped", word, noun(what)));
  throw InputError(fmt::format("'{}' is not a file, and no {} of that name is shipped{}", word,
                               noun(what), hint(word, shipped_names(what))));
}

fs::path find_scene(const std::string& word) {
  return word.starts_with("generated:") ? fs::path(word) : find_shipped(word, Shipped::kScene);
}

}  // namespace mh
