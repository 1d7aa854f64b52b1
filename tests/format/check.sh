#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Fails at files that `clang-format -i` (.clang-format) would change, and names the places.
#   tests/format/check.sh FOLDER...
set -euo pipefail
command -v clang-format >/dev/null || { echo "clang-format is not installed (packages.txt)"; exit 77; }
# Many files to a process: a process spends most of its time on starting.
find "$@" -name '*.?pp' -print0 | sort -z |
  xargs -0 -n 100 clang-format --dry-run -Werror --ferror-limit=3
