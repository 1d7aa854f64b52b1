#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# with_live.sh PROGRAM SCRIPT MODULES [ARGUMENT...]: runs `node SCRIPT MODULES/node_modules URL ARGUMENT...` against
# `modelhouse live`. 77: the modules are not installed, or there is no browser.
set -euo pipefail
here=$(dirname -- "${BASH_SOURCE[0]}")
program=$1 script=$2 modules=$3
[[ -x /usr/bin/chromium && -d $modules/node_modules ]] || exit 77
said=$(mktemp)
"$program" live "$here/../../../bench/scenarios/room.yaml" --level ideal --port 0 --seed 3 >"$said" &
live=$!
trap 'kill -INT $live 2>/dev/null; wait $live || true; rm -f "$said"' EXIT
for _ in $(seq 600); do
  grep -q http "$said" && break
  sleep 0.1
done
node "$here/$script" "$modules/node_modules" "$(sed -n 's/^live: //p' "$said")" "${@:4}"
