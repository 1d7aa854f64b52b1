// SPDX-License-Identifier: Apache-2.0
#include "slam/io/last_line.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>

namespace mh {

std::string last_line_of(int file) {
  constexpr off_t kTail = 1 << 16;
  struct stat state {};
  if (fstat(file, &state) != 0) return {};
  std::string text(static_cast<std::size_t>(std::min(state.st_size, kTail)), '\0');
  const ssize_t size =
      pread(file, text.data(), text.size(), state.st_size - std::min(state.st_size, kTail));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  text.resize(text.find_last_not_of(" \t\r\n") + 1);  // npos + 1 is 0
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace mh
