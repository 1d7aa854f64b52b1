#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Seeds one mistake at a time into a copy of the sources, builds the tests that should notice, runs
# them, and prints which mistake was caught by which test. Needs what tests/run.sh needs.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
root=$(git -C "$here" rev-parse --show-toplevel)

usage() {
  cat <<'TEXT'
Usage: tests/mutations/run.sh [--jobs N] [--table FILE] [NAME...]
  --jobs N      compiler processes (default: as many as processors)
  --table FILE  also writes the table, as Markdown
NAME is a patch of this folder without its ending; none: all of them. The sources are those of the
last commit. MH_BUILD_LOCK=FILE holds that lock while building, MH_MUTATIONS=DIR keeps the copy.
Exit code 1 where a mutation survives, or is not caught before a test runs out of its 600 s.
TEXT
}

jobs=$(nproc)
table=
while (( $# )); do
  case $1 in
    --jobs) jobs=$2; shift ;;
    --table) table=$2; shift ;;
    -h | --help) usage; exit 0 ;;
    -*) usage >&2; exit 2 ;;
    *) break ;;
  esac
  shift
done

names=("$@")
if (( ! ${#names[@]} )); then
  for patch in "$here"/*.patch; do names+=("$(basename "$patch" .patch)"); done
fi
field() { sed -n "s/^$2: //p" "$here/$1.patch" | head -1; }
for name in "${names[@]}"; do
  [[ -f $here/$name.patch ]] || { echo "no mutation '$name' in $here" >&2; exit 2; }
  [[ -n $(field "$name" Mistake) && -n $(field "$name" Tests) ]] ||
    { echo "$name.patch: needs the lines 'Mistake: ...' and 'Tests: ...'" >&2; exit 2; }
done

copy=${MH_MUTATIONS:-}
if [[ -z $copy ]]; then
  copy=$(mktemp -d)
  trap 'git -C "$root" worktree remove --force "$copy/tree" 2>/dev/null; rm -rf "$copy"' EXIT
fi
tree=$copy/tree
[[ -d $tree ]] || git -C "$root" worktree add --quiet --detach "$tree" HEAD
git -C "$tree" checkout --quiet --force --detach "$(git -C "$root" rev-parse HEAD)"
export CCACHE_BASEDIR=$tree CCACHE_NOHASHDIR=1

build() {
  ${MH_BUILD_LOCK:+flock "$MH_BUILD_LOCK"} ninja -C "$tree/build/release" -j "$jobs" "$@" \
    >"$copy/build.log" 2>&1
}
# Runs test executables one after the other; prints the first test that fails, else one that did
# not end in time, or nothing.
first_failure() {
  local test failed status late=
  for test in "$@"; do
    status=0
    (cd "$tree" && timeout 600 "build/release/$test" --gtest_brief=1) >"$copy/test.log" 2>&1 ||
      status=$?
    failed=$(sed -n '/^\[  FAILED  \]/{s/^\[  FAILED  \] \([^ ,]*\).*/\1/p;q;}' "$copy/test.log")
    if [[ -n $failed ]]; then
      echo "$test: $failed"
      return
    elif (( status == 124 )); then
      late=${late:-"**timed out**: $test"}  # slow is not a proof: another one may catch it
    elif (( status != 0 )); then
      echo "$test: crashed"
      return
    fi
  done
  echo "$late"
}

[[ -f $tree/build/release/build.ninja ]] ||
  (cd "$tree" && cmake --preset release >"$copy/configure.log" 2>&1)
mapfile -t every < <(for name in "${names[@]}"; do field "$name" Tests; done | tr ' ' '\n' | sort -u)
echo "building ${every[*]} without a mistake" >&2
build "${every[@]}" || { tail -20 "$copy/build.log" >&2; exit 1; }
failed=$(first_failure "${every[@]}")
[[ -z $failed ]] || { echo "fails without any mistake: $failed" >&2; exit 1; }

survived=0
rows=()
for name in "${names[@]}"; do
  read -ra tests <<<"$(field "$name" Tests)"
  if ! git -C "$tree" apply -C1 "$here/$name.patch"; then
    caught="**the patch does not apply any more**"
    survived=1
  elif ! build "${tests[@]}"; then
    caught="**does not build**"
    tail -20 "$copy/build.log" >&2
    survived=1
  else
    caught=$(first_failure "${tests[@]}")
    if [[ -z $caught ]]; then
      caught="**survived**"
    fi
    [[ $caught != \*\** ]] || survived=1
  fi
  git -C "$tree" checkout --quiet --force .
  rows+=("| $name | $(field "$name" Mistake) | $caught |")
  echo "${rows[-1]}"
done

if [[ -n $table ]]; then
  printf '%s\n' "| mutation | mistake | caught by |" "|---|---|---|" "${rows[@]}" >"$table"
fi
exit $survived
