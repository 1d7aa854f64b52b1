// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace mh {

/// Gives assimp access to regular files only, the mesh and files it references, and records each
/// (ReadScope).
class NotedFiles : public Assimp::IOSystem {
 public:
  NotedFiles() = default;
  /// @param repaired  replaces the content of that file, which the caller has already read
  NotedFiles(std::filesystem::path file, std::string repaired)
      : file_(std::move(file)), repaired_(std::move(repaired)) {}

  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  /// null if it cannot be read: assimp then reports it, or continues without.
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::filesystem::path file_;
  std::optional<std::string> repaired_;
};

}  // namespace mh
