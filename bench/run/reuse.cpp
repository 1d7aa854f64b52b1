// SPDX-License-Identifier: Apache-2.0
#include "bench/run/reuse.hpp"

#include "bench/report/write.hpp"

namespace mh {

bool is_reused(const Store& store, const Job& job, const std::filesystem::path& out,
               const Reuse& reuse) {
  const auto status = store.status(job.key);
  return status && (reuse.failures || *status == RunStatus::kDone) &&
         !(reuse.files && shows_another_run(out / job.spec.name, job.key));
}

}  // namespace mh
