#!/usr/bin/env bash
# Tests every fault of tests/system/fault_matrix.yaml in every phase of a grip, with the real daemon over real sockets:
#   scripts/fault_matrix.sh [--page] [--jobs N] [FAULT | FAULT/PHASE | /PHASE ...]
# --page writes docs/results/fault-matrix.md from the measurements. A run with all faults takes about eight
# minutes, mostly waiting time. The exit code is 6 if a result differs from the table. Needs a built tree
# (build/release, or SOFTGRIP_BUILD=...) and python3-yaml.
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "$0")")")
python=/usr/bin/python3
[ -x "$python" ] || python=python3
exec "$python" -u "$root/tests/system/fault_matrix.py" "$@"
