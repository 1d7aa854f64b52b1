// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "bench/audit/summary.hpp"

namespace mh {

/// Four tables for a terminal: why queries failed, ceilings, retrieval, matches; and the cost.
std::string audit_text(const Suite& suite, std::span<const AuditedRun> runs);

/// The rows over all environments and for each environment, the definitions, and what the audit
/// cost.
nlohmann::ordered_json audit_json(const Suite& suite, std::span<const AuditedRun> runs);

/// One row per query, with the run, the settings and every figure of QueryAudit.
std::string audit_csv(std::span<const AuditedRun> runs);

}  // namespace mh
