# shellcheck shell=bash
# Sourced by the other scripts: where things are, and the build. Nothing is written outside the checkout.
set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$checkout/build
export PATH=/usr/bin:$PATH  # the system's python3 knows catkin; another one first on PATH does not

# Logs, caches and settings of ROS, rviz and the drawing libraries; the way to the screen stays the user's.
export XAUTHORITY=${XAUTHORITY:-$HOME/.Xauthority}
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-$build/home/run}
export HOME=$build/home ROS_HOME=$build/home/.ros ROS_LOG_DIR=$build/home/.ros/log
export XDG_CACHE_HOME=$HOME/.cache XDG_CONFIG_HOME=$HOME/.config XDG_DATA_HOME=$HOME/.local/share

help() {  # the leading comment of the script that was started
  sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
}

load() {  # a setup file of catkin's; those read unset variables
  set +u
  # shellcheck disable=SC1090
  source "$1"
  set -u
}

# Other engines, to compare with.
install_engines() {
  if grep -q '^PRETTY_NAME="Debian GNU/Linux 12' /etc/os-release; then
    "$checkout/scripts/install_dependencies" <(cat <<'END'
libbenchmark-dev    Google Benchmark
libode-dev          Open Dynamics Engine
libbullet-dev       Bullet, its builds of 32 and 64 bits
libmujoco-dev       MuJoCo
libdart-dev         DART
libsimbody-dev      Simbody
pkg-config          their versions
END
    )
  else
    echo "Engines are installed by name on Debian 12 only: here those that are there are compared."
  fi
}

# build TARGET... : installs what is missing, then configures and builds, optimised.
build() {
  "$checkout/scripts/install_dependencies"
  if [[ -f /opt/ros/noetic/setup.bash && ${ROS_DISTRO:-} != noetic ]]; then
    load /opt/ros/noetic/setup.bash
  fi
  mkdir -p "$build/home/run" && chmod 700 "$build/home/run"
  echo "Building in $build"
  # The devel space stands beside: rosrun does not look into folders called build.
  cmake -S "$checkout" -B "$build" -DCMAKE_BUILD_TYPE=Release -DPYTHON_EXECUTABLE=/usr/bin/python3 \
    -DCATKIN_DEVEL_PREFIX="$checkout/devel" -DCMAKE_INSTALL_PREFIX="$checkout/install" \
    -DRIGID_BODY_SIM_BENCHMARKS="${benchmarks:-OFF}" \
    >"$build/configure.log" || { cat "$build/configure.log"; return 1; }
  # catkin reports every message package of ROS at every build: left out.
  cmake --build "$build" --parallel "$(nproc)" --target "$@" | sed -u '/Built target/d'
}
