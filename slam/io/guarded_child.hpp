// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "slam/io/child_pipe.hpp"

namespace mh {

/// Resources that a file reader may use before it is killed. Large files may use more.
struct GuardLimits {
  int processor_s = 6;              ///< whole seconds, at least 1
  double processor_s_per_mb = 0.5;  ///< additional seconds for each megabyte read
  int wall_s = 600;                 ///< limit for a reader that waits instead
                                    ///< of working
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;  ///< in addition to what this process uses
  std::uint64_t memory_per_byte = 50;  ///< additional bytes of memory for each byte read
  std::size_t stack_bytes = std::size_t{512} << 20;  ///< for deeply nested files
};

/// Runs `work` in a child process, so that its crashes, hangs and output do not affect this one.
/// Inside `work`, and if reads_here(), call the work directly instead.
/// @pre !reads_here()
/// @param file     the file being read; messages name it, or the innermost file of nested calls.
/// @param work     does the work and returns a function that sends its result; runs in the child.
/// @param receive  receives the result; runs here, unless `work` threw. It must consume every byte.
/// @throws InputError as `work` threw it, or naming the file if the child crashed, threw anything
/// else, or reached a limit; MachineError as `work` threw it, or if no child can be started.
void in_child(const std::filesystem::path& file, const GuardLimits& limits,
              const std::function<std::function<void(PipeWriter&)>()>& work,
              const std::function<void(PipeReader&)>& receive);

/// Whether work needs no child: this thread already runs in one, or forking is impossible (thread
/// sanitizer).
bool reads_here();

/// During its lifetime, names the file that a child is reading, for the message in case of a crash.
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
