// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/messages/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "slam/io/file_errors.hpp"

namespace mh {

OutputFile::OutputFile(std::filesystem::path file)
    : file_(std::move(file)),
      work_(file_.has_parent_path() ? file_.parent_path() : "."),
      unfinished_(work_.path() / file_.filename()),
      descriptor_(open(unfinished_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw_unwritable(file_, errno);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void OutputFile::put(std::uint64_t at, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_unwritable(file_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    at += static_cast<std::uint64_t>(written);
  }
}

void OutputFile::append(std::string_view bytes) {
  put(size_, bytes);
  size_ += bytes.size();
}

void OutputFile::replace(std::uint64_t at, std::string_view bytes) {
  put(at, bytes);
}

void OutputFile::finish() {
  if (close(std::exchange(descriptor_, -1)) != 0) throw_unwritable(file_, errno);
  std::error_code error;
  std::filesystem::rename(unfinished_, file_, error);
  if (error) throw_unwritable(file_, error.value());
}

}  // namespace mh
