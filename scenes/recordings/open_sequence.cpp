// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/open_sequence.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

#include "scenes/recordings/bonn.hpp"
#include "scenes/recordings/frame_sequence.hpp"
#include "scenes/recordings/icl_nuim.hpp"
#include "scenes/recordings/openloris.hpp"
#include "scenes/recordings/replica.hpp"
#include "scenes/recordings/ros/sequence.hpp"
#include "scenes/recordings/scannet_folder.hpp"
#include "scenes/recordings/seven_scenes.hpp"
#include "slam/core/interpolate.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/printable.hpp"
#include "slam/io/read_record.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

// ICL-NUIM and Bonn come before TUM because they have TUM's lists as well.
constexpr std::array kReaders = {&kIclNuimReader,   &kBonnReader,        &kTumReader,
                                 &kScannetReader,   &kSevenScenesReader, &kReplicaReader,
                                 &kOpenlorisReader, &kBagReader,         &kMcapReader};

/// Records a file's content in the open ReadScopes; a missing file is recorded as missing.
void note_content(const fs::path& file) {
  try {
    read_file(file);
  } catch (const InputError&) {  // only the frame that cannot be read is skipped
  }
}

/// Digests of the contents of those files that were read, sorted, without duplicates.
std::vector<std::uint64_t> digests_of(const std::vector<fs::path>& files, const ReadRecord& read) {
  std::map<fs::path, std::uint64_t> digest_of;
  for (const FileObservation& o : read.observations)
    if (o.kind == FileObservation::Kind::kRead) digest_of[o.path] = o.digest;
  std::set<std::uint64_t> digests;
  for (const fs::path& file : files)
    if (const auto found = digest_of.find(file); found != digest_of.end())
      digests.insert(found->second);
  return {digests.begin(), digests.end()};
}

}  // namespace

std::string truth_of_another_time(const Sequence& frames, const Trajectory& truth) {
  if (truth.empty()) return "";
  Stamp first_ns = std::numeric_limits<Stamp>::max(), last_ns = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Stamp stamp_ns = frames.stamp_ns(i);
    if (interpolated_pose(truth, stamp_ns, kMaxTruthGap_ns)) return "";
    first_ns = std::min(first_ns, stamp_ns);
    last_ns = std::max(last_ns, stamp_ns);
  }
  return fmt::format(
      "no frame has a true pose at its time, so nothing is scored: frames are from {} s to {} "
      "s, true poses from {} s to {} s",
      format_stamp(first_ns), format_stamp(last_ns), format_stamp(truth.front().stamp_ns),
      format_stamp(truth.back().stamp_ns));
}

std::span<const SequenceReader* const> sequence_readers() {
  return kReaders;
}

std::string sequence_forms() {
  std::string forms;
  for (const SequenceReader* reader : kReaders)
    forms += fmt::format("{}{}:{}", forms.empty() ? "" : ", ", reader->name, reader->place);
  return forms;
}

std::pair<std::string, fs::path> split_sequence(const std::string& source) {
  for (const SequenceReader* reader : kReaders)
    if (const std::string mark = std::string(reader->name) + ":"; source.starts_with(mark))
      return {reader->name, source.substr(mark.size())};
  return {"", source};
}

std::string join_sequence(const std::string& layout, const fs::path& path) {
  return layout.empty() ? path.string() : layout + ":" + path.string();
}

std::string without_place(const std::string& message, const std::string& source) {
  const fs::path path = without_trailing_slash(split_sequence(source).second);
  const std::string place = printable(path.string());  // as in messages
  if (place.empty()) return message;
  for (const char* end : {"/", ": "})
    if (const std::string mark = place + end; message.starts_with(mark))
      return message.substr(mark.size());
  return message;
}

const SequenceReader& reader_of(const std::string& source) {
  const auto [layout, path] = split_sequence(source);
  require_open(path);
  for (const SequenceReader* reader : kReaders) {
    if (layout.empty() ? !reader->recognizes(path) : layout != reader->name) continue;
    if (layout.empty() && reader == &kBagReader && kMcapReader.recognizes(path))
      throw InputError(fmt::format(
          "{}: holds bags and MCAP files: name one of them, or bag:FOLDER or mcap:FOLDER",
          path.string()));
    return *reader;
  }
  if (!is_there(path))
    throw InputError(fmt::format("'{}' does not exist; a recording is a folder, or {}", source,
                                 sequence_forms()));
  if (is_folder(path) ? !list_folder(path, "*.db3").empty() : path.extension() == ".db3")
    throw InputError(fmt::format(
        "{}: is a ROS 2 bag in SQLite: `ros2 bag convert` makes an MCAP file of it, which is read",
        path.string()));
  throw InputError(fmt::format("{}: {}; name its layout: {}", path.string(),
                               is_folder(path)
                                   ? "holds neither rgb.txt nor associations.txt nor anything else "
                                     "that tells its layout"
                                   : "is not a file of any recording layout",
                               sequence_forms()));
}

OpenedRecording open_sequence(const std::string& source, const RecordingConfig& config) {
  const fs::path path = split_sequence(source).second;
  const SequenceReader& reader = reader_of(source);
  if (!config.topics.empty() && !reader.has_topics)
    throw InputError(fmt::format("{}: topics '{}': a recording of layout '{}' has no topics",
                                 path.string(), config.topics, reader.name));
  const auto open = [&] {
    OpenedRecording opened = reader.open(path, config);
    if (const Trajectory* truth = opened.sequence->truth())
      if (const std::string note = truth_of_another_time(*opened.sequence, *truth); !note.empty())
        opened.notes.push_back(fmt::format("{}: {}", path.string(), note));
    for (std::string& note : opened.notes) note = printable(std::move(note));  // they quote files
    return opened;
  };
  if (!config.whole) return open();
  OpenedRecording opened;
  ReadRecord held;
  std::uint64_t all = 0;
  {
    const ReadScope scope(ReadScope::Outer::kIgnores);
    opened = open();
    std::ranges::for_each(opened.files, note_content);
    all = digest(scope.record());
    opened.image_digests = digests_of(opened.images, scope.record());
    held = scope.record();
  }
  ReadScope::report(
      {FileObservation::Kind::kRead, path / fmt::format("{} recording", reader.name), all});
  for (FileObservation& file : held.observations) {
    if (!is_of_a_state(file)) continue;
    file.kind = FileObservation::Kind::kHeld;
    ReadScope::report(file);
  }
  return opened;
}

}  // namespace mh
