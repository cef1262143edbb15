# shellcheck shell=bash
# Sourced by the scripts: configuring and building.

# Hidden: roslaunch looks for files in all folders of a package but hidden ones, and would find each of them twice.
INSTALL=$BUILD/.install

# What one build folder has compiled, another one need not. The cache is the build folder's own, whatever the user's settings are.
export CCACHE_DIR=$BUILD/.ccache CCACHE_CONFIGPATH=$BUILD/.ccache/ccache.conf CCACHE_SLOPPINESS=pch_defines,time_macros

# cached_as LINK TARGET...: options for a build of the same sources with the same options elsewhere: what is read through a LINK is known to the cache
# as what the main build has compiled in TARGET.
cached_as() {
  command -v ccache >/dev/null || return 0
  local links
  links=$(printf '%s;' "$@")
  echo "-DCMAKE_CXX_COMPILER_LAUNCHER=$ROOT/scripts/lib/through_link;$links--;ccache"
}

# configure DIRECTORY OPTION...: with warnings as errors where the tests are run so anyway; what the demo has compiled, they need not.
configure() {
  local directory=$1
  shift
  [[ $(release) =~ ^(bullseye|bookworm|trixie)$ ]] && set -- -DSCREWLINE_WERROR=ON "$@"
  command -v ccache >/dev/null && set -- -DCMAKE_CXX_COMPILER_LAUNCHER=ccache "$@"
  cmake -S "$ROOT" -B "$directory" -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_INSTALL_PREFIX="$INSTALL" "$@"
}

# build DIRECTORY TARGET...: with all cores, past the first error.
build() {
  local directory=$1
  shift
  make --no-print-directory -C "$directory" -k -j "$JOBS" "$@"
}

# One run at a time in a build folder.
lock_build() {
  mkdir -p "$BUILD" "$LOGS"
  exec 9>"$BUILD/.lock"
  flock --nonblock 9 || { say "waiting for another run in $BUILD"; flock 9; }
}
