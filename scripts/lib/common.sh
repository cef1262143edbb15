# shellcheck shell=bash disable=SC2034
# Sourced by the scripts: where things are, and saying what happens. Expects bash with `set -euo pipefail`.
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
BUILD=${SCREWLINE_BUILD:-$ROOT/build}
LOGS=$BUILD/logs
JOBS=${SCREWLINE_JOBS:-$(nproc)}

# A python3 of the user's own, first on PATH, has none of the ROS modules; a host name may not resolve.
export PATH=/usr/bin:$PATH ROS_HOSTNAME=localhost

say() { printf '[%4d s] %s\n' "$SECONDS" "$*"; }

as_root() {
  if [[ $(id -u) -eq 0 ]]; then "$@"; else sudo --preserve-env=DEBIAN_FRONTEND "$@"; fi
}

on_noetic() { [[ ${ROS_DISTRO:-} == noetic ]]; }

# The release's code name, such as bookworm or focal.
release() { (. /etc/os-release && echo "${VERSION_CODENAME:-unknown}"); }

# logged NAME COMMAND...: its output goes to logs/NAME.log, of which the end is shown on failure.
logged() {
  local name=$1
  shift
  mkdir -p "$LOGS"
  if ! "$@" >"$LOGS/$name.log" 2>&1; then
    say "FAILED: $name; the end of $LOGS/$name.log:"
    grep -v 'Built target' "$LOGS/$name.log" | tail -n 60
    return 1
  fi
}

# source_ros SETUP: a setup.bash of catkin reads variables that may not be set.
source_ros() {
  set +u
  # shellcheck disable=SC1090
  source "$1"
  set -u
}
