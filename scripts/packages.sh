#!/usr/bin/env bash
# Installs the packages of the given sections of packages.txt that are not installed yet: packages.sh build
# [tests ...]
set -euo pipefail
here=$(dirname "$(realpath "$0")")

release=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")

wanted=()
for section in "$@"; do
  mapfile -t names < <(awk -v section="[$section]" -v release="@$release" '
    /^\[/ {inside = ($1 == section); next}
    inside {sub(/#.*/, ""); if (NF == 1 || (NF && $2 == release)) print $1}' "$here/packages.txt")
  [ ${#names[@]} -gt 0 ] || { echo "packages.sh: no section [$section] in packages.txt" >&2; exit 2; }
  wanted+=("${names[@]}")
done

# Also counts a package as installed if another package provides it. For example, nodejs from other archives provides
# npm.
provided=" $(dpkg-query -W -f='${Status} ${Provides}\n' | sed -n 's/^install ok installed //p' | sed 's/([^)]*)//g' |
  tr ',\n' '  ') "
missing=()
for name in "${wanted[@]}"; do
  [[ $provided == *" $name "* ]] && continue
  dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q 'install ok installed' || missing+=("$name")
done
[ ${#missing[@]} -eq 0 ] && exit 0

sudo=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "packages.sh: run as root, or install sudo. Missing: ${missing[*]}" >&2; exit 1; }
  sudo=(sudo)
fi
echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
apt=("${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=400)
"${apt[@]}" update >/dev/null
"${apt[@]}" install -y --no-install-recommends "${missing[@]}" >/dev/null
