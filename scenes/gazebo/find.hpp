// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mh::gazebo {

/// Resolves the URIs of a world and of the models that it includes.
class Finder {
 public:
  /// @param world  the requested file
  explicit Finder(const std::filesystem::path& world);

  /// Resolves a URI found in a file to a file or folder; nullopt if there is none.
  ///
  /// A path (with or without file://) is searched for in the folder of the file that contains it
  /// and in the four folders above. model://NAME/... and package://NAME/... are searched for in
  /// these folders and the models/ folder of each; in the corresponding folders of the world's
  /// file; and in the folders listed in GAZEBO_MODEL_PATH, GZ_SIM_RESOURCE_PATH and SDF_PATH.
  /// https://... is searched for in Fuel's cache (~/.gz/fuel, ~/.ignition/fuel,
  /// GZ_FUEL_CACHE_PATH). The current folder is never searched. Percent codes are decoded if no
  /// file has the name as written.
  std::optional<std::filesystem::path> find(const std::string& uri,
                                            const std::filesystem::path& file) const;

  /// The SDF file of an include's target: the file itself, or the one that a model's folder
  /// specifies.
  static std::optional<std::filesystem::path> model_file(const std::filesystem::path& found);

 private:
  std::optional<std::filesystem::path> find_named(const std::string& uri,
                                                  const std::filesystem::path& file) const;

  std::filesystem::path world_folder_;
};

}  // namespace mh::gazebo
