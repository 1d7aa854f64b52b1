#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds everything and runs every test; ctest's counts come last.
set -euo pipefail
# shellcheck source=cmake/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../cmake/setup.sh"

usage() {
  cat <<'TEXT'
Usage: tests/run.sh [--no-install] [--preset NAME] [CTEST ARGUMENT...]
  --no-install    leave the machine's packages alone (the list is packages.txt)
  --preset NAME   release (default), asan, tsan
Everything else goes to ctest.
Examples:
  tests/run.sh
  tests/run.sh --no-install -R EstimatePose
  tests/run.sh --preset asan -E Scenario
TEXT
}

install=yes
preset=release
while (( $# )); do
  case $1 in
    --no-install) install=no ;;
    --preset) (( $# > 1 )) || fail "--preset needs a name"; preset=$2; shift ;;
    --preset=*) preset=${1#*=} ;;
    -h | --help) usage; exit 0 ;;
    --) shift; break ;;
    *) break ;;
  esac
  shift
done

[[ $install == no ]] || install_packages
configure "$preset"
build "$preset"
# One more job than there are processors, since some tests spend time waiting.
exec ctest --test-dir "$root/build/$preset" --output-on-failure --no-tests=error \
  --parallel "$((build_jobs + 1))" "$@" </dev/null
