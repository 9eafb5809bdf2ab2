#!/usr/bin/env bash
# Installs what the tests need, builds, and runs them: everything in the release build, then what meets bytes from
# outside under AddressSanitizer and UndefinedBehaviorSanitizer.
#   scripts/test.sh            all of it
#   scripts/test.sh --quick    the release build and its tests only
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."

quick=false
case "${1:-}" in
  "") ;;
  --quick) quick=true ;;
  *) echo "usage: scripts/test.sh [--quick]" >&2; exit 2 ;;
esac

bash scripts/packages.sh build tests
jobs=$(nproc)
started=$SECONDS
say() { printf '\n== %s (%d s)\n' "$*" $((SECONDS - started)); }

say "format"
git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror

say "build"
cmake --preset release -DSOFTGRIP_TESTS=ON -DSOFTGRIP_BENCHMARKS=ON >/dev/null
cmake --build --preset release -j "$jobs" | tail -n 1

if ! $quick; then
  # Parsers and the wire: the programs are run as they are, since only these are built.
  sanitized=(model_document_test drivers_test modbus_session_test)
  say "build with sanitizers: ${sanitized[*]}"
  cmake --preset asan-ubsan >/dev/null
  cmake --build --preset asan-ubsan -j "$jobs" --target "${sanitized[@]}" | tail -n 1
  say "test with sanitizers"
  for test in "${sanitized[@]}"; do
    program=$(find build/asan-ubsan/tests -type f -name "$test" -perm -u+x)
    "$program" --gtest_brief=1
  done
fi

say "test"
# Real sockets and real time on a machine that may be busy: what fails once is run once more, twice is a failure.
ctest --preset release -j "$jobs" --repeat until-pass:2
say "done"
