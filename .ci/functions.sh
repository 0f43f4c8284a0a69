# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by run.sh and test.sh with `root` set to the project's folder: what both need first.

# Installs the packages of a list (debian-packages.txt) that are missing; asks for nothing when none is.
install_packages() {
  local list=${1:-debian-packages.txt} missing=() package sudo=
  while read -r package _; do
    case $package in '' | \#*) continue ;; esac
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
      missing+=("$package")
  done < "$root/$list"
  [ ${#missing[@]} -eq 0 ] && return
  if [ "$(id -u)" -ne 0 ]; then
    sudo=sudo
    if ! command -v sudo > /dev/null; then
      echo "packages are missing, and there is no sudo; as root: apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
  fi
  echo "installing: ${missing[*]}"
  $sudo apt-get update
  $sudo env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"
}

# Configures build/ and builds the targets given (none: all of them). A new build/ is a unity build,
# several sources in one: of a whole build, half the time.
build_project() {
  local unity=()
  [ -e "$root/build/CMakeCache.txt" ] || unity=(-DCMAKE_UNITY_BUILD=ON)
  cmake -S "$root" -B "$root/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "${unity[@]}" > /dev/null
  cmake --build "$root/build" ${1:+--target "$@"}
}

# Runs a program on some ranks; as root, and on fewer cores than ranks.
on_ranks() {
  mpirun --allow-run-as-root --oversubscribe --mca mpi_yield_when_idle 1 -n "$@"
}

# Runs a gtest program with its arguments as two processes that share its tests.
in_two_halves() {
  local half processes=() failed=0
  for half in 0 1; do
    GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX=$half "$@" &
    processes+=($!)
  done
  for half in "${processes[@]}"; do
    wait "$half" || failed=1
  done
  return "$failed"
}
