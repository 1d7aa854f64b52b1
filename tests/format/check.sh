#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails if `clang-format -i` (.clang-format) would change a file, and names the places.
#   tests/format/check.sh FOLDER...
set -euo pipefail
command -v clang-format >/dev/null || { echo "clang-format is not installed (packages.txt)"; exit 77; }
# Many files per process, since a process spends most of its time starting up.
find "$@" -name '*.?pp' -print0 | sort -z |
  xargs -0 -n 100 clang-format --dry-run -Werror --ferror-limit=3
