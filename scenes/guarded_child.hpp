// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "scenes/child_pipe.hpp"

namespace mh {

/// What a reader of files may use before it is ended. Large files may take more.
struct GuardLimits {
  int processor_s = 6;                                  ///< whole seconds, at least 1
  double processor_s_per_mb = 0.5;                      ///< more for each megabyte that it has read
  int wall_s = 600;                                     ///< for one that waits instead of working
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;  ///< on top of what this process has
  std::uint64_t memory_per_byte = 50;                   ///< more for each byte that it has read
  std::size_t stack_bytes = std::size_t{512} << 20;     ///< for files that are nested deeply
};

/// Runs `work` in a child process, so that neither a crash nor a hang of it nor what it prints
/// touches this one. Within `work`, and where reads_here(), do the work without it.
/// @pre !reads_here()
/// @param file     what is read; messages name it, or the innermost file of the calls within.
/// @param work     does the work and returns what sends its result; runs in the child.
/// @param receive  takes the result; runs here, and not if `work` threw. It must take every byte.
/// @throws InputError as `work` threw it, or naming the file if the child crashed, threw anything
/// else, or reached a limit; MachineError as `work` threw it, or if no child can be started.
void in_child(const std::filesystem::path& file, const GuardLimits& limits,
              const std::function<std::function<void(PipeWriter&)>()>& work,
              const std::function<void(PipeReader&)>& receive);

/// Whether work needs no child: this thread runs in one, or there can be none (thread sanitizer).
bool reads_here();

/// Names the file that a child reads while it lives, for the message should it crash.
class ReadingInChild {
 public:
  explicit ReadingInChild(const std::filesystem::path& file);
  ~ReadingInChild();
  ReadingInChild(const ReadingInChild&) = delete;
  ReadingInChild& operator=(const ReadingInChild&) = delete;

 private:
  std::string outer_;
};

}  // namespace mh
