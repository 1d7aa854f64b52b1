#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails at files that `clang-format -i` (.clang-format) would change, and names them.
#   tests/format/check.sh FOLDER...
set -euo pipefail
command -v clang-format >/dev/null || { echo "clang-format is not installed (packages.txt)"; exit 77; }
status=0
while IFS= read -r -d '' file; do
  clang-format "$file" | cmp -s - "$file" || { echo "$file: clang-format -i changes it"; status=1; }
done < <(find "$@" -name '*.?pp' -print0 | sort -z)
exit $status
