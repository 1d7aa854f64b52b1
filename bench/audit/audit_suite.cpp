// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/audit_suite.hpp"

#include <fmt/format.h>

#include "bench/audit/audit.hpp"
#include "bench/suite/cache.hpp"
#include "bench/suite/code_version.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/json_fields.hpp"
#include "bench/suite/run_key.hpp"
#include "bench/systems/timed.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

/// What the runs of a suite share.
struct Shared {
  Cache cache;  ///< of light, maps and audits
  SharedImages images;
};

RunAudit execute(const RunSpec& spec, const std::string& key, const AuditOptions& options,
                 const Shared& shared,
                 const std::function<void(double, std::string_view)>& progress) {
  double run_s = 0;
  SlamState frozen;
  std::optional<World> world;
  const RunResult run = [&] {
    const ProcessorTimer timer(run_s);
    world = build_world(spec, options.threads, shared.cache, options.say, {}, shared.images);
    require_key(spec, world->inputs, key);
    std::string status = "starts";
    return run_with_map(spec, *world,
                        {.progress = [&](double share) { progress(0.5 * share, status); },
                         .status = [&](std::string_view now) { status = now; },
                         .maps = shared.cache},
                        frozen);
  }();
  RunAudit audit =
      audit_run(run, *world, frozen, [&](double share) { progress(0.5 + 0.5 * share, "audit"); });
  require_unchanged(world->held);
  audit.run_s = run_s;
  return audit;
}

/// Key of an audit: it depends on the key of the run and on the code of the audit.
std::string audit_key(const std::string& key_of_run) {
  return text_key(key_of_run + std::string(code_of_audit()));
}

}  // namespace

void require_auditable(const Suite& suite) {
  try {
    for (const RunSpec& spec : expand(suite)) require_auditable(spec);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", suite.file.string(), error.what()));
  }
}

std::vector<AuditedRun> audit_suite(const Suite& suite, const AuditOptions& options) {
  const std::vector<RunSpec> specs = expand(suite);
  require_auditable(suite);
  InputReader inputs(options.say);
  PlannedKeys keys;
  for (const RunSpec& spec : specs)
    keys.emplace_back(spec.name, run_key(spec, inputs.inputs_of(spec)));
  options.planned(keys);
  const TemporaryFolder for_now(std::filesystem::temp_directory_path());
  const Shared shared{
      Cache(options.cache ? *options.cache : for_now.path() / "cache"),
      {for_now.path() / "images", static_cast<std::uint64_t>(1e9 * options.images_limit_gb)}};
  std::vector<AuditedRun> audited;
  for (const RunSpec& spec : specs) {
    const std::string& key = keys[audited.size()].second;
    const auto progress = [&](double share, std::string_view what) {
      options.progress(
          (static_cast<double>(audited.size()) + share) / static_cast<double>(specs.size()),
          fmt::format("{} of {} audited, {}", audited.size(), specs.size(), what));
    };
    // Images are shared only by the runs of one environment at one level. These are consecutive, so
    // the images are deleted when either changes.
    if (!audited.empty() && (audited.back().spec.environment.name != spec.environment.name ||
                             audited.back().spec.level != spec.level))
      std::filesystem::remove_all(shared.images.folder);
    const std::string kept = shared.cache.get("audit", audit_key(key), [&] {
      options.say(fmt::format("run and audit of {}", spec.name));
      return json_of(execute(spec, key, options, shared, progress)).dump();
    });
    audited.push_back({spec, key, {}});
    read_json(nlohmann::ordered_json::parse(kept), audited.back().audit);
  }
  return audited;
}

}  // namespace mh
