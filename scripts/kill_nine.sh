#!/usr/bin/env bash
# kill -9 of softgripd at random moments while it records, a hundred times:
#   scripts/kill_nine.sh [TIMES] [--seed N] [--jobs N]
# Every recording must open, at most one second may be lost, the board must vent. Exit code 6 otherwise.
# Needs a built tree (build/release, or SOFTGRIP_BUILD=...).
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "$0")")")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
exec "$python" -u "$root/tests/system/kill_nine.py" "$@"
