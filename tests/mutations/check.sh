#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Every chosen mistake must apply to the sources of today; the patches that do not are named.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
command -v git >/dev/null || { echo "needs git"; exit 77; }
stale=0
for patch in tests/mutations/*.patch; do
  git apply -C1 --check "$patch" && continue
  echo "$patch does not apply: rewrite it against the sources of today"
  stale=1
done
exit $stale
