// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "slam/core/random.hpp"
#include "tests/bench/cli/hostile_files.hpp"

namespace mh {

std::vector<HostileCase> damaged_files(std::uint64_t seed) {
  const std::string obj =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
  const std::string box = world(
      "<model name=\"m\"><link name=\"l\"><visual name=\"v\"><geometry><box><size>1 1 1</size>"
      "</box></geometry></visual></link></model>");
  const std::string ascii = ply_header("ascii") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::vector<std::pair<std::string, std::string>> sound = {
      {"a.glb", glb(gltf("{\"mesh\":0}"))},
      {"a.gltf", gltf("{\"mesh\":0}")},
      {"a.dae", dae("<node><instance_geometry url=\"#g\"/></node>")},
      {"a.ply", triangle_ply()},
      {"b.ply", ascii},
      {"a.obj", obj},
      {"a.world", box}};
  constexpr std::uint64_t kCopies = 3;
  std::vector<HostileCase> cases;
  for (std::size_t k = 0; k < sound.size(); ++k)
    for (std::uint64_t copy = 0; copy < kCopies; ++copy) {
      const RandomStream draw = RandomStream(seed).fork(k).fork(copy);
      std::string bytes = sound[k].second;
      for (std::uint64_t i = 0; i < 1 + 4 * copy; ++i)
        bytes[draw.below(2 * i, bytes.size())] = static_cast<char>(draw.below(2 * i + 1, 256));
      const std::string& file = sound[k].first;
      cases.push_back({fmt::format("damaged_{}_{}_{}", file.substr(2), file[0], copy),
                       {{file, bytes}, {"a.mtl", "newmtl m\nKd 1 0 0\n"}},
                       "scene info {}/" + file,
                       ""});
      cases.back().passes = true;  // passing or failing is fine; it only has to end cleanly
    }
  return cases;
}

}  // namespace mh
