// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mh {

/// What comes with Modelhouse and may be named instead of a file: `--level pepper`.
enum class Shipped { kSuite, kScene, kTour, kRobot, kLevel, kVocabulary, kSettings };

/// The folder that holds bench/suites, scenes, robots, sim/sensors/levels and assets: that of the
/// installed package beside the executable (../share/modelhouse), else the source tree.
std::filesystem::path data_folder();

/// The names of all that is shipped of a kind, in alphabetical order: a file's name without its
/// ending; model_house for the scene house.yaml in its folder, model_house/mapping for a tour in
/// the folder tours beside it.
std::vector<std::string> shipped_names(Shipped what);

/// The file that a user's word stands for: the file of that name where there is one, else what is
/// shipped under the name ("pepper") or path ("bench/suites/ci.yaml"). A path that leads nowhere is
/// returned as it is, for its reader to refuse.
/// @throws InputError if a word without '/' and '.' is neither: with what it may have meant.
std::filesystem::path find_shipped(const std::string& word, Shipped what);

/// The file that is shipped under that name; empty if none is.
std::filesystem::path shipped_file(const std::string& name, Shipped what);

/// A word that can only be a name: no path, no ending, no prefix such as generated:.
bool is_bare_name(const std::string& word);

/// find_shipped() for scenes: "generated:..." stands for itself.
std::filesystem::path find_scene(const std::string& word);

}  // namespace mh
