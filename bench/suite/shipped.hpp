// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mh {

/// What ships with Modelhouse and may be named instead of a file: `--level pepper`.
enum class Shipped { kSuite, kScene, kTour, kRobot, kLevel, kVocabulary, kSettings };

/// The folder that contains bench/suites, scenes, robots, sim/sensors/levels and assets: that of
/// the installed package next to the executable (../share/modelhouse) or of the Python package,
/// otherwise that of the source tree.
std::filesystem::path data_folder();

/// The names of everything of a kind that is shipped, in alphabetical order: a file's name without
/// its extension; for a scene house.yaml, the name of its folder (model_house); for a tour in the
/// folder `tours` next to a house.yaml, both names (model_house/mapping).
std::vector<std::string> shipped_names(Shipped what);

/// The file that a user's word refers to: the file of that name if it exists, otherwise what is
/// shipped under that name ("pepper") or path ("bench/suites/ci.yaml"). A path that does not exist
/// is returned unchanged, for its reader to refuse.
/// @throws InputError with suggestions if a word without '/' and '.' is neither a file nor a
/// shipped name.
std::filesystem::path find_shipped(const std::string& word, Shipped what);

/// The file shipped under that name; empty if there is none.
std::filesystem::path shipped_file(const std::string& name, Shipped what);

/// Whether a word can only be a name: no path, no extension, no prefix such as generated:.
bool is_bare_name(const std::string& word);

/// find_shipped() for scenes: "generated:..." is returned unchanged.
std::filesystem::path find_scene(const std::string& word);

}  // namespace mh
