// SPDX-License-Identifier: Apache-2.0
#include "scenes/placed_scene_file.hpp"

#include "tests/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(mh::bytes_of(data, size));
  mh::try_input(
      [&] { mh::read_placed_scene(mh::YamlReader::parse(text, "fuzz.yaml"), "folder", "name"); });
  mh::try_input([&] { mh::read_label_rules(mh::YamlReader::parse(text, "fuzz.yaml")); });
  return 0;
}
