// SPDX-License-Identifier: Apache-2.0
#include "slam/io/read_record.hpp"

#include <sys/stat.h>
#include <xxhash.h>

#include <cstring>

#include <fmt/format.h>

#include "slam/io/bytes_read.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

void append_bytes(std::string& out, std::uint64_t value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_bytes(std::string& out, std::string_view text) {
  append_bytes(out, std::uint64_t{text.size()});
  out += text;
}

/// Takes values from the front of a byte string.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : rest_(bytes) {}

  std::uint64_t number() {
    const std::string_view bytes = take(sizeof(std::uint64_t));
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  std::string_view text() { return take(number()); }
  bool is_done() const { return rest_.empty(); }

 private:
  std::string_view take(std::uint64_t size) {
    if (size > rest_.size()) throw InputError("record of what was read: is truncated");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  std::string_view rest_;
};

}  // namespace

FileState state_of(const std::filesystem::path& file) {
  struct stat found {};
  if (stat(file.c_str(), &found) != 0) return {};
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return {found.st_dev, found.st_ino, static_cast<std::uint64_t>(found.st_size),
          found.st_ctim.tv_sec * kSecond_ns + found.st_ctim.tv_nsec};
}

void ReadRecord::append(const ReadRecord& more) {
  observations.insert(observations.end(), more.observations.begin(), more.observations.end());
}

std::uint64_t digest(const ReadRecord& record) {
  std::string bytes;
  for (const FileObservation& o : record.observations) {
    if (o.kind == FileObservation::Kind::kHeld) continue;
    append_bytes(bytes, static_cast<std::uint64_t>(o.kind));
    // A folder may be referred to by another name, or ".".
    append_bytes(bytes, o.kind == FileObservation::Kind::kFolder ? "" : o.path.filename().string());
    append_bytes(bytes, o.digest);
  }
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::string encode(const ReadRecord& record) {
  std::string bytes;
  for (const FileObservation& o : record.observations) {
    append_bytes(bytes, static_cast<std::uint64_t>(o.kind));
    append_bytes(bytes, o.path.native());
    append_bytes(bytes, o.digest);
    for (const std::uint64_t part : {o.state.device, o.state.inode, o.state.bytes,
                                     static_cast<std::uint64_t>(o.state.changed_ns)})
      append_bytes(bytes, part);
  }
  return bytes;
}

ReadRecord decode_read_record(std::string_view bytes) {
  ReadRecord record;
  for (Taker taker(bytes); !taker.is_done();) {
    const std::uint64_t kind = taker.number();
    if (kind > static_cast<std::uint64_t>(FileObservation::Kind::kHeld))
      throw InputError("record of what was read: has an unknown kind of observation");
    FileObservation o{.kind = static_cast<FileObservation::Kind>(kind), .path = taker.text()};
    o.digest = taker.number();
    o.state.device = taker.number();
    o.state.inode = taker.number();
    o.state.bytes = taker.number();
    o.state.changed_ns = static_cast<std::int64_t>(taker.number());
    record.observations.push_back(std::move(o));
  }
  return record;
}

bool is_of_a_state(const FileObservation& o) {
  using enum FileObservation::Kind;
  return o.kind == kRead || o.kind == kHeld || o.kind == kAbsent;
}

void require_unchanged(const ReadRecord& record) {
  for (const FileObservation& o : record.observations)
    if (is_of_a_state(o) && state_of(o.path) != o.state)
      throw InputChanged(fmt::format("{}: was changed while it was in use: start the command again",
                                     o.path.string()));
}

thread_local ReadScope* ReadScope::innermost_ = nullptr;

ReadScope::ReadScope(Outer outer) : outer_(innermost_), tells_outer_(outer == Outer::kRecords) {
  innermost_ = this;
}

ReadScope::~ReadScope() {
  innermost_ = outer_;
}

void ReadScope::report(const FileObservation& observation) {
  for (ReadScope* scope = innermost_; scope != nullptr; scope = scope->outer_) {
    scope->record_.observations.push_back(observation);
    if (!scope->tells_outer_) return;
  }
}

void ReadScope::report(const ReadRecord& record) {
  for (const FileObservation& observation : record.observations) report(observation);
}

void report_read(const std::filesystem::path& file, std::string_view content,
                 const FileState& before) {
  g_bytes_read += content.size();
  if (ReadScope::is_open())
    ReadScope::report(
        {FileObservation::Kind::kRead, file, XXH3_64bits(content.data(), content.size()), before});
}

void report_absent(const std::filesystem::path& file) {
  if (ReadScope::is_open())
    ReadScope::report({FileObservation::Kind::kAbsent, file, 0, state_of(file)});
}

}  // namespace mh
