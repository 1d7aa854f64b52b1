// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

namespace mh {

/// Gives assimp regular files alone, the mesh and what it names, and notes each (ReadScope).
class NotedFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  /// null if it cannot be read: assimp then tells, or goes without.
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override { delete stream; }
};

}  // namespace mh
