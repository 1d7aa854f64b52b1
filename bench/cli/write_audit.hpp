// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/audit/audit_suite.hpp"

namespace mh::cli {

/// Names of the files that write_audit() leaves in a folder.
std::vector<std::string> names_of_audit();

/// What was written: the tables and audit.json.
struct WrittenAudit {
  std::string text, json;
};

/// Audits a suite and writes the files into a folder.
/// @param cache  as in AuditOptions
/// @throws InputError before any work if the folder holds results of other runs.
WrittenAudit write_audit(const std::filesystem::path& out, const Suite& suite,
                         const std::optional<std::filesystem::path>& cache);

/// Removes an audit of other runs from a folder of results, and says so on standard error.
void forget_other_audit(const std::filesystem::path& out);

}  // namespace mh::cli
