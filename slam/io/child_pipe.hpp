// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace mh {

struct EndedTooSoon {};
struct TookTooLong {};

/// Writes all of these bytes; exits this process if the reader is gone.
void write_to_parent(int descriptor, const char* data, std::size_t size);

/// The child's end of the pipe to its parent.
class PipeWriter {
 public:
  explicit PipeWriter(int descriptor) : descriptor_(descriptor) {}
  void bytes(const void* data, std::size_t size);
  void flush();

 private:
  int descriptor_;
  std::string waiting_;
};

/// The parent's end. @throws EndedTooSoon, TookTooLong if the requested bytes do not arrive.
class PipeReader {
 public:
  PipeReader(int descriptor, int wall_s);
  void bytes(void* data, std::size_t size);

 private:
  std::size_t some(char* to, std::size_t size);

  int descriptor_;
  std::int64_t deadline_ms_;
  std::string waiting_;
  std::size_t at_ = 0;
};

}  // namespace mh
