#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The test Rooms.IncludesFollowTheLinkLines without a build, where `cmake --preset release` was run.
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
rooms=$root/build/release/made/rooms.txt
[[ -f $rooms ]] || exit 0
exec env PYTHONDONTWRITEBYTECODE=1 python3 "$root/tests/rooms/rooms.py" check "$rooms" "$root"
