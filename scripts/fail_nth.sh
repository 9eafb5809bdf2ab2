#!/usr/bin/env bash
# Makes the Nth call of a group of system calls fail, for N = 1, 2, 3 and so on until a run has no Nth call.
# This is repeated for each group. No run may crash or hang. Each run must end with a documented exit code, a
# message and safe outputs of the emulated board. It must not leave partial or temporary files.
#   scripts/fail_nth.sh [CALL ...]     default: all of tests/system/fail_nth.py; takes some minutes
# Needs a built tree (build/release, or SOFTGRIP_BUILD=...). The exit code is 6 if an assertion failed.
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "$0")")")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
exec "$python" -u "$root/tests/system/fail_nth.py" "$@"
