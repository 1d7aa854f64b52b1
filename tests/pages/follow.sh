#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# follow.sh PAGE BUILD_DIR: runs the ```bash blocks of a page in a fresh clone, line by line as
# printed, in order. A line whose comment gives a time in minutes or hours ("# 15 min") is not run:
# instead, its program's help must list every option that the line uses. Lines that begin with sudo
# are skipped.
set -euo pipefail

root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd -P)
page=$1
build=$(realpath -- "$2")
work=$build/tests/pages/$(basename -- "$page" .md)

if grep -q python_slam "$root/$page" && ! /usr/bin/python3 -c 'import cv2' 2>/dev/null; then
  echo "skipped: python3-opencv is not installed"
  exit 77
fi

# The clone: every file that is or may become part of the repository, and what was built from it.
rm -rf -- "$work"
mkdir -p "$work/clone/build" "$work/home"
if git -C "$root" rev-parse --git-dir >/dev/null 2>&1; then
  git -C "$root" ls-files -z --cached --others --exclude-standard |
    (cd "$root" && while IFS= read -r -d '' file; do [[ ! -e $file ]] || printf '%s\0' "$file"; done) |
    tar -C "$root" --null -T - -c | tar -C "$work/clone" -x
else
  tar -C "$root" --exclude=./build --exclude=./out -c . | tar -C "$work/clone" -x
fi
ln -s "$build" "$work/clone/build/release"

# The page's commands, one per line: blocks are concatenated, and continued lines are joined.
sed -n '/^```bash$/,/^```$/p' "$root/$page" | grep -v '^```' |
  sed -e ':more' -e '/\\$/{N;s/\\\n[[:space:]]*//;b more' -e '}' >"$work/commands"
[[ -s $work/commands ]] || { echo "$page holds no commands"; exit 1; }

is_long() {
  [[ $1 =~ \#.*[0-9][[:space:]](min|h)([^a-z]|$) ]]
}

# parse LINE: the help of the line's program must list the line's options.
parse() {
  local words word help program=()
  read -ra words <<<"${1%%#*}"
  for word in "${words[@]}"; do
    case $word in
      -* | *.yaml | *=* | *\"* | */*.glb) break ;;
    esac
    program+=("$word")
    [[ ${program[0]} == modelhouse && ${#program[@]} -lt 2 ]] || break
  done
  [[ ${program[0]} != tests/run.sh && ${program[0]} != bench/run.sh ]] || program=("bash" "${program[0]}")
  help=$("${program[@]}" --help)
  for word in "${words[@]}"; do
    [[ $word != --?* ]] || grep -q -e "${word%%=*}" <<<"$help" || {
      echo "'$word' is unknown to: ${program[*]} --help"
      return 1
    }
  done
}

cd "$work/clone"
# The house's light is baked once for all tests.
mkdir -p "$build/cache_of_tests/shared"
ln -sfn .. "$build/cache_of_tests/shared/modelhouse"
export HOME=$work/home XDG_CACHE_HOME=$build/cache_of_tests/shared
run=0 parsed=0
while IFS= read -r line; do
  [[ $line =~ ^[[:space:]]*(#.*)?$ || $line == sudo\ * ]] && continue
  if is_long "$line"; then
    echo "~ $line"
    parse "$line"
    parsed=$((parsed + 1))
  else
    echo "+ $line"
    SECONDS=0
    # In this shell, so that cd and export stay in effect for the following lines.
    eval "$line" </dev/null || { echo "failed: $line"; exit 1; }
    echo "  ($SECONDS s)"
    run=$((run + 1))
  fi
done <"$work/commands"
echo "$page: $run lines run, $parsed parsed"
((run > 0))
