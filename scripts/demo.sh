#!/usr/bin/env bash
# Installs what it needs, builds, and runs the whole chain on a simulated rig over Modbus TCP:
#   scripts/demo.sh [OUTPUT_DIR]      default: demo-output/
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
out=$(realpath -m "${1:-demo-output}")

bash scripts/packages.sh build
echo "Building ..."
build=build/release
[ -f "$build/CMakeCache.txt" ] || cmake --preset release -DSOFTGRIP_TESTS=OFF -DSOFTGRIP_BENCHMARKS=OFF >/dev/null
cmake --build "$build" -j "$(nproc)" --target softgrip softgripd softgrip-rig | tail -n 1
softgrip=$build/tools/softgrip softgripd=$build/daemon/softgripd rig=$build/tools/softgrip-rig

rm -rf "$out" && mkdir -p "$out"
work=$(mktemp -d)
daemon_pid= rig_pid=
finish() {
  [ -n "$daemon_pid" ] && kill "$daemon_pid" 2>/dev/null && wait "$daemon_pid" 2>/dev/null
  [ -n "$rig_pid" ] && kill "$rig_pid" 2>/dev/null && wait "$rig_pid" 2>/dev/null
  rm -rf "$work"
}
trap finish EXIT
say() { printf '\n== %s\n' "$*"; }

# Waits until `$2` shows up in file `$1`.
wait_for() {
  for _ in $(seq 100); do grep -q "$2" "$1" 2>/dev/null && return 0; sleep 0.1; done
  echo "demo.sh: no '$2' in $1 after 10 s:" >&2; cat "$1" >&2; return 1
}

# A copy of the example rig that uses a free port and this demo's own folders.
start_rig() {  # options of softgrip-rig
  "$rig" --model config/models/bench_twin.yaml --rig config/rig_tcp.yaml --tcp 0 "$@" >"$work/rig.log" 2>&1 &
  rig_pid=$!
  wait_for "$work/rig.log" 'listening on'
  port=$(sed -n 's/.*listening on [0-9.]*:\([0-9]*\).*/\1/p' "$work/rig.log" | head -n 1)
}
start_daemon() {
  cp -r config/boards config/models config/sequences "$work/"
  sed -e "s#port: 1502#port: $port#" -e "s#directory: /tmp/softgrip-runs#directory: $out/runs#" \
      -e "s#path: /tmp/softgrip.sock#path: $work/sock#" config/rig_tcp.yaml >"$work/rig.yaml"
  "$softgripd" --config "$work/rig.yaml" >"$work/daemon.log" 2>&1 &
  daemon_pid=$!
  export SOFTGRIP_SOCKET=$work/sock
  for _ in $(seq 100); do "$softgrip" status --json 2>/dev/null | grep -q '"idle"' && return 0; sleep 0.1; done
  echo "demo.sh: the daemon did not become ready:" >&2; cat "$work/daemon.log" >&2; return 1
}

say "1. A rig: two fingers like the bench's, a stone between them, behind a Modbus TCP board"
start_rig --object stone
cat "$work/rig.log"

say "2. The daemon at 200 Hz, and the pick sequence on both fingers"
start_daemon
cat "$work/daemon.log"
"$softgrip" start --wait pick_stone
"$softgrip" status

say "3. Tracking with the full inverse and PID: 6 to 20 mm at 0.1 Hz"
kill "$rig_pid"; wait "$rig_pid" 2>/dev/null || true; rig_pid=
echo "(the emulator was stopped: the wire is cut)"
sleep 1
"$softgrip" status || true
