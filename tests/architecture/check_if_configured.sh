#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Runs the test Architecture.IncludesFollowTheLinkLines without building. Does nothing unless
# `cmake --preset release` was run.
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
targets=$root/build/release/made/targets.txt
[[ -f $targets ]] || exit 0
exec env PYTHONDONTWRITEBYTECODE=1 python3 "$root/tests/architecture/links.py" check "$targets" "$root"
