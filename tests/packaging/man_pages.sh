#!/usr/bin/env bash
# Checks man pages with groff and mandoc: man_pages.sh FOLDER. The check fails if groff or mandoc prints a
# warning.
set -euo pipefail
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
count=0
for page in "$1"/*.gz; do
  plain=$work/$(basename "${page%.gz}")
  zcat "$page" >"$plain"
  said=$(LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$plain" 2>&1 >/dev/null)
  said+=$(mandoc -T lint -W warning "$plain" || true)
  [ -z "$said" ] || { echo "$said"; exit 1; }
  count=$((count + 1))
done
echo "$count man pages without a warning"
[ "$count" -eq 7 ]
