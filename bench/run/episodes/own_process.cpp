// SPDX-License-Identifier: Apache-2.0
#include "bench/run/episodes/own_process.hpp"

#include <poll.h>
#include <unistd.h>

#include <optional>
#include <utility>
#include <vector>

#include "bench/run/run_process.hpp"
#include "slam/io/error.hpp"

namespace mh {

std::string run_in_own_process(const RunSpec& spec, const EpisodeOptions& options,
                               const std::function<void(double)>& share) {
  constexpr int kMoment_ms = 200;
  std::vector<std::string> arguments = options.arguments;
  arguments.insert(arguments.end(),
                   {"--only-run", spec.name, "--parent", std::to_string(getpid())});
  const std::filesystem::path log = options.out / spec.name / "process.log";
  RunProcess process("/proc/self/exe", arguments, log);
  std::optional<ProcessEnd> end;
  while (!end) {
    ::poll(nullptr, 0, kMoment_ms);
    end = process.poll();
    for (const std::string& stage : process.take_stages()) options.say(stage);
    share(process.share());
  }
  if (end->good || end->reported) std::filesystem::remove(log);
  if (end->good && process.share() == 1) return "";  // a library may end it with code 0, too
  if (!end->reported) return unreported_end(*end, spec.system, process.status());
  if (end->code == kBadInputCode) throw InputError(end->message);
  return end->message;
}

}  // namespace mh
