// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/audit/summary.hpp"
#include "bench/run/run_suite.hpp"

namespace mh {

struct AuditOptions {
  /// Folder that keeps baked light, finished maps and finished audits; nullopt: nothing is kept.
  std::optional<std::filesystem::path> cache;
  int threads = 1;  ///< for baking light
  /// Disk space for the images of one environment, which its runs share.
  double images_limit_gb = BenchOptions{}.images_limit_gb;
  /// Receives names and keys of all runs before any work; may throw.
  std::function<void(const PlannedKeys&)> planned = [](const auto&) {};
  std::function<void(std::string_view)> say = [](std::string_view) {};
  /// Receives the share of the work done, and the current step.
  std::function<void(double, std::string_view)> progress = [](double, std::string_view) {};
};

/// @throws InputError naming the suite's file and the run that cannot be audited
/// (bench/audit/audit.hpp).
void require_auditable(const Suite& suite);

/// Executes the runs of a suite one after the other and audits each. An audit that is in the cache
/// is not repeated.
/// @throws InputError before any work if a run cannot be audited; InputChanged if what a run reads
/// changes meanwhile.
std::vector<AuditedRun> audit_suite(const Suite& suite, const AuditOptions& options);

}  // namespace mh
