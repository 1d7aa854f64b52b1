// SPDX-License-Identifier: Apache-2.0
#include "scenes/guard.hpp"

#include <iterator>
#include <utility>

#include "scenes/scene_fields.hpp"
#include "slam/io/read_record.hpp"

namespace mh {

Scene load_guarded(const std::filesystem::path& file, std::vector<std::string>* warnings,
                   const std::function<Scene(std::vector<std::string>*)>& load,
                   const GuardLimits& limits) {
  if (reads_here()) {
    const ReadingInChild reading(file);
    return load(warnings);
  }
  std::vector<std::string> reported;
  Scene scene;
  std::string read;  // what the child read, sent because its scopes are not seen in this process
  const auto work = [&]() -> std::function<void(PipeWriter&)> {
    const ReadScope scope;
    scene = load(&reported);
    read = encode(scope.record());
    return [&](PipeWriter& out) { scene_fields::Sender{out}(reported, scene, read); };
  };
  const auto receive = [&](PipeReader& in) { scene_fields::Receiver{in}(reported, scene, read); };
  in_child(file, limits, work, receive);
  ReadScope::report(decode_read_record(read));
  if (warnings != nullptr) std::ranges::move(reported, std::back_inserter(*warnings));
  return scene;
}

}  // namespace mh
