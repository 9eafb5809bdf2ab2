#!/usr/bin/env bash
# Makes the Nth call of every kind fail, for every N until a run has no Nth call. No run may crash or hang. Each ends with
# a documented exit code, a message and safe outputs of the emulated board, and leaves no partial or temporary files.
#   scripts/fail_nth.sh [CALL ...]     default: all of tests/system/fail_nth.py; takes some minutes
# Needs a built tree (build/release, or SOFTGRIP_BUILD=...). Exit code 6 if an assertion failed.
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "$0")")")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
exec "$python" -u "$root/tests/system/fail_nth.py" "$@"
