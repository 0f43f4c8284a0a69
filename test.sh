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

page_is_old=
"$root/doc/error_vs_time.py" check || page_is_old=yes

echo "unit tests under the address and undefined-behaviour sanitizers"
pointers=OFF  # checks of each access by a pointer, beside those of its address
[ "${1:-}" = long ] && pointers=ON
cases=$root/build/tests/libunit_tests_cases.a  # compiled once: what is sanitized is the library
[ "${1:-}" = long ] && cases=
cmake -S "$root" --preset sanitize -DPFV_SANITIZE_POINTERS=$pointers "-DPFV_unit_tests_CASES=$cases" \
  "-DPFV_WITH_MUMPS=$(sed -n 's/^PFV_WITH_MUMPS:BOOL=//p' "$root/build/CMakeCache.txt")" > /dev/null
cmake --build "$root/build-sanitize" --target unit_tests
# leaks: in the long test, without the slowness of both
ASAN_OPTIONS=detect_leaks=0 in_two_halves "$root/build-sanitize/bin/unit_tests" --gtest_brief=1

if [ "${1:-}" = long ]; then
  export PFV_LONG=1 PFV_REBUILDS=2000
  echo "unit tests, fuzz, command and coupled runs under the address, leak and undefined-behaviour sanitizers"
  cmake --build "$root/build-sanitize"
  "$root/build-sanitize/bin/unit_tests" --gtest_brief=1
  UBSAN_OPTIONS=halt_on_error=1 "$root/build-sanitize/bin/fuzz" --count 1000 --seed 1
  UBSAN_OPTIONS=halt_on_error=1 "$root/build-sanitize/bin/container_fuzz" --count 500 --seed 1
  for ranks in 2 4; do  # leaks: MPI keeps what it has until the program ends
    ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=halt_on_error=1 \
      on_ranks "$ranks" "$root/build-sanitize/bin/ranks_tests" --gtest_brief=1
  done
  logs=$(mktemp -d)
  echo "reports of the runs: $logs"
  # endurance: what the address sanitizer keeps back is not the memory that it measures
  ASAN_OPTIONS=log_path=$logs/asan UBSAN_OPTIONS=log_path=$logs/ubsan:halt_on_error=1 \
    LSAN_OPTIONS=exitcode=0:fast_unwind_on_malloc=0 \
    PFV_SANITIZER_RUNTIME=$(gcc -print-file-name=libasan.so) \
    ctest --test-dir "$root/build-sanitize" --output-on-failure \
      -R '^(coupled|command)\.' -E '^coupled\.endurance$'
  "$root/tests/sanitizer_reports.py" "$logs"/*
  rm -r "$logs"
  "$root/build/bin/fuzz" --count 10000 --seed 1
  for ranks in 2 3 4; do
    on_ranks "$ranks" "$root/build/bin/ranks_tests" --gtest_brief=1
  done
  PFV_RANK_PACKINGS=20000 on_ranks 4 "$root/build/bin/ranks_tests" --gtest_filter='*HardToTriangulate'
  "$root/build/bin/fuzz" --count 10000 --seed 2
  "$root/build/bin/container_fuzz" --count 5000 --seed 2
  "$root/run.sh" oedometer N=5000
  "$root/run.sh" oedometer study
  "$root/run.sh" stability write
  for scene in oedometer_large permeameter deposition darcy_outlet wave_still wave_dense \
      wave_loose wave_unstable wave_permeability wave_oscillating shear_viscous boiling triaxial_cylinder triaxial \
      triaxial_periodic simple_shear \
      hopper_underwater drum_underwater plate_uplift clumps settling column_collapse; do
    "$root/run.sh" "$scene"
  done
  "$root/run.sh" wave_dense SHAKE=0.5 RATE=100 AMPLITUDE=600
  "$root/run.sh" wave_loose SHAKE=0.5 RATE=100 AMPLITUDE=600
  PFV_COMMAND=$root/build/bin/pfv /usr/bin/python3 "$root/tests/python/pip_install.py"
  "$root/tests/install/packages.sh"
  /usr/bin/python3 "$root/tests/hosts/test_hosts.py" -v
  PFV_COMMAND=$root/build/bin/pfv PYTHONPATH=$root/build/python /usr/bin/python3 "$root/tests/python/test_notebooks.py" --nbclient
  "$root/doc/accuracy.py"
  "$root/doc/containers.py"
  "$root/doc/periodic.py"
  "$root/doc/error_vs_time.py" all
  "$root/doc/scaling.py" million
  "$root/tests/bench/table.py"
  install_packages debian-packages-site.txt
  "$root/doc/website.py"
fi
ctest --test-dir "$root/build" --output-on-failure -j 2
if [ "${1:-}" = long ] && [ -n "$page_is_old" ]; then
  echo "test.sh: doc/error_vs_time.md was of other sources; it has been made again: read it and commit it" >&2
  exit 1
fi
