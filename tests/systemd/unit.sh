#!/usr/bin/env bash
# Checks the files in systemd/ with the tools of systemd, without starting a service: unit.sh
# verify|exposure|users|folders|rules UNIT SOURCE. UNIT is the configured unit, whose ExecStart= exists.
# SOURCE is the folder systemd/.
set -euo pipefail
unit=$2 source=$3
# Largest accepted exposure level of systemd-analyze, in tenths. The level 1.5 of 10 is accepted.
most_exposure=15

case $1 in
  verify)
    # If a key is unknown, systemd prints a message but returns 0. Therefore, the check fails if systemd prints
    # anything.
    said=$(systemd-analyze verify --man=no "$unit" 2>&1) || true
    [ -z "$said" ] || { echo "$said"; exit 1; }
    ;;
  exposure)
    systemd-analyze security --no-pager --offline=true --threshold=$most_exposure "$unit" |
      grep -v '✓'
    ;;
  users)
    root=$(mktemp -d) && trap 'rm -rf "$root"' EXIT
    mkdir "$root/etc"
    printf 'dialout:x:20:\n' >"$root/etc/group"
    systemd-sysusers --root="$root" "$source/softgrip.sysusers"
    grep '^softgrip:.*:/var/lib/softgrip:/usr/sbin/nologin$' "$root/etc/passwd"
    grep '^dialout:x:20:softgrip$' "$root/etc/group"
    ;;
  folders)
    # If the test runs as root, systemd-tmpfiles creates the folders and removes old files from one of them. Otherwise,
    # systemd-tmpfiles only reads its configuration file.
    root=$(mktemp -d) && trap 'rm -rf "$root"' EXIT
    mkdir "$root/etc"
    printf 'softgrip:x:%s:%s::/:/\n' "$(id -u)" "$(id -g)" >"$root/etc/passwd"
    printf 'softgrip:x:%s:\n' "$(id -g)" >"$root/etc/group"
    systemd-tmpfiles --root="$root" --create "$source/softgrip.tmpfiles"
    runs=$root/var/lib/softgrip/runs
    [ "$(stat -c %a "$runs")" = 750 ]
    mkdir "$runs/kept" && touch "$runs/kept/run.csv" "$runs/health/notes.yaml"
    systemd-tmpfiles --root="$root" --clean "$source/softgrip.tmpfiles"
    [ -f "$runs/kept/run.csv" ]
    # In this copy of the configuration file, files are removed after 1 s instead of 90 days.
    sed 's/90d$/1s/' "$source/softgrip.tmpfiles" >"$root/etc/softgrip.conf"
    sleep 1.5
    # softgrip-health.service reads recordings every night. This must not prevent their removal.
    ls "$runs" "$runs/kept" >/dev/null
    cat "$runs/kept/run.csv"
    systemd-tmpfiles --root="$root" --clean "$root/etc/softgrip.conf"
    [ ! -e "$runs/kept" ]
    [ -f "$runs/health/notes.yaml" ]
    ;;
  rules)
    # Each udev rule gives the group access to a GPIO chip or a converter. Before a rule gives access, it must ask the
    # daemon if the rig file names this device.
    rules=$source/softgrip.rules.in
    asks='PROGRAM="@CMAKE_INSTALL_FULL_BINDIR@/softgripd --config @SOFTGRIP_CONFIGURATION@/rig_service.yaml --device %k"'
    grep -E 'SUBSYSTEM=="(gpio|iio)"' "$rules" >/dev/null
    if grep -E 'SUBSYSTEM=="(gpio|iio)"' "$rules" | grep -vF "$asks"; then exit 1; fi
    # The daemon answers with its exit code:
    # 0: the rig file names the device;
    # 6: the rig file does not name the device;
    # 3: the rig file cannot be read.
    softgripd=$(sed -n 's/^ExecStart=\([^ ]*\) .*/\1/p' "$unit")
    folder=$(mktemp -d) && trap 'rm -rf "$folder"' EXIT
    cp -r "$source/../config" "$folder"
    rig=$folder/config/rig_service.yaml
    answer() { local code=0; "$softgripd" --config "$rig" --device "$1" || code=$?; [ "$code" = "$2" ]; }
    answer gpiochip7 6
    printf 'gpio:\n  debounce_s: 0.005\n  stale_after_s: 0.5\n  ready_lamp: {chip: gpiochip7, offset: 0, active: high}\n' >>"$rig"
    answer gpiochip7 0
    answer gpiochip0 6
    answer iio:device0 6
    printf 'half: [' >>"$rig"
    answer gpiochip7 3
    ;;
  *) echo "unit.sh: unknown check $1" >&2; exit 2 ;;
esac
