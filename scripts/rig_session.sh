# A file to source. Its functions start and stop an emulated rig and a daemon. The calling script sets these
# variables:
#   build=BUILD_DIR  work=EMPTY_FOLDER  runs=FOLDER_FOR_RECORDINGS
softgrip=$build/tools/softgrip softgripd=$build/daemon/softgripd emulator=$build/tools/softgrip-rig
daemon_pid= rig_pid=

stop_daemon() { if [ -n "$daemon_pid" ]; then kill "$daemon_pid" 2>/dev/null; wait "$daemon_pid" 2>/dev/null; fi; daemon_pid=; }
stop_rig() { if [ -n "$rig_pid" ]; then kill "$rig_pid" 2>/dev/null; wait "$rig_pid" 2>/dev/null; fi; rig_pid=; }

# start_rig [OPTION_OF_SOFTGRIP_RIG ...]  starts softgrip-rig on a free port with two fingers of the model
# bench_twin
start_rig() {
  : >"$work/rig.log"  # otherwise the loop below may read the port of an earlier rig before the shell empties the file
  "$emulator" --model config/models/bench_twin.yaml --rig config/rig_tcp.yaml --tcp 0 "$@" >"$work/rig.log" 2>&1 &
  rig_pid=$!
  for _ in $(seq 100); do grep -q 'listening on' "$work/rig.log" && break; sleep 0.1; done
  port=$(sed -n 's/.*listening on [0-9.]*:\([0-9]*\).*/\1/p' "$work/rig.log" | head -n 1)
  [ -n "$port" ] || { echo "softgrip-rig did not start:" >&2; cat "$work/rig.log" >&2; return 1; }
}

# start_daemon [SED_EXPRESSION ...]  starts the daemon with the example rig file on this port; the sed expressions
# change the rig file. softgrip-rig is an ordinary process and may respond late on a busy computer. Therefore this rig
# file permits 0.28 s without a response instead of the 25 ms of the example rig file. 0.28 s are shorter than the
# time-out of the board's watchdog.
start_daemon() {
  cp -r config/boards config/models config/sequences "$work/"
  local edits=(-e "s#port: 1502#port: $port#" -e "s#directory: /tmp/softgrip-runs#directory: $runs#"
               -e "s#path: /tmp/softgrip.sock#path: $work/sock#"
               -e "s#exchange_deadline_s: [0-9.]*#exchange_deadline_s: 0.2#" -e "s#bus_down_cycles: [0-9]*#bus_down_cycles: 55#"
               -e "s#invalid_reading_cycles: [0-9]*#invalid_reading_cycles: 80#" -e "s#max_age_s: [0-9.]*#max_age_s: 0.4#"
               -e "s#readback_cycles: [0-9]*#readback_cycles: 80#" -e "s#max_missed_commands: [0-9]*#max_missed_commands: 80#")
  for edit in "$@"; do edits+=(-e "$edit"); done
  sed "${edits[@]}" config/rig_tcp.yaml >"$work/rig.yaml"
  "$softgripd" --config "$work/rig.yaml" >"$work/daemon.log" 2>&1 &
  daemon_pid=$!
  export SOFTGRIP_SOCKET=$work/sock
  for _ in $(seq 150); do
    "$softgrip" status --json 2>/dev/null | grep -q '"idle"' && return 0
    sleep 0.1
  done
  echo "softgripd did not become ready:" >&2; cat "$work/daemon.log" >&2; return 1
}
