#!/usr/bin/env bash
# Fails the Nth call of every kind, for every N until a run gets through without: no crash, no hang, an exit code of the
# contract with a sentence, safe outputs as the emulated board has them, nothing torn, nothing left behind.
#   scripts/fail_nth.sh [CALL ...]     default: all of tests/system/fail_nth.py; takes some minutes
# Needs a built tree (build/release, or SOFTGRIP_BUILD=...). Exit code 6 if an assertion failed.
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "$0")")")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
exec "$python" -u "$root/tests/system/fail_nth.py" "$@"
