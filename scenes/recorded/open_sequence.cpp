// SPDX-License-Identifier: Apache-2.0
#include "scenes/recorded/open_sequence.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "scenes/recorded/bonn.hpp"
#include "scenes/recorded/frame_sequence.hpp"
#include "scenes/recorded/icl_nuim.hpp"
#include "scenes/recorded/openloris.hpp"
#include "scenes/recorded/replica.hpp"
#include "scenes/recorded/ros/sequence.hpp"
#include "scenes/recorded/scannet_folder.hpp"
#include "scenes/recorded/seven_scenes.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/read_record.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

// ICL-NUIM and Bonn before TUM, whose lists they have as well.
constexpr std::array kReaders = {&kIclNuimReader,   &kBonnReader,        &kTumReader,
                                 &kScannetReader,   &kSevenScenesReader, &kReplicaReader,
                                 &kOpenlorisReader, &kBagReader,         &kMcapReader};

/// Notes a file's content in the open scopes; a missing file is noted as missing.
void note_content(const fs::path& file) {
  try {
    read_file(file);
  } catch (const InputError&) {  // a frame that cannot be read is skipped, not the recording
  }
}

}  // namespace

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

const SequenceReader& reader_of(const std::string& source) {
  const auto [layout, path] = split_sequence(source);
  for (const SequenceReader* reader : kReaders)
    if (layout.empty() ? reader->recognizes(path) : layout == reader->name) return *reader;
  if (!is_there(path))
    throw InputError(fmt::format("'{}' is not a folder, nor {}", source, sequence_forms()));
  throw InputError(fmt::format("{}: {}; name its layout: {}", path.string(),
                               is_folder(path)
                                   ? "holds neither rgb.txt nor associations.txt nor anything else "
                                     "that tells its layout"
                                   : "is a file of no layout of recordings",
                               sequence_forms()));
}

OpenedRecording open_sequence(const std::string& source, const RecordingConfig& config) {
  const fs::path path = split_sequence(source).second;
  const SequenceReader& reader = reader_of(source);
  if (!config.topics.empty() && !reader.has_topics)
    throw InputError(fmt::format("{}: topics '{}': a recording of layout '{}' has none",
                                 path.string(), config.topics, reader.name));
  if (!ReadScope::is_open()) return reader.open(path, config);
  OpenedRecording opened;
  std::uint64_t all = 0;
  {
    const ReadScope scope(ReadScope::Outer::kIgnores);
    opened = reader.open(path, config);
    std::ranges::for_each(opened.files, note_content);
    all = digest(scope.record());
  }
  ReadScope::report(
      {FileObservation::Kind::kRead, path / fmt::format("{} recording", reader.name), all});
  return opened;
}

}  // namespace mh
