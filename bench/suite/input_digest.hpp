// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "slam/core/digest.hpp"
#include "slam/io/fields.hpp"

namespace mh {

/// A file that was read, with the xxh3-64 of its content.
struct FileDigest {
  std::string file;  ///< relative to the folder of the file that named it
  std::uint64_t digest = 0;
  friend auto operator<=>(const FileDigest&, const FileDigest&) = default;
};

template <MaybeConst<FileDigest> F, class Visit>
void fields(F& file_digest, Visit& v) {
  auto& [file, digest] = file_digest;
  v("file", file);
  v("digest", as_digest(digest));
}

/// Something that the results depend on.
struct InputDigest {
  /// scene, robot, mapping_tour, query_tour, vocabulary, level; "SYSTEM: WORD" for a file or a
  /// variable that an outside program's command names.
  std::string name;
  /// Digest of everything that was read for it, and of what was looked for but not found
  /// (bench/suite/inputs.hpp).
  std::uint64_t digest = 0;
  std::vector<FileDigest> files = {};  ///< files that were read, sorted, without duplicates
  friend bool operator==(const InputDigest&, const InputDigest&) = default;
};

template <MaybeConst<InputDigest> I, class Visit>
void fields(I& input, Visit& v) {
  auto& [name, digest, files] = input;
  v("name", name);
  v("digest", as_digest(digest));
  v("files", files);
}

}  // namespace mh
