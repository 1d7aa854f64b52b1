// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/noted_files.hpp"

#include <assimp/MemoryIOWrapper.h>

#include <cstdint>
#include <utility>

#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/held_bytes.hpp"

namespace mh {
namespace {

/// A mapped file as assimp reads it.
class HeldStream : public Assimp::MemoryIOStream {
 public:
  explicit HeldStream(HeldBytes bytes)
      : MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.view.data()), bytes.view.size()),
        bytes_(std::move(bytes)) {}

 private:
  HeldBytes bytes_;
};

}  // namespace

bool NotedFiles::Exists(const char* file) const {
  return is_file(file);
}

Assimp::IOStream* NotedFiles::Open(const char* file, const char*) {
  try {
    return new HeldStream(map_file(file));
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace mh
