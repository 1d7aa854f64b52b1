#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Draws small mistakes from a seed, puts them one at a time into a copy of the sources, and records
# which test detects each (tests/mutations/README.md). Needs what tests/run.sh needs, and Python
# 3.9.
#   tests/mutations/sample.sh --count 200 --seed 1
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
exec env PYTHONDONTWRITEBYTECODE=1 python3 "$here/sample.py" "$@"
