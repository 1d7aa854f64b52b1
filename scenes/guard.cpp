// SPDX-License-Identifier: Apache-2.0
#include "scenes/guard.hpp"

#include <iterator>
#include <utility>

#include "scenes/scene_fields.hpp"

namespace mh {

Scene load_guarded(const std::filesystem::path& file, std::vector<std::string>* warnings,
                   const std::function<Scene(std::vector<std::string>*)>& load,
                   const GuardLimits& limits) {
  if (reads_here()) {
    const ReadingInChild reading(file);
    return load(warnings);
  }
  std::vector<std::string> told;
  Scene scene;
  const auto work = [&]() -> std::function<void(PipeWriter&)> {
    scene = load(&told);
    return [&](PipeWriter& out) { scene_fields::Sender{out}(told, scene); };
  };
  const auto receive = [&](PipeReader& in) { scene_fields::Receiver{in}(told, scene); };
  in_child(file, limits, work, receive);
  if (warnings != nullptr) std::ranges::move(told, std::back_inserter(*warnings));
  return scene;
}

}  // namespace mh
