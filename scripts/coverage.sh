#!/usr/bin/env bash
# Measures the branch coverage of control/, the bus and the loop. The script builds them with counters in
# build/coverage and runs control_test, daemon_test and 100 simulated worlds. It prints the branches per file
# and folder, beginning with the lowest coverage. The list of all branches that are not taken is
# build/coverage/branches.txt.
#   scripts/coverage.sh
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
bash scripts/packages.sh build tests workflows coverage
build=build/coverage
cmake -S . -B $build -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS="--coverage -O0" -DSOFTGRIP_TESTS=ON \
  -DSOFTGRIP_BENCHMARKS=OFF -DSOFTGRIP_PRECOMPILE=ON >/dev/null
cmake --build $build --target control_test daemon_test softgrip-world >$build/build.log || { tail -n 30 $build/build.log; exit 1; }
find $build -name '*.gcda' -delete
# This build has counters that allocate memory and make system calls. Tests that count allocations or system calls
# therefore fail in this build.
$build/tests/control_test --gtest_brief=1 >$build/control.log 2>&1 || tail -n 5 $build/control.log
$build/tests/daemon_test --gtest_brief=1 >$build/daemon.log 2>&1 || tail -n 5 $build/daemon.log
$build/tests/world/softgrip-world --count 100 | tail -n 2
# Two kinds of branches are not counted: branches that the compiler adds to a call for exceptions, and additional copies
# of an inline function in other object files.
gcovr -r . $build --branches --exclude-throw-branches --exclude-unreachable-branches --sort-percentage \
  --filter 'control/' --filter 'daemon/loop/(bus|loop|heartbeat)' --exclude '.*\.h$' \
  --txt $build/branches.txt --csv $build/branches.csv
awk -F, 'function add(name) { of[name] += $5; taken[name] += $6 }
         NR > 1 { split($1, part, "/"); add($1); add(part[1] "/" part[2]); add(part[1]) }
         END { for (name in of) if (of[name]) printf "%5.1f %% %s: %d of %d\n", 100 * taken[name] / of[name], name, taken[name], of[name] }' \
  $build/branches.csv | sort -n
