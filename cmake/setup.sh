# SPDX-License-Identifier: Apache-2.0
# Sourced by tests/run.sh and bench/run.sh: functions that install, configure and build.
# Sets `root` (the repository) and `build_jobs`; the caller has set -euo pipefail.

root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)

fail() {
  printf "%s: %s\n" "$0" "$1" >&2
  exit "${2:-2}"
}

# Compiling a file that uses much of Eigen takes up to 2 GB: limits the jobs by available memory.
count_build_jobs() {
  local processors memory_gb
  processors=$(nproc)
  memory_gb=$(awk '/^MemAvailable:/ {print int($2 / 1024 / 1024)}' /proc/meminfo 2>/dev/null || true)
  local by_memory=$(( ${memory_gb:-4} / 2 ))
  (( by_memory >= 1 )) || by_memory=1
  echo $(( processors < by_memory ? processors : by_memory ))
}
build_jobs=$(count_build_jobs)

# Prints the packages of packages.txt that are not installed, one per line.
missing_packages() {
  local wanted installed
  wanted=$(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$root/packages.txt")
  # dpkg-query fails if it does not know one of the packages, but still lists the others.
  # shellcheck disable=SC2086
  installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' $wanted 2>/dev/null |
    awk '$2 == "installed" {print $1}' || true)
  grep -vxF -f <(printf '%s\n' "$installed" | sed '/^$/d') <<<"$wanted" || true
}

# Installs the packages of packages.txt that this machine lacks. If none is missing, it does nothing
# and does not need root.
install_packages() {
  local how_to_skip="or install the libraries of packages.txt yourself and pass --no-install"
  command -v apt-get >/dev/null ||
    fail "packages are installed with apt-get, which this machine lacks; use Debian 12, $how_to_skip"
  local missing as_root=()
  missing=$(missing_packages)
  [[ -n $missing ]] || return 0
  if (( $(id -u) != 0 )); then
    command -v sudo >/dev/null ||
      fail "neither root nor sudo to install ${missing//$'\n'/ }: run once as root, $how_to_skip"
    as_root=(sudo)
  fi
  local log=$root/build/install.log
  mkdir -p "$root/build"
  echo "Installing $(wc -l <<<"$missing") packages with apt-get (log: $log) ..."
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C
    apt-get -y -o DPkg::Lock::Timeout=600)
  # Package lists may be usable even if the update fails (a mirror on disk): try to install anyway.
  "${apt[@]}" update </dev/null >"$log" 2>&1 || true
  # shellcheck disable=SC2086
  if ! "${apt[@]}" install --no-install-recommends $missing </dev/null >>"$log" 2>&1; then
    tail -n 25 "$log" >&2
    fail "apt-get failed; its whole output is in $log" 3
  fi
}

# configure PRESET: takes little time if nothing changed. All scripts configure in the same way, so
# that each can use what another one has built.
configure() {
  # ccache needs a writable folder even if HOME is unset or read-only.
  [[ -n ${CCACHE_DIR:-} || -w ${HOME:-/nonexistent} ]] || export CCACHE_DIR=$root/build/ccache
  cmake -S "$root" --preset "$1" --log-level=WARNING
}

# build PRESET [TARGET...]
build() {
  local preset=$1
  shift
  cmake --build "$root/build/$preset" --parallel "$build_jobs" ${1:+--target "$@"}
}
