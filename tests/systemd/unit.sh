#!/usr/bin/env bash
# What systemd says of the files in systemd/ without starting anything: unit.sh verify|exposure|users|folders UNIT SOURCE
# UNIT is the configured unit whose ExecStart= exists; SOURCE the folder systemd/.
set -euo pipefail
unit=$2 source=$3
# 2.0 of 10, as tenths.
most_exposure=20

case $1 in
  verify)
    # It prints what it does not know and succeeds all the same: any output is a failure.
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
    # As root the folders are made and one that is old is emptied; without, reading the file must do.
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
    # What is a second old is old enough for this copy of the file.
    sed 's/90d$/1s/' "$source/softgrip.tmpfiles" >"$root/etc/softgrip.conf"
    sleep 1.5
    systemd-tmpfiles --root="$root" --clean "$root/etc/softgrip.conf"
    [ ! -e "$runs/kept/run.csv" ]
    [ -f "$runs/health/notes.yaml" ]
    ;;
  *) echo "unit.sh: unknown check $1" >&2; exit 2 ;;
esac
