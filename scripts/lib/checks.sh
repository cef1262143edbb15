# shellcheck shell=bash
# Sourced by scripts/test: what CI checks besides the tests. Each check_* function fails by its exit status and says why.

check_format() {
  find "$ROOT" -path "$ROOT/build*" -prune -o \( -name '*.h' -o -name '*.cpp' \) -print0 | xargs -0 clang-format-14 --dry-run -Werror
}

# Left out, as no findings: a clone may have any name, Eigen's path is exported by catkin_package(DEPENDS), generated headers lie in the
# devel space, scripts/ holds commands of the sources too, benchmark/ has an option of its own; and that urdfdom's key is liburdfdom-dev, which needs a rosdep database.
check_catkin_lint() {
  local findings id ignored=()
  for id in package_path_name external_interface_path external_directory uninstalled_script unguarded_test_depend; do ignored+=(--ignore "$id"); done
  findings=$(catkin_lint --offline --quiet -W1 "${ignored[@]}" "$ROOT" 2>&1 |
    grep -v -e "missing build_depend on 'urdfdom'" -e 'rosdep database' -e 'unknown dependencies will be ignored') || true
  [[ -z $findings ]] || { echo "$findings"; return 1; }
}

check_style() { "$ROOT/scripts/check_style" "$ROOT"; }

check_shell_syntax() {
  local script
  for script in "$ROOT"/scripts/{demo,test,fresh} "$ROOT"/scripts/lib/*.sh "$ROOT/.ci/run"; do
    bash -n "$script" || return 1
  done
}

# The core alone builds without catkin, and reads no header of ROS on the way. With the options of the main build: most objects are in the cache.
check_core_without_ros() {
  local directory=$BUILD/core_only cache=()
  mapfile -t cache < <(cached_as "$directory/src/CMakeFiles" "$BUILD/src/CMakeFiles")
  configure "$directory" "${cache[@]}" -DSCREWLINE_CORE_ONLY=ON -DSCREWLINE_WERROR=ON -DCMAKE_BUILD_TYPE=Release || return 1
  build "$directory" all || return 1
  local read
  read=$(find "$directory" \( -name '*.d' -o -name depend.make \) -exec cat {} + | tr ' ' '\n' |
    grep -E '/(ros|roscpp\w*|rosbag|tf2\w*|\w+_msgs|std_srvs|urdf|message_runtime|xmlrpcpp)/[^/]+\.h(pp)?$|/screwline/([A-Z]\w*\.h|ros/)' | sort -u) || true
  [[ -z $read ]] || { echo "the core reads:"; echo "$read"; return 1; }
}

# The file loads with its defaults, and what it names is there.
check_launch() { (source_ros "$BUILD/devel/setup.bash" && roslaunch_check "$1"); }

roslaunch_check() {
  local checker
  for checker in /usr/share/roslaunch/scripts/roslaunch-check "/opt/ros/${ROS_DISTRO:-}/share/roslaunch/scripts/roslaunch-check"; do
    [[ -e $checker ]] && { /usr/bin/python3 "$checker" -t -i -o "$LOGS/roslaunch_check.xml" "$1"; return; }
  done
  echo "no roslaunch-check here"
  return 1
}

# What `make install` leaves is enough to ask ROS about the package and to start its nodes and launch files.
check_install_space() {
  rm -rf "$INSTALL"
  cmake --build "$BUILD" --target install || return 1
  (source_ros "$INSTALL/setup.bash" && "$ROOT/scripts/lib/try_install" "$INSTALL" && check_installed_launch)
}

check_installed_launch() {
  local launch
  for launch in "$INSTALL"/share/screwline/launch/*.launch; do
    roslaunch_check "$launch" || return 1
  done
}

# A user's workspace (hidden, as the install space is): the sources linked into src/, `catkin_make install`. With the options and, as they are the
# same, the generated headers of the main build, so that the objects are in the cache.
check_catkin_make() {
  local status=0
  build_workspace || status=$?
  # A link to the package inside of it is a loop for rosrun's search.
  rm -f "$BUILD/.workspace/src/screwline"
  return "$status"
}

build_workspace() {
  local workspace=$BUILD/.workspace cache=()
  mapfile -t cache < <(cached_as "$workspace/src/screwline" "$ROOT" "$workspace/devel/include" "$BUILD/devel/include" "$workspace/build/screwline/src/CMakeFiles" "$BUILD/src/CMakeFiles")
  rm -rf "$workspace/install"
  mkdir -p "$workspace/src"
  ln -sfn "$ROOT" "$workspace/src/screwline"
  (cd "$workspace" && catkin_make install -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCATKIN_ENABLE_TESTING=OFF -DCMAKE_BUILD_TYPE=Release \
    "${cache[@]}" -DSCREWLINE_WERROR=ON -j "$JOBS") || return 1
  diff -r "$workspace/devel/include" "$BUILD/devel/include" || return 1
  (source_ros "$workspace/install/setup.bash" && "$ROOT/scripts/lib/try_install" "$workspace/install")
}

# The commands of README.md do what it says.
check_readme() { (source_ros "$BUILD/devel/setup.bash" && "$ROOT/test/readme_snippets"); }
