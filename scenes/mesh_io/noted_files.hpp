// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "scenes/mesh_io/mtl_textures.hpp"

namespace mh {

/// Gives assimp access only to regular files (the mesh and the files that it references), and
/// records each of them (ReadScope).
class NotedFiles : public Assimp::IOSystem {
 public:
  /// @param in_memory  content of files by name, which replaces the stored files
  /// @param textures   receives what the MTL files state but assimp does not read
  NotedFiles(std::map<std::filesystem::path, std::string> in_memory, MtlTextures& textures)
      : in_memory_(std::move(in_memory)), textures_(textures) {}

  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  /// null if the file cannot be read: assimp then reports that, or continues without it.
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::map<std::filesystem::path, std::string> in_memory_;
  MtlTextures& textures_;
};

}  // namespace mh
