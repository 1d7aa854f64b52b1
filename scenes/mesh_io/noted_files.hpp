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

/// Gives assimp access to regular files only, the mesh and files it references, and records each
/// (ReadScope).
class NotedFiles : public Assimp::IOSystem {
 public:
  /// @param in_memory  content of files by name, in place of what is stored under it
  /// @param textures   receives what the MTL files state that assimp does not read
  NotedFiles(std::map<std::filesystem::path, std::string> in_memory, MtlTextures& textures)
      : in_memory_(std::move(in_memory)), textures_(textures) {}

  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  /// null if it cannot be read: assimp then reports it, or continues without.
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::map<std::filesystem::path, std::string> in_memory_;
  MtlTextures& textures_;
};

}  // namespace mh
