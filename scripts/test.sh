#!/usr/bin/env bash
# Installs the packages that the tests need, makes the release build and runs all of its tests. At the same
# time, builds the Debian package. Then checks code that parses external bytes with AddressSanitizer and
# UndefinedBehaviorSanitizer, and code with threads with ThreadSanitizer. clang-tidy checks the sources that
# differ from the main branch of origin.
#   scripts/test.sh            all of this
#   scripts/test.sh --quick    the release build and the tests that take at most a moment each
#   scripts/test.sh --all      hours: also the tests with the labels campaign (more simulated worlds, the binary interface of
#                              the library, an exported model in Octave) and recipe (executes the pages that explain how
#                              to add a part), every test with the sanitizers, and every source with clang-tidy
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."

quick=false all=false
case "${1:-}" in
  "") ;;
  --quick) quick=true ;;
  --all) all=true ;;
  *) echo "usage: scripts/test.sh [--quick | --all]" >&2; exit 2 ;;
esac

if $quick; then wanted="build tests workflows"; else wanted="build tests workflows readers package lint"; fi
if $all; then wanted="$wanted all"; fi
bash scripts/packages.sh $wanted
$quick || bash scripts/mcap_reader.sh
. scripts/build.sh
. scripts/ctest.sh
started=$SECONDS
say() { printf '\n== %s (%d s)\n' "$*" $((SECONDS - started)); }
# Prints the last lines of the output. They list the skipped tests.
end() {
  if [ -s build/mcap/unreachable ]; then printf '\nNOT TESTED: MCAP files with the reader @mcap/core, because %s\n' "$(cat build/mcap/unreachable)"; fi
  say "done"
  exit 0
}

# clang-format must be version 14, because other versions interpret .clang-format differently.
if clang-format --version 2>/dev/null | grep -q 'version 14\.'; then
  say "format"
  git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
fi

say "build"
cmake --preset release -DSOFTGRIP_TESTS=ON -DSOFTGRIP_BENCHMARKS=ON -DSOFTGRIP_PRECOMPILE=ON >/dev/null
build release

if $quick; then
  say "test"
  run_ctest release 'blind|system|recipe|campaign|long' || { list_failed_tests release >&2; exit 1; }
  say "done"
  exit 0
fi

# Most tests mostly wait, so the build with the sanitizers runs at the same time.
mkdir -p build
without='recipe|campaign'
if $all; then without=''; fi
set -m  # starts each job in a process group of its own, so that a signal can end the whole group
chrt --idle 0 bash scripts/sanitize.sh build </dev/null >build/sanitize.log 2>&1 &
sanitized=$!
start_computing_tests release "$without"
set +m
trap 'kill -- -$sanitized -$computing 2>/dev/null || true' EXIT
say "tests in real time"
failed=false
run_real_time_tests release "$without" || failed=true
# The Debian package is built while the rest of the computing tests run.
say "package"
bash scripts/package.sh | tail -n 1
say "sanitizers"
wait $sanitized || { tail -n 40 build/sanitize.log >&2; exit 1; }
$all || bash scripts/sanitize.sh
say "other tests"
end_computing_tests release || failed=true
if $failed; then list_failed_tests release >&2; exit 1; fi
if $all; then
  bash scripts/sanitize.sh all
  say "clang-tidy: every source"
  python3 scripts/tidy.py
  end
fi
mapfile -t changed < <(git diff --name-only --diff-filter=d origin/main...HEAD -- '*.cpp' 2>/dev/null || true)
if [ ${#changed[@]} -gt 0 ] && [ ${#changed[@]} -le 40 ]; then
  say "clang-tidy: ${#changed[@]} changed sources"
  python3 scripts/tidy.py "${changed[@]}"
fi
end
