#!/usr/bin/env bash
# softgripd for an hour or more at 1 kHz against softgrip-rig over TCP, sequence after sequence, with background load,
# and after each round of sequences clients that come and go, pauses of the process, a full disk:
#   scripts/soak.sh [MINUTES] [--out DIR] [--no-load] [--seed N]      default: 60 minutes, soak-output/
#   scripts/soak.sh --pauses N                      nothing but N pauses that are longer than the board's watchdog
# Each minute a line of memory, descriptors, slips, drops and faults goes into DIR/soak.csv; the verdict comes last.
# Exit code 6 if anything grew, got lost, or tripped although nothing was wrong.
# Needs a built tree (build/release, or SOFTGRIP_BUILD=...); the right to SCHED_FIFO makes it meaningful.
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "$0")")")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
exec "$python" -u "$root/tests/system/soak.py" "$@"
