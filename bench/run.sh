#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The main job: installs missing packages, builds `modelhouse` and compares semantic with plain SLAM
# in the model house.
set -euo pipefail
# shellcheck source=cmake/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../cmake/setup.sh"

usage() {
  cat <<'TEXT'
Usage: bench/run.sh [--no-install] [--suite FILE] [--out DIR] [--jobs N] [--trials N] [-- EXTRA...]
  --no-install   leave the machine's packages alone (the list is packages.txt)
  --suite FILE   what to run (default: bench/suites/model_house.yaml)
  --out DIR      where results go (default: out/ and the suite's name)
  --jobs N       runs side by side (default: 2); results do not depend on it
  --trials N     repeats with seeds 0 .. N-1 (default: the suite's; the full protocol takes 10)
Everything after -- goes to `modelhouse bench`.
Examples:
  bench/run.sh
  bench/run.sh --trials 10 --jobs 8
TEXT
}

install=yes
suite=$root/bench/suites/model_house.yaml
out=
jobs=2
trials=()
extra=()
while (( $# )); do
  case $1 in
    --suite | --out | --jobs | --trials) (( $# > 1 )) || fail "$1 needs a value" ;;
  esac
  case $1 in
    --no-install) install=no ;;
    --suite) suite=$(realpath -m -- "$2"); shift ;;
    --out) out=$(realpath -m -- "$2"); shift ;;
    --jobs) jobs=$2; shift ;;
    --trials) trials=(--trials "$2"); shift ;;
    -h | --help) usage; exit 0 ;;
    --) shift; extra=("$@"); break ;;
    *) fail "unknown argument: $1 (try --help)" ;;
  esac
  shift
done
# Checked before twenty minutes of work rather than after.
[[ -f $suite ]] || fail "no such suite: $suite"
out=${out:-$root/out/$(basename -- "$suite" .yaml)}

[[ $install == no ]] || install_packages
configure release
build release modelhouse
cd "$root"
status=0
build/release/modelhouse bench "$suite" --jobs "$jobs" --out "$out" "${trials[@]}" "${extra[@]}" ||
  status=$?
# After a failure, the existing images are from an earlier run.
if (( status == 0 )); then
  echo
  echo "Images:"
  find "$out" -name '*.png' | LC_ALL=C sort | sed 's/^/  /'
fi
if [[ -f $out/results.sqlite ]]; then
  build/release/modelhouse report "$out" --out "$out/report"
fi
exit "$status"
