// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mh::gazebo {

/// Finds what URIs of a world and of the models that it includes mean.
class Finder {
 public:
  /// @param world  the file that was asked for
  explicit Finder(const std::filesystem::path& world);

  /// The file or folder that a URI means in a file; nullopt if there is none.
  ///
  /// A path (with or without file://) is looked for in the folder of the file that names it and in
  /// the four above; model://NAME/... and package://NAME/... there, in each's models/, likewise
  /// from the world's folder, and in the folders of GAZEBO_MODEL_PATH, GZ_SIM_RESOURCE_PATH and
  /// SDF_PATH; https:// in Fuel's cache (~/.gz/fuel, ~/.ignition/fuel, GZ_FUEL_CACHE_PATH). Never
  /// from the current folder.
  std::optional<std::filesystem::path> find(const std::string& uri,
                                            const std::filesystem::path& file) const;

  /// The SDF file of an include's target: the file itself, or what a model's folder names.
  static std::optional<std::filesystem::path> model_file(const std::filesystem::path& found);

 private:
  std::filesystem::path world_folder_;
};

}  // namespace mh::gazebo
