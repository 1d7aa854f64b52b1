#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# browse.sh PROGRAM BROWSER [SCREENSHOTS]: runs browse.mjs against `modelhouse live`. Exit code 77:
# there is no browser.
set -euo pipefail
here=$(dirname -- "${BASH_SOURCE[0]}")
program=$1 browser=$2
[[ -x /usr/bin/chromium && -d $browser/node_modules ]] || exit 77
said=$(mktemp)
"$program" live "$here/../../../bench/scenarios/room.yaml" --level ideal --port 0 --seed 3 >"$said" &
live=$!
trap 'kill -INT $live 2>/dev/null; wait $live || true; rm -f "$said"' EXIT
for _ in $(seq 600); do
  grep -q http "$said" && break
  sleep 0.1
done
node "$here/browse.mjs" "$browser/node_modules" "$(sed -n 's/^live: //p' "$said")" "${@:3}"
