#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tests/install/packages.sh [BUILD]   builds the four Debian packages, installs them in a fresh chroot of bookworm and
# runs the command, its pages, LIGGGHTS with fix pfv, Python's module and a C++ program there. Needs root and debootstrap.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build-package}
if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap > /dev/null; then
  echo "packages: skipped; to install the packages in a fresh chroot takes root and the package debootstrap"
  exit 0
fi

cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPFV_BUILD_TESTS=OFF \
  -DPFV_BUILD_BENCHMARKS=OFF > /dev/null
cmake --build "$build"
(cd "$build" && rm -f ./*.deb && cpack -G DEB)

chroot=$(mktemp -d)
trap 'umount "$chroot/proc" 2> /dev/null || true; rm -rf --one-file-system "$chroot"' EXIT
chmod 755 "$chroot"
mirror=$(apt-get indextargets --format '$(SITE) $(RELEASE)' 'Created-By: Packages' |
  awk '$2 == "bookworm" && !found++ { print $1 }')
debootstrap --variant=minbase --include=ca-certificates bookworm "$chroot" "$mirror" > "$build/debootstrap.log" ||
  { tail -5 "$build/debootstrap.log"; exit 1; }
# the registry as this machine is set up for it
rm -f "$chroot/etc/apt/sources.list"
cp -a /etc/apt/sources.list* /etc/apt/apt.conf.d "$chroot/etc/apt/"
cp -L /etc/resolv.conf /etc/hosts "$chroot/etc/"
mount -t proc proc "$chroot/proc"

mkdir "$chroot/packages" "$chroot/work"
cp "$build"/*.deb "$chroot/packages/"
cp "$root/tests/install/"{uses_pfv.cpp,in.packages} "$chroot/work/"
inside() { chroot "$chroot" env DEBIAN_FRONTEND=noninteractive HOME=/root OMP_NUM_THREADS=1 \
  OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 bash -euc "cd /work; $1"; }
inside 'apt-get update -q; apt-get install -q -y --no-install-recommends /packages/pfv_*.deb' > "$build/apt.log" ||
  { tail -20 "$build/apt.log"; exit 1; }
# each alone, the one before taken off with what it brought: none has its needs from another
echo "pfv:"; inside 'pfv selftest; test -s /usr/share/man/man1/pfv.1*; . /usr/share/bash-completion/completions/pfv'
inside 'apt-get purge --autoremove -q -y pfv; apt-get install -q -y --no-install-recommends /packages/python3-pfv_*.deb' >> "$build/apt.log"
echo "python3-pfv:"
inside 'python3 -c "
import numpy as np, pfv
x = np.array([[i, j, k] for i in range(5) for j in range(5) for k in range(5)]) * 1e-3 + 0.5e-3
k = pfv.permeability(x, np.full(125, 0.5e-3), [[0, 5e-3]] * 3)
print(k, \"m2\")
assert 1e-9 < k < 1e-8"'
inside 'apt-get purge --autoremove -q -y python3-pfv; apt-get install -q -y --no-install-recommends /packages/liggghts-pfv_*.deb' >> "$build/apt.log"
echo "liggghts-pfv:"; inside 'liggghts-pfv -in in.packages > log; tail -1 log
  grep -Eq "^force of the fluid on the grains (1|1[.]00000000[0-9]*|0[.]99999999[0-9]*) N" log'
inside 'apt-get purge --autoremove -q -y liggghts-pfv; apt-get install -q -y --no-install-recommends /packages/libpfv-dev_*.deb pkg-config' >> "$build/apt.log"
echo "libpfv-dev:"; inside 'g++ -std=c++17 uses_pfv.cpp $(pkg-config --cflags --libs pfv) -o uses_pfv; ./uses_pfv'
echo "packages: all four work in a fresh chroot"
