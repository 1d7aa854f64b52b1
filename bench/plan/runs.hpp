// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/plan/suite.hpp"

namespace mh {

/// One run of a suite: a system maps the tour once and answers the queries.
struct RunSpec {
  SystemKind system = SystemKind::kSemantic;
  LabelMode labels = LabelMode::kNone;
  std::size_t level = 0;  ///< index into Suite::levels
  int trial = 0;
  std::string name;  ///< unique in the suite, fit for a folder: "semantic-exact-pepper-0"
};

/// Every run, ordered by level, trial, system, labels. The plain system never looks at labels (a
/// law with its own test), so it runs once and stands beside each kind of label.
std::vector<RunSpec> expand(const Suite& suite);

}  // namespace mh
