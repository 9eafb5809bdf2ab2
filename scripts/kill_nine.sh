#!/usr/bin/env bash
# Kills softgripd 100 times with kill -9 at random moments of a recording:
#   scripts/kill_nine.sh [TIMES] [--seed N] [--jobs N]
# Every recording must be readable with a loss of at most 1 s, and the board must vent. Otherwise the exit code is 6.
# Needs a built tree (build/release, or SOFTGRIP_BUILD=...).
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "$0")")")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
exec "$python" -u "$root/tests/system/kill_nine.py" "$@"
