#!/usr/bin/env bash
# Runs softgripd for an hour or more at 1 kHz against softgrip-rig over TCP, sequence after sequence, with
# background load. After each round of sequences come three disturbances: clients connect and disconnect, the
# process pauses, and the disk becomes full:
#   scripts/soak.sh [MINUTES] [--out DIR] [--no-load] [--seed N]      default: 60 minutes, soak-output/
#   scripts/soak.sh --pauses N                      only N pauses that are longer than the board's watchdog time
# Each minute adds a line with memory, descriptors, overruns, dropped rows and faults to DIR/soak.csv. The
# last output is the verdict. The exit code is 6 if a resource has grown, data were lost, or a watchdog
# tripped without a cause. Needs a built tree (build/release, or SOFTGRIP_BUILD=...). The result is meaningful
# only with the right to use SCHED_FIFO.
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "$0")")")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
exec "$python" -u "$root/tests/system/soak.py" "$@"
