// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/noted_files.hpp"

#include <assimp/MemoryIOWrapper.h>

#include <cstdint>
#include <optional>
#include <utility>

#include "scenes/mesh_io/obj_text.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/held_bytes.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

/// A mapped file as assimp reads it.
class HeldStream : public Assimp::MemoryIOStream {
 public:
  HeldStream(HeldBytes bytes, std::string_view part)
      : MemoryIOStream(reinterpret_cast<const std::uint8_t*>(part.data()), part.size()),
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
    const auto known = in_memory_.find(file);
    HeldBytes bytes = known != in_memory_.end() ? hold(known->second) : map_file(file);
    const std::string_view name = file;
    const bool stumbles = name.ends_with(".obj") || name.ends_with(".mtl");  // assimp, on a BOM
    std::string_view part = stumbles ? without_mark(bytes.view, file) : bytes.view;
    if (auto repaired = stumbles ? repaired_obj(part) : std::nullopt) {
      bytes = hold(std::move(*repaired));
      part = bytes.view;
    }
    if (auto plain =
            name.ends_with(".mtl") ? without_options(part, file, textures_) : std::nullopt) {
      bytes = hold(std::move(*plain));
      part = bytes.view;
    }
    return new HeldStream(std::move(bytes), part);
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace mh
