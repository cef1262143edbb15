# shellcheck shell=bash disable=SC2034
# Sourced by the scripts: the system packages that screwline needs, and their installation.
# Add a package here and, as a rosdep key, to package.xml.

# To build and to run the demo.
BUILD_PACKAGES=(
  g++ make cmake ccache catkin python3-catkin-pkg python3-setuptools ros-environment ros-message-generation ros-message-runtime
  ros-std-msgs ros-geometry-msgs ros-sensor-msgs ros-trajectory-msgs ros-visualization-msgs ros-diagnostic-msgs ros-tf2-msgs ros-std-srvs
  libstd-msgs-dev libgeometry-msgs-dev libsensor-msgs-dev libtrajectory-msgs-dev libvisualization-msgs-dev libdiagnostic-msgs-dev
  libtf2-msgs-dev libstd-srvs-dev
  libroscpp-dev libroscpp-core-dev librosconsole-dev libtf2-dev libtf2-ros-dev librosbag-storage-dev libtopic-tools-dev
  libeigen3-dev liburdfdom-dev libconsole-bridge-dev libtinyxml2-dev libyaml-cpp-dev libginac-dev
)
RUN_PACKAGES=(
  python3-std-msgs python3-geometry-msgs python3-sensor-msgs python3-trajectory-msgs python3-visualization-msgs python3-std-srvs python3-diagnostic-msgs
  python3-tf2-msgs python3-tf2-ros python3-rospy python3-roslaunch python3-rosbag python3-rosservice python3-rostopic python3-rosnode
  python3-rosparam python3-rosmsg python3-rosgraph python3-yaml python3-numpy python3-matplotlib
  rosbash rospack-tools ros-robot-state-publisher joint-state-publisher
)
LOOK_PACKAGES=(rviz xvfb x11-utils imagemagick libgl1-mesa-dri)
TEST_PACKAGES=(
  libgtest-dev libgmock-dev librostest-dev python3-rostest liborocos-kdl-dev libkdl-parser-dev liburdf-dev catkin-lint
)

# Adds what only some releases have.
release_packages() {
  if [[ $(release) == bookworm ]]; then TEST_PACKAGES+=(clang-format-14); fi
}

# install_packages GROUP...: of `build run look test`. Quick where nothing is missing.
install_packages() {
  if on_noetic; then
    install_by_rosdep
    return
  fi
  release_packages
  local wanted=() group
  for group in "$@"; do
    local -n packages="${group^^}_PACKAGES"
    wanted+=("${packages[@]}")
  done
  local missing
  missing=$(missing_of "${wanted[@]}")
  if [[ -z $missing ]]; then
    say "packages: all ${#wanted[@]} are installed"
    return
  fi
  say "packages: installing $(wc -w <<<"$missing") of ${#wanted[@]}"
  export DEBIAN_FRONTEND=noninteractive
  logged apt-update as_root apt-get -o DPkg::Lock::Timeout=600 update
  # shellcheck disable=SC2086
  logged apt-install as_root apt-get -o DPkg::Lock::Timeout=600 install -y --no-install-recommends $missing
}

# Those of the packages named that are not installed.
missing_of() {
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^installed //p' || true)
  comm -23 <(printf '%s\n' "$@" | sort -u) <(sort -u <<<"$installed") | xargs
}

install_by_rosdep() {
  say "packages: rosdep (Noetic)"
  if [[ -n $(missing_of libginac-dev) ]]; then  # rosdep has no key for GiNaC.
    export DEBIAN_FRONTEND=noninteractive
    logged apt-update as_root apt-get update
    logged apt-install as_root apt-get install -y --no-install-recommends libginac-dev
  fi
  if ! command -v rosdep >/dev/null; then
    export DEBIAN_FRONTEND=noninteractive
    logged apt-update as_root apt-get update
    logged apt-install as_root apt-get install -y --no-install-recommends python3-rosdep g++ make cmake
  fi
  [[ -e /etc/ros/rosdep/sources.list.d/20-default.list ]] || logged rosdep-init as_root rosdep init
  rosdep check --from-paths "$ROOT" --ignore-src --rosdistro noetic >/dev/null 2>&1 && return
  logged rosdep-update rosdep update --rosdistro noetic
  logged rosdep-install rosdep install -y --from-paths "$ROOT" --ignore-src --rosdistro noetic
}
