#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# ./run.sh [SCENE [KEY=VALUE...]]   installs what is missing, builds, runs a scene of inputs/
set -euo pipefail
root=$(cd "$(dirname "$0")" && pwd)
. "$root/.ci/functions.sh"

scene=${1:-oedometer}
[ $# -gt 0 ] && shift
if [ ! -f "$root/inputs/$scene/in.$scene" ]; then
  scenes=$(cd "$root/inputs" && for file in */in.*; do
    [ "${file%/*}" = "${file#*/in.}" ] && printf ' %s' "${file%/*}"; done; true)
  echo "run.sh: there is no scene '$scene'; there are:$scenes" >&2
  exit 2
fi

install_packages
build_project to_install

cd "$root/inputs/$scene"
if [ -f run.py ]; then
  exec /usr/bin/python3 run.py "$@"
fi
variables=()
for word in "$@"; do
  case $word in
    ?*=*) variables+=(-var "${word%%=*}" "${word#*=}") ;;
    *) echo "run.sh: '$word' is not KEY=VALUE" >&2; exit 2 ;;
  esac
done
"$root/build/bin/liggghts-pfv" -in "in.$scene" "${variables[@]}"
if [ -f plot.py ]; then
  exec /usr/bin/python3 plot.py
fi
