// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/settings.hpp"

#include <type_traits>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {

namespace fs = std::filesystem;

DetectorSpec detector_from_file(const fs::path& file) {
  DetectorSpec spec;
  const std::string ending = file.extension().string();
  if (ending == ".onnx" || ending == ".weights") {
    spec.network = file;
    if (ending == ".weights") spec.config = fs::path(file).replace_extension(".cfg");
  } else if (ending == ".json" || ending == ".csv" || ending == ".txt" || is_folder(file)) {
    spec.boxes = file;
  } else {
    throw InputError(fmt::format(
        "{}: is neither a network (.onnx, .weights) nor boxes (.json, .csv, .txt, a folder)",
        file.string()));
  }
  return spec;
}

void read_detector(YamlReader& mapping, const fs::path& folder, DetectorSpec& spec) {
  for_each_field(spec, [&](const char* key, auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, fs::path>)
      if (const auto node = mapping.find(key))
        value = (folder / node->as_string()).lexically_normal();
  });
  MappingReader read(mapping);
  fields(spec.settings, read);
  if (spec.network.empty() == spec.boxes.empty())
    mapping.fail(spec.boxes.empty()
                     ? "names neither `network` nor `boxes`"
                     : fmt::format("`network` ({}) and `boxes` ({}) are both given: name only one",
                                   spec.network.string(), spec.boxes.string()));
  if (spec.network.extension() == ".weights" && spec.config.empty())
    spec.config = fs::path(spec.network).replace_extension(".cfg");
}

void load_detector_settings(const fs::path& file, DetectorSpec& spec) {
  YamlReader yaml = YamlReader::load(file);
  read_detector(yaml, file.parent_path(), spec);
  yaml.finish();
}

std::string format_detector_settings(const DetectorSettings& settings, bool notes) {
  SettingsWriter writer(notes);
  fields(settings, writer);
  // A detector's settings file has no sections, so nothing is indented.
  std::string text;
  bool begins = true;
  for (std::size_t i = 0; i < writer.text().size(); ++i) {
    if (begins && writer.text().compare(i, 2, "  ") == 0) i += 2;
    text += writer.text()[i];
    begins = writer.text()[i] == '\n';
  }
  return text;
}

}  // namespace mh
