#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# ./test.sh         installs what is missing, builds, runs the tests
# ./test.sh long    the long validations too: scenes in full size, figures of doc/
set -euo pipefail
root=$(cd "$(dirname "$0")" && pwd)
. "$root/.ci/functions.sh"

case ${1:-} in
  '' | long) ;;
  *) echo "test.sh: '$1' is not known; use ./test.sh or ./test.sh long" >&2; exit 2 ;;
esac

install_packages
build_project

echo "unit tests under the address and undefined-behaviour sanitizers"
cmake -S "$root" --preset sanitize > /dev/null
cmake --build "$root/build-sanitize" --target unit_tests
# METIS, CHOLMOD and MPI keep memory until the process ends: their business
ASAN_OPTIONS=detect_leaks=0 "$root/build-sanitize/bin/unit_tests" --gtest_brief=1

if [ "${1:-}" = long ]; then
  export PFV_REBUILDS=2000
  "$root/build/bin/fuzz" --count 10000 --seed 1
  "$root/build/bin/fuzz" --count 10000 --seed 2
  "$root/run.sh" oedometer N=5000
  "$root/run.sh" oedometer study
  "$root/run.sh" stability write
  "$root/run.sh" darcy_outlet
  "$root/doc/accuracy.py"
  "$root/doc/error_vs_time.py" solvers thresholds coupling coupling_5000 sizes models scaling
  "$root/tests/bench/table.py"
fi
ctest --test-dir "$root/build" --output-on-failure -j 2
