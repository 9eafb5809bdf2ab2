#!/usr/bin/env bash
# Runs the whole daemon in simulated worlds (tests/world). Each seed gives one world, which runs in one thread
# with a simulated clock. A world contains the loop, the bus, a board with watchdog, clients, the recorder,
# pauses and other Modbus clients. If a world violates a requirement, the script reports the seed, the
# smallest set of incidents that causes the violation, and the trace.
#   scripts/worlds.sh [SEEDS [SECONDS [FIRST]]]      default: 10000 seeds of 60 s from seed 1
#   scripts/worlds.sh tools [SEEDS [SECONDS [FIRST]]]   also calibrate, doctor, run, baseline, the experiments of
#                                                    investigate and softgrip-plc, in turn; default: 2000 seeds
#   scripts/worlds.sh faults [WORD ...]              seeds until each inserted fault is found, in a copy in build/worlds
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
. scripts/build.sh

if [ "${1:-}" = faults ]; then
  shift
  exec python3 scripts/world_faults.py "$@"
fi
tool=daemon
seeds=10000
if [ "${1:-}" = tools ]; then
  shift
  tool=tools
  seeds=2000
fi
cmake --preset release -DSOFTGRIP_TESTS=ON >/dev/null
build release softgrip-world
started=$SECONDS
status=0
build/release/tests/world/softgrip-world --tool "$tool" --first "${3:-1}" --count "${1:-$seeds}" --jobs "$(nproc)" --seconds "${2:-60}" || status=$?
echo "$((SECONDS - started)) s on $(nproc) processors"
exit $status
